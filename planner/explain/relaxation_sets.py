"""Find relaxation sets: minimal sets of changes that together allow a fold for which there is no plan.

What seems to stand in a fold's way is measured where the fold was tried. Whether it is the cause shows when it is
removed and the problem is planned again. Each single change that is enough is a set of its own. Where there is none,
what still stands in the way is removed too, until the fold can be done. No member of a set can be left out, and the
least amount of each change is found by bisection.

Checking that all places are in reach takes a hundredth of the time that joint paths take, and what is out of reach has
no joint paths. So sets and their amounts are found with collisions ignored, and joint paths are looked for only with
the result. If they fail there, what the arms touch is part of the cause, or a larger amount is needed.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace

from planner.explain.joint_relaxations import JointRelaxations, Member
from planner.explain.reason_obstacle import lacking
from planner.explain.reason_out_of_reach import enough_with_others, removed_by
from planner.explain.relaxation import COLLISIONS_IGNORED, Candidate, Relaxation
from planner.explain.relaxation_amounts import LeastAmounts
from planner.explain.relaxation_candidates import candidates
from planner.explain.relaxation_trials import SpentError, Trials, applied
from planner.explain.relaxed_problem import Ask, RelaxedProblem
from planner.planning.trial import Trial
from planner.task.reason import Code, Reason

_SHIFTS = (("cloth", "station"), ("table", "torso"))
"""Relaxations that shift the hands' path alike."""

_A_LITTLE_M = 0.003
"""Added to the least shift found together with another change, which is then tried alone (m)."""

_SLACKS = ("comfort", "cone")
"""Relaxations that are tried together with a shift where no change alone is enough."""


def confirmed_reasons(
    base: RelaxedProblem, met: Trial, measured: Sequence[Reason], ask: Ask, is_enough: Callable[[], bool]
) -> tuple[Reason, ...]:
    """Return the reasons why a problem has no plan, each tried.

    Args:
        base: the problem.
        met: its trial.
        measured: the reasons met in it.
        ask: tries relaxed problems.
        is_enough: polled before each trial; true ends them.
    """
    trials = Trials(ask, is_enough)
    found: list[Reason] = []
    for fold in dict.fromkeys(reason.fold for reason in measured):
        mine = tuple(reason for reason in measured if reason.fold == fold)
        if any(reason.code is Code.WAITS_FOR_FOLD for reason in mine):
            found += mine
            continue
        relaxations = _Relaxations(base, fold, trials)
        sets = relaxations.sets(met, mine)
        number = 1 + max((-1 if reason.set is None else reason.set for reason in found), default=-1)
        found += [replace(reason, set=number + n) for n, members in enumerate(sets) for reason in members]
        if not sets and (relaxations.is_cut_short or not relaxations.is_but_touching):
            found += untried(mine)
    is_explained = any(reason.code is not Code.WAITS_FOR_FOLD for reason in found)
    return tuple(found) if is_explained else untried(measured)


def untried(measured: Sequence[Reason]) -> tuple[Reason, ...]:
    """Return reasons that were met but not tried, without their shifts."""
    return tuple(replace(reason, shift_m=None, shift_towards=None) for reason in measured)


def _stays(relaxed: RelaxedProblem) -> bool:
    """Return whether the cloth stays where it lies at the start."""
    return relaxed.problem.unrest is None


class _Relaxations:
    """The relaxation sets for one fold; for None, of the whole garment.

    Attributes:
        is_but_touching: whether all places are in reach, so that only what the arms touch stands in the way.
        is_cut_short: whether the trials ended before all causes were tried.
    """

    def __init__(self, base: RelaxedProblem, fold: int | None, trials: Trials) -> None:
        self._base = base
        self._fold = fold
        self._trials = trials
        dag, everything = base.context.sequence.dag, range(len(base.context.sequence.folds))
        wanted = everything if fold is None else (fold, *dag.before(fold))
        self._folds = sum(1 << index for index in wanted)
        self._amounts = LeastAmounts(trials, self._folds)
        self._joint = JointRelaxations(base, fold, self._folds, trials)
        self.is_but_touching = False
        self.is_cut_short = False
        self._gives = "plan" if len(tuple(wanted)) == len(everything) else "fold"

    def sets(self, met: Trial, measured: tuple[Reason, ...]) -> list[tuple[Reason, ...]]:
        """Return sets of causes, each of which is enough; empty where none was found."""
        found: list[tuple[Member, ...]] = []
        own = list(candidates(met.context, measured, self._fold))
        try:
            if met.has_collided:
                self.is_but_touching = self._trials.trial(self._base, self._folds, with_arms=False).is_possible
            for candidate in own:
                found += self._enough(candidate)
            if not (found or self.is_but_touching):
                found += self._joint.together(self._base, (), own)
        except SpentError:
            self.is_cut_short = True
        found.sort(key=self._repair)
        return [self._told(members) for members in found] or [(told,) for told in self._at_rest(own)]

    def _repair(self, members: tuple[Member, ...]) -> tuple[int, float]:
        """Return the number of changes, in which one that no robot allows counts as three, and the total shortfall."""
        hypothetical = sum(2 for member in members if member.relaxation.is_hypothetical)
        return len(members) + hypothetical, sum(lacking(member.told, self._base.context) for member in members)

    def _enough(self, candidate: Candidate) -> Iterator[tuple[Member, ...]]:
        """Yield a cause that is enough, removed by the first relaxation that works, at least but for collisions."""
        *practical, last = candidate.relaxations
        if last.is_hypothetical and not self._amounts.is_enough(last, self._base, last.most, with_arms=False):
            return
        slacks = [one for one in practical if one.kind == "cone"]
        tried = [one for one in practical if one not in slacks] if last.is_hypothetical else candidate.relaxations
        touching: list[tuple[Member, ...]] = []
        for relaxation in tried:
            found, touched = self._least(relaxation, self._base)
            if touched is not None and found is not None:
                also = self._alike(candidate, relaxation, found, self._base.with_collisions_ignored())
                collision = Member(touched, COLLISIONS_IGNORED, 0.0)
                touching.append((Member(candidate.reason, relaxation, found, also), collision))
            elif found is not None:
                also = self._alike(candidate, relaxation, found, self._base)
                yield (Member(candidate.reason, relaxation, found, also),)
                return
        if touching:
            yield touching[0]
        elif last.is_hypothetical and not self.is_but_touching:
            yield self._stretched(candidate, slacks) or (Member(candidate.reason, last, last.most),)

    def _stretched(self, candidate: Candidate, slacks: Sequence[Relaxation]) -> tuple[Member, ...] | None:
        """Return a less convenient change that is enough, or two that bring into reach what neither does alone."""
        with suppress(SpentError):
            for relaxation in slacks:
                found, touched = self._least(relaxation, self._base)
                if found is not None and touched is None:
                    return (Member(candidate.reason, relaxation, found),)
            for relaxation in (one for one in candidate.relaxations if one.kind in _SLACKS):
                first = Member(candidate.reason, relaxation, relaxation.most)
                tried = self._trials(relaxation, self._base, relaxation.most, self._folds, with_arms=False)
                second = None if tried is None else next(self._joint.shifted((first,), tried), None)
                if tried is not None and second is not None:
                    low = self._amounts.settled(second.relaxation, tried[0], 0.0, second.amount, with_arms=False)
                    amounts = (low, low + _A_LITTLE_M, second.amount)
                    alone = self._amounts.first(second.relaxation, self._base, 0.0, amounts, with_arms=True)
                    if alone is not None:
                        return (Member(candidate.reason, second.relaxation, alone),)
                    return self._joint.least_of((first, replace(second, amount=low)))
        return None

    def _alike(
        self, candidate: Candidate, relaxation: Relaxation, amount: float, base: RelaxedProblem
    ) -> tuple[str, ...]:
        """Return the relaxations with the same effect that are also enough with the same amount."""
        alike = next((kinds for kinds in _SHIFTS if relaxation.kind in kinds), ())
        others = (other for other in candidate.relaxations if other.kind in alike and other.kind != relaxation.kind)
        return tuple(other.kind for other in others if self._amounts.is_enough(other, base, amount))

    def _least(self, relaxation: Relaxation, base: RelaxedProblem) -> tuple[float | None, Reason | None]:
        """Return the least sufficient amount, and what the arms touch with it; None where there is none.

        Where collisions are what is left in the way, the amount is the least that brings all places into reach.
        """
        is_in_reach = base is self._base and self.is_but_touching
        least = (
            0.0
            if is_in_reach
            else self._amounts.first(relaxation, base, 0.0, relaxation.amounts or (0.0,), with_arms=False)
        )
        if least is None or (relaxation.amounts and least <= 0.0 and not is_in_reach):
            return None, None
        beyond = (
            *(() if is_in_reach else (least,)),
            *(amount for amount in relaxation.amounts or (0.0,) if amount > least),
        )
        real = self._amounts.first(
            relaxation, base, max(least - relaxation.exact, 0.0), beyond or (least,), with_arms=True
        )
        if real is not None or is_in_reach:
            return real, None
        tried = self._trials(relaxation, base, least, self._folds, with_arms=True)
        touched = () if tried is None or not tried[1].has_collided else self._trials.measured(tried[1])
        touching = next((reason for reason in touched if reason.code is Code.COLLISION), None)
        return (None, None) if touching is None else (least, touching)

    def _at_rest(self, own: Sequence[Candidate]) -> Iterator[Reason]:
        """Yield what lets the cloth stay as it lies at the start, though it may not give a plan."""
        for candidate in own if self._fold is None else ():
            for relaxation in candidate.relaxations:
                tried = ((amount, applied(relaxation, self._base, amount)) for amount in relaxation.amounts)
                enough = next(((amount, at) for amount, at in tried if at is not None and _stays(at)), None)
                if enough is not None:
                    amount, changed = enough
                    yield replace(relaxation.told(candidate.reason, amount), change=changed.change, gives="start")
                    break

    def _told(self, members: tuple[Member, ...]) -> tuple[Reason, ...]:
        change = self._joint.applied_to_base(members).change
        told = [self._advised(member) for member in members]
        if len(told) > 1:
            context = self._base.context
            told = [enough_with_others(one, context) if one.code is Code.OUT_OF_REACH else one for one in told]
        return tuple(replace(one, change=change, gives=self._gives) for one in told)

    def _advised(self, member: Member) -> Reason:
        """Return a member's reason, with the advice that proved true when tried."""
        told, kind = member.told, member.relaxation.kind
        shifts = tuple(k for pair in _SHIFTS for k in pair if k in (kind, *member.also))
        if told.code is not Code.OUT_OF_REACH or not (shifts or member.relaxation.is_hypothetical):
            return told
        return removed_by(told, self._base.context, shifts)
