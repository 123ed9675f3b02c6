"""Find out why there is no plan: what a search met, and what of it proves to be the cause.

What proves true comes in relaxation sets: minimal sets of changes that together allow a fold that has no plan.

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
from dataclasses import dataclass, replace

from planner.explain.change import COLLISIONS_IGNORED, SpentError
from planner.explain.reason_obstacle import lacking
from planner.explain.reason_out_of_reach import enough_with_others, removed_by
from planner.explain.reasons import reasons_met
from planner.explain.relaxation_trials import Ask, Relaxation, RelaxedProblem, Trials, changed_or_none
from planner.explain.relaxations import candidates
from planner.planning.events import Obstacles
from planner.planning.problem import Problem
from planner.planning.trial import Trial, try_folds
from planner.task.reason import Code, Reason

REASONS_WORK_S = 4.0
"""Work of all trials of the causes for one plan (s, see `Budget`)."""


def explained(obstacles: Obstacles) -> Iterator[tuple[Reason, ...]]:
    """Yield the reasons that a search met, and then those that proved true when tried, since trying takes long.

    A reason proves true if removing the cause gives a plan, or at least allows its fold.
    """
    met = reasons_met(obstacles)
    yield met
    budget, tried = obstacles.budget.part(REASONS_WORK_S), list[Problem]()

    def ask(relaxed: RelaxedProblem, folds: int) -> Trial:
        tried.append(relaxed.searched)
        return try_folds(tried[-1], budget, folds, may_collide=relaxed.may_collide)

    try:
        base = RelaxedProblem(obstacles.problem)
        yield confirmed_reasons(base, Trial.failed(obstacles), met, ask, lambda: budget.is_over)
    finally:
        for problem in tried:
            problem.context.forget()


_MEMBERS_MAX = 3
"""Causes in one set at most."""

_SHIFTS = (("cloth", "station"), ("table", "torso"))
"""Kinds of changes that shift the hands' path alike."""

_A_LITTLE_M = 0.003
"""Added to the least shift found together with another change, which is then tried alone (m)."""

_SLACKS = ("comfort_radius", "cone")
"""Kinds of changes that are tried together with a shift where no change alone is enough."""


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
    found: list[Reason] = []
    for fold in dict.fromkeys(reason.fold for reason in measured):
        mine = tuple(reason for reason in measured if reason.fold == fold)
        if any(reason.code is Code.WAITS_FOR_FOLD for reason in mine):
            found += mine
            continue
        search = _RelaxationSets(base, fold, ask, is_enough)
        sets = search.sets(met, mine)
        number = 1 + max((-1 if reason.set is None else reason.set for reason in found), default=-1)
        found += [replace(reason, set=number + n) for n, members in enumerate(sets) for reason in members]
        if not sets and (search.is_cut_short or not search.is_but_touching):
            found += untried(mine)
    is_explained = any(reason.code is not Code.WAITS_FOR_FOLD for reason in found)
    return tuple(found) if is_explained else untried(measured)


def untried(measured: Sequence[Reason]) -> tuple[Reason, ...]:
    """Return reasons that were met but not tried, without their shifts."""
    return tuple(replace(reason, shift_m=None, shift_towards=None) for reason in measured)


@dataclass(frozen=True, slots=True, eq=False)
class _Member:
    """A relaxation in a set, its amount, and the kinds of others that are enough with this amount."""

    relaxation: Relaxation
    amount: float = 0.0
    also: tuple[str, ...] = ()

    @property
    def reason(self) -> Reason:
        """The reason to report."""
        return self.relaxation.reason_with(self.amount)

    @property
    def is_hypothetical(self) -> bool:
        """Whether no robot can be changed like this."""
        return self.relaxation.change.is_hypothetical


_Members = tuple[_Member, ...]


def _collision(reason: Reason) -> _Member:
    """Return the member that what the arms touch is out of the way."""
    return _Member(Relaxation(reason, COLLISIONS_IGNORED))


class _RelaxationSets:
    """The relaxation sets of one fold, or of the whole garment (None).

    Attributes:
        is_but_touching: whether all places are in reach, so that only what the arms touch stands in the way.
        is_cut_short: whether the trials ended before all causes were tried.
    """

    def __init__(self, base: RelaxedProblem, fold: int | None, ask: Ask, is_enough: Callable[[], bool]) -> None:
        self._base = base
        self._fold = fold
        dag, everything = base.context.sequence.dag, range(len(base.context.sequence.folds))
        wanted = everything if fold is None else (fold, *dag.before(fold))
        self._trials = Trials(ask, is_enough, sum(1 << index for index in wanted))
        self._joint = _JointSets(base, fold, self._trials)
        self.is_but_touching = False
        self.is_cut_short = False
        self._gives = "plan" if len(tuple(wanted)) == len(everything) else "fold"

    def sets(self, met: Trial, measured: tuple[Reason, ...]) -> list[tuple[Reason, ...]]:
        """Return sets of causes, each of which is enough; empty where none was found."""
        found: list[_Members] = []
        own = list(candidates(met.context, measured, self._fold))
        try:
            if met.has_collided:
                self.is_but_touching = self._trials.trial(self._base, with_arms=False).is_possible
            for relaxations in own:
                found += self._enough(relaxations)
            if not (found or self.is_but_touching):
                found += self._joint.together(self._base, (), own)
        except SpentError:
            self.is_cut_short = True
        found.sort(key=self._repair)
        return [self._reported(members) for members in found] or [(reason,) for reason in self._at_rest(own)]

    def _repair(self, members: _Members) -> tuple[int, float]:
        """Return the number of changes, in which one that no robot allows counts as three, and the total shortfall."""
        hypothetical = sum(2 for member in members if member.is_hypothetical)
        return len(members) + hypothetical, sum(lacking(member.reason, self._base.context) for member in members)

    def _enough(self, relaxations: tuple[Relaxation, ...]) -> Iterator[_Members]:
        """Yield the first relaxation of a cause that works, at least but for collisions."""
        *practical, last = relaxations
        is_hypothetical = last.change.is_hypothetical
        if is_hypothetical and not self._trials.is_enough(last.change, self._base, last.most, with_arms=False):
            return
        slacks = [one for one in practical if one.kind == "cone"]
        touching: list[_Members] = []
        for relaxation in [one for one in practical if one not in slacks] if is_hypothetical else relaxations:
            found, touched = self._least(relaxation)
            if found is None:
                continue
            if touched is None:
                yield (_Member(relaxation, found, self._alike(relaxations, relaxation, found, self._base)),)
                return
            base = self._base.changed(COLLISIONS_IGNORED)
            also = self._alike(relaxations, relaxation, found, base)
            touching.append((_Member(relaxation, found, also), _collision(touched)))
        if touching:
            yield touching[0]
        elif is_hypothetical and not self.is_but_touching:
            yield self._stretched(relaxations, slacks) or (_Member(last, last.most),)

    def _stretched(self, relaxations: tuple[Relaxation, ...], slacks: Sequence[Relaxation]) -> _Members | None:
        """Return a less convenient change that is enough, or two that bring into reach what neither does alone."""
        with suppress(SpentError):
            for relaxation in slacks:
                found, touched = self._least(relaxation)
                if found is not None and touched is None:
                    return (_Member(relaxation, found),)
            for relaxation in (one for one in relaxations if one.kind in _SLACKS):
                first = _Member(relaxation, relaxation.most)
                tried = self._trials.with_change(relaxation.change, self._base, relaxation.most, with_arms=False)
                second = None if tried is None else next(self._joint.shifted((first,), tried), None)
                if tried is not None and second is not None:
                    shift = second.relaxation
                    low = self._trials.settled(shift, tried[0], 0.0, second.amount, with_arms=False)
                    amounts = (low, low + _A_LITTLE_M, second.amount)
                    alone = self._trials.least(shift, self._base, 0.0, amounts, with_arms=True)
                    if alone is not None:
                        return (_Member(replace(shift, reason=relaxation.reason), alone),)
                    return self._joint.least_of((first, replace(second, amount=low)))
        return None

    def _alike(
        self, relaxations: tuple[Relaxation, ...], relaxation: Relaxation, amount: float, base: RelaxedProblem
    ) -> tuple[str, ...]:
        """Return the kinds of changes with the same effect that are also enough with the same amount."""
        alike = next((kinds for kinds in _SHIFTS if relaxation.kind in kinds), ())
        others = (other for other in relaxations if other.kind in alike and other.kind != relaxation.kind)
        return tuple(other.kind for other in others if self._trials.is_enough(other.change, base, amount))

    def _least(self, relaxation: Relaxation) -> tuple[float | None, Reason | None]:
        """Return the least sufficient amount and what the arms touch with it, each None if there is none.

        Where collisions are what is left in the way, the amount is the least that brings all places into reach.
        """
        amounts, least = relaxation.amounts or (0.0,), 0.0
        if not self.is_but_touching:
            found = self._trials.least(relaxation, self._base, 0.0, amounts, with_arms=False)
            if found is None or (relaxation.amounts and found <= 0.0):
                return None, None
            least = found
        larger = tuple(amount for amount in amounts if amount > least)
        beyond = (larger or (least,)) if self.is_but_touching else (least, *larger)
        low = max(least - relaxation.change.step, 0.0)
        real = self._trials.least(relaxation, self._base, low, beyond, with_arms=True)
        if real is not None or self.is_but_touching:
            return real, None
        tried = self._trials.with_change(relaxation.change, self._base, least, with_arms=True)
        touched = None if tried is None or not tried[1].has_collided else self._trials.touched(tried[1])
        return (None, None) if touched is None else (least, touched)

    def _at_rest(self, own: Sequence[tuple[Relaxation, ...]]) -> Iterator[Reason]:
        """Yield what lets the cloth stay as it lies at the start, though it may not give a plan."""
        for relaxations in own if self._fold is None else ():
            for relaxation in relaxations:
                tried = ((by, changed_or_none(self._base, relaxation.change, by)) for by in relaxation.amounts)
                stays = ((by, at) for by, at in tried if at is not None and at.problem.stability_violation is None)
                enough = next(stays, None)
                if enough is not None:
                    amount, changed = enough
                    change = changed.change_from(self._base)
                    yield replace(relaxation.reason_with(amount), change=change, gives="start")
                    break

    def _reported(self, members: _Members) -> tuple[Reason, ...]:
        """Return the reasons of a set, with the advice that proved true when tried."""
        change, context = self._joint.applied_to_base(members).change_from(self._base), self._base.context
        reasons = [self._advised(member) for member in members]
        if len(reasons) > 1:
            reasons = [enough_with_others(one, context) if one.code is Code.OUT_OF_REACH else one for one in reasons]
        return tuple(replace(one, change=change, gives=self._gives) for one in reasons)

    def _advised(self, member: _Member) -> Reason:
        reason = member.reason
        shifts = tuple(k for pair in _SHIFTS for k in pair if k in (member.relaxation.kind, *member.also))
        if reason.code is not Code.OUT_OF_REACH or not (shifts or member.is_hypothetical):
            return reason
        return removed_by(reason, self._base.context, shifts)


class _JointSets:
    """The search for changes to one problem that are enough only together."""

    def __init__(self, base: RelaxedProblem, fold: int | None, trials: Trials) -> None:
        """Take the problem, the fold to allow (None: the start), and its trials."""
        self._base = base
        self._fold = fold
        self._trials = trials

    def together(
        self, base: RelaxedProblem, members: _Members, own: Sequence[tuple[Relaxation, ...]]
    ) -> list[_Members]:
        """Return sets that together are enough: remove one cause and look what still stands in the way.

        Arms that reach everything come first, since they soon show what else stands in the way.
        """
        kinds = {member.relaxation.kind for member in members}
        onwards: list[tuple[_Members, RelaxedProblem, Trial]] = []
        firsts = [one[-1] if one[-1].kind == "arms" else one[0] for one in own]
        for relaxation in sorted(firsts, key=lambda one: one.kind != "arms"):
            if relaxation.kind in kinds:
                continue
            amount = relaxation.most if relaxation.needed is not None else next(iter(relaxation.amounts), 0.0)
            tried = self._trials.with_change(relaxation.change, base, amount, with_arms=False)
            if tried is None:
                continue
            chosen = (*members, _Member(relaxation, amount))
            if tried[1].is_possible:
                return [self.least_of(self._shortened(chosen))]
            onwards.append((chosen, *tried))
        for chosen, changed, trial in onwards if len(members) + 1 < _MEMBERS_MAX else ():
            measured = self._trials.measured(trial)
            mine = tuple(r for r in measured if r.fold in (self._fold, None)) or measured
            further = list(candidates(trial.context, mine, mine[0].fold if mine else self._fold))
            found = self.together(changed, chosen, further)
            if found:
                return found
        return []

    def _shortened(self, members: _Members) -> _Members:
        """Leave out members that are not needed; replace arms of any length by a sufficient shift, if there is one."""
        with suppress(SpentError):
            for member in members:
                rest = tuple(other for other in members if other is not member)
                for others in _further(rest) if member.is_hypothetical else [rest] if rest else []:
                    if self._trials.trial(self.applied_to_base(others), with_arms=False).is_possible:
                        return self._shortened(others)
            others = tuple(member for member in members if not member.is_hypothetical)
            if others and len(others) < len(members):
                base = self.applied_to_base(others)
                trial = self._trials.trial(base, with_arms=False)
                shifted = next(self.shifted(others, (base, trial)), None)
                return members if shifted is None else (*others, shifted)
        return members

    def shifted(self, others: _Members, tried: tuple[RelaxedProblem, Trial]) -> Iterator[_Member]:
        """Yield the least shifts that are enough for what is out of reach once other causes are removed."""
        kinds = {member.relaxation.kind for member in others}
        far = [r for r in self._trials.measured(tried[1]) if r.fold == self._fold and r.code is Code.OUT_OF_REACH]
        for relaxations in candidates(tried[1].context, tuple(far), self._fold):
            for relaxation in relaxations[:-1] if relaxations[-1].change.is_hypothetical else ():
                for amount in relaxation.amounts if relaxation.kind not in kinds else ():
                    if self._trials.is_enough(relaxation.change, tried[0], amount, with_arms=False):
                        yield _Member(relaxation, amount)
                        break

    def least_of(self, members: _Members) -> _Members:
        """Reduce each member to the least with which the others are enough; add what the arms touch then."""
        least = self._reduced(members, (0.0,) * len(members), with_arms=False)
        if any(member.is_hypothetical or member.relaxation.change is COLLISIONS_IGNORED for member in members):
            return least
        trial = self._trials.trial(self.applied_to_base(least), with_arms=True)
        if trial.is_possible:
            return least
        if self._trials.trial(self.applied_to_base(members), with_arms=True).is_possible:
            return self._reduced(members, [member.amount for member in least], with_arms=True)
        touched = self._trials.touched(trial)
        if touched is None:
            raise SpentError
        return (*least, _collision(touched))

    def _reduced(self, members: _Members, lows: Sequence[float], *, with_arms: bool) -> _Members:
        """Reduce each member in turn to the least above its lower limit with which the others are enough."""
        settled = list(members)
        for number, (member, low) in enumerate(zip(members, lows, strict=True)):
            if member.relaxation.amounts:
                rest = self.applied_to_base([other for n, other in enumerate(settled) if n != number])
                amount = self._trials.settled(member.relaxation, rest, low, member.amount, with_arms=with_arms)
                settled[number] = replace(member, amount=amount)
        return tuple(settled)

    def applied_to_base(self, members: Sequence[_Member]) -> RelaxedProblem:
        """Return the problem with the causes of some members removed."""
        relaxed = self._base
        for member in members:
            relaxed = relaxed.changed(member.relaxation.change, member.amount)
        return relaxed


def _further(members: _Members) -> Iterator[_Members]:
    """Yield the members with their amounts, then with each larger amount that they have."""
    most = max((len(member.relaxation.amounts) for member in members), default=0)
    for number in range(most):
        amounts = (member.relaxation.amounts for member in members)
        yield tuple(
            replace(member, amount=max(member.amount, its[min(number, len(its) - 1)])) if its else member
            for member, its in zip(members, amounts, strict=True)
        )
