"""Sets of several changes that together allow a fold: found by removing one cause after another, and reduced."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

from planner.explain.relaxation import COLLISIONS_IGNORED, Candidate, Relaxation
from planner.explain.relaxation_amounts import LeastAmounts
from planner.explain.relaxation_candidates import candidates
from planner.explain.relaxation_trials import SpentError, Trials
from planner.explain.relaxed_problem import RelaxedProblem
from planner.planning.trial import Trial
from planner.task.reason import Code, Reason

_MEMBERS_MAX = 3
"""Causes in one set at most."""


@dataclass(frozen=True, slots=True, eq=False)
class Member:
    """A cause, the relaxation that removes it, the amount, and other kinds that are enough with this amount."""

    reason: Reason
    relaxation: Relaxation
    amount: float
    also: tuple[str, ...] = ()

    @property
    def told(self) -> Reason:
        """The reason to tell."""
        return self.relaxation.told(self.reason, self.amount)


class JointRelaxations:
    """The search for changes to one problem that are enough only together."""

    def __init__(self, base: RelaxedProblem, fold: int | None, folds: int, trials: Trials) -> None:
        """Take the problem, the fold to allow (None: the start), all folds it needs as a bit mask, and the trials."""
        self._base = base
        self._fold = fold
        self._folds = folds
        self._trials = trials
        self._amounts = LeastAmounts(trials, folds)

    def together(
        self, base: RelaxedProblem, members: tuple[Member, ...], own: Sequence[Candidate]
    ) -> list[tuple[Member, ...]]:
        """Return sets that together are enough: remove one cause and look what still stands in the way.

        Arms that reach everything come first, since they soon show what else stands in the way.
        """
        kinds = {member.relaxation.kind for member in members}
        onwards: list[tuple[tuple[Member, ...], RelaxedProblem, Trial]] = []
        ends = [(one, one.relaxations[0], one.relaxations[-1]) for one in own]
        firsts = [(one, last if last.kind == "arms" else first) for one, first, last in ends]
        for candidate, relaxation in sorted(firsts, key=lambda pair: pair[1].kind != "arms"):
            if relaxation.kind in kinds:
                continue
            amount = relaxation.most if relaxation.needed is not None else next(iter(relaxation.amounts), 0.0)
            tried = self._trials(relaxation, base, amount, self._folds, with_arms=False)
            if tried is None:
                continue
            chosen = (*members, Member(candidate.reason, relaxation, amount))
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

    def _shortened(self, members: tuple[Member, ...]) -> tuple[Member, ...]:
        """Leave out members that are not needed; replace arms of any length by a sufficient shift, if there is one."""
        with suppress(SpentError):
            for member in members:
                rest = tuple(other for other in members if other is not member)
                for others in _further(rest) if member.relaxation.is_hypothetical else [rest] if rest else []:
                    if self._trials.trial(self.applied_to_base(others), self._folds, with_arms=False).is_possible:
                        return self._shortened(others)
            others = tuple(member for member in members if not member.relaxation.is_hypothetical)
            if others and len(others) < len(members):
                base = self.applied_to_base(others)
                trial = self._trials.trial(base, self._folds, with_arms=False)
                shifted = next(self.shifted(others, (base, trial)), None)
                return members if shifted is None else (*others, shifted)
        return members

    def shifted(self, others: tuple[Member, ...], tried: tuple[RelaxedProblem, Trial]) -> Iterator[Member]:
        """Yield the least shifts that are enough for what is out of reach once other causes are removed."""
        kinds = {member.relaxation.kind for member in others}
        far = [r for r in self._trials.measured(tried[1]) if r.fold == self._fold and r.code is Code.OUT_OF_REACH]
        for candidate in candidates(tried[1].context, tuple(far), self._fold):
            for relaxation in candidate.relaxations[:-1] if candidate.relaxations[-1].is_hypothetical else ():
                for amount in relaxation.amounts if relaxation.kind not in kinds else ():
                    if self._amounts.is_enough(relaxation, tried[0], amount, with_arms=False):
                        yield Member(candidate.reason, relaxation, amount)
                        break

    def least_of(self, members: tuple[Member, ...]) -> tuple[Member, ...]:
        """Reduce each member to the least with which the others are enough; add what the arms touch then."""
        least = self._halved(members, (0.0,) * len(members), with_arms=False)
        if any(member.relaxation.is_hypothetical or member.relaxation is COLLISIONS_IGNORED for member in members):
            return least
        trial = self._trials.trial(self.applied_to_base(least), self._folds, with_arms=True)
        if trial.is_possible:
            return least
        if self._trials.trial(self.applied_to_base(members), self._folds, with_arms=True).is_possible:
            return self._halved(members, [member.amount for member in least], with_arms=True)
        touching = next((reason for reason in self._trials.measured(trial) if reason.code is Code.COLLISION), None)
        if touching is None:
            raise SpentError
        return (*least, Member(touching, COLLISIONS_IGNORED, 0.0))

    def _halved(self, members: tuple[Member, ...], lows: Sequence[float], *, with_arms: bool) -> tuple[Member, ...]:
        """Reduce each member in turn to the least above its lower limit with which the others are enough."""
        settled = list(members)
        for number, (member, low) in enumerate(zip(members, lows, strict=True)):
            if member.relaxation.amounts:
                rest = self.applied_to_base([other for n, other in enumerate(settled) if n != number])
                amount = self._amounts.settled(member.relaxation, rest, low, member.amount, with_arms=with_arms)
                settled[number] = replace(member, amount=amount)
        return tuple(settled)

    def applied_to_base(self, members: Sequence[Member]) -> RelaxedProblem:
        """Return the problem with the causes of some members removed."""
        relaxed = self._base
        for member in members:
            relaxed = member.relaxation.applied(relaxed, member.amount)
        return relaxed


def _further(members: tuple[Member, ...]) -> Iterator[tuple[Member, ...]]:
    """Yield causes removed by their amounts, and then by their larger amounts, as long as there are any."""
    most = max((len(member.relaxation.amounts) for member in members), default=0)
    for number in range(most):
        amounts = (member.relaxation.amounts for member in members)
        yield tuple(
            replace(member, amount=max(member.amount, its[min(number, len(its) - 1)])) if its else member
            for member, its in zip(members, amounts, strict=True)
        )
