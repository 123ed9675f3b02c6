"""Relaxations: changes that may remove a cause, tried within limits, and reduced to the least that is enough."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass

from planner.errors import FoldingError
from planner.explain.change import Bisection, Change, SpentError
from planner.explain.changes import COLLISIONS_IGNORED
from planner.explain.reasons import reasons_met
from planner.explain.relaxed_problem import Ask, RelaxedProblem
from planner.planning.trial import Trial
from planner.task.reason import Code, Reason


@dataclass(frozen=True, slots=True, eq=False)
class Relaxation:
    """A change that may remove a cause.

    Attributes:
        reason: the cause.
        change: the change.
        amounts: by how much, tried in turn, the last the most permissive; empty where the change has no degree.
        told: makes the reason to report from the cause, once an amount was tried.
        needed: the amount that the path found really needs, where that can be told.
    """

    reason: Reason
    change: Change
    amounts: tuple[float, ...] = ()
    told: Callable[[Reason, float], Reason] = lambda reason, _: reason
    needed: Callable[[Trial], float] | None = None

    @property
    def kind(self) -> str:
        """What is changed."""
        return self.change.kind

    @property
    def most(self) -> float:
        """The largest amount; 0 where there are none."""
        return max(self.amounts, default=0.0)

    def reason_with(self, amount: float) -> Reason:
        """Return the reason to report once an amount was tried."""
        return self.told(self.reason, amount)


class Trials:
    """Trials whether some folds can be done; a change that gives no valid problem counts as no help."""

    def __init__(self, ask: Ask, is_enough: Callable[[], bool], folds: int) -> None:
        """Take what tries a problem, what is polled before, and the folds that must become possible, as a bit mask."""
        self._ask = ask
        self._is_enough = is_enough
        self._folds = folds
        self._known: dict[tuple[Change, RelaxedProblem, float, bool], tuple[RelaxedProblem, Trial] | None] = {}

    def trial(self, relaxed: RelaxedProblem, *, with_arms: bool) -> Trial:
        """Return the trial of a problem; without arms it is enough that all places are in reach."""
        self._require_time()
        return self._ask(relaxed if with_arms else relaxed.changed(COLLISIONS_IGNORED), self._folds)

    def measured(self, trial: Trial) -> tuple[Reason, ...]:
        """Return the reasons that a trial met."""
        self._require_time()
        return reasons_met(trial.obstacles)

    def touched(self, trial: Trial) -> Reason | None:
        """Return what the arms touch in a trial, as a reason; None where it met no collision."""
        return next((reason for reason in self.measured(trial) if reason.code is Code.COLLISION), None)

    def with_change(
        self, change: Change, base: RelaxedProblem, amount: float, *, with_arms: bool
    ) -> tuple[RelaxedProblem, Trial] | None:
        """Return a problem with a change made and its trial; None where the change gives no valid problem."""
        key = (change, base, amount, with_arms)
        if key not in self._known:
            changed = changed_or_none(base, change, amount)
            self._known[key] = None if changed is None else (changed, self.trial(changed, with_arms=with_arms))
        return self._known[key]

    def is_enough(self, change: Change, base: RelaxedProblem, amount: float, *, with_arms: bool = True) -> bool:
        """Return whether the folds can be done once a change is made to a problem by an amount."""
        found = self.with_change(change, base, amount, with_arms=with_arms)
        return found is not None and found[1].is_possible

    def least(
        self, relaxation: Relaxation, base: RelaxedProblem, low: float, amounts: Sequence[float], *, with_arms: bool
    ) -> float | None:
        """Return the least amount up to the first sufficient one of some amounts; None if none is sufficient."""
        for amount in amounts:
            needed = self._needed(relaxation, base, amount, with_arms=with_arms)
            if needed is not None:
                return self.settled(relaxation, base, low, needed, with_arms=with_arms)
            low = amount
        return None

    def settled(
        self, relaxation: Relaxation, base: RelaxedProblem, low: float, high: float, *, with_arms: bool
    ) -> float:
        """Return the least sufficient amount in an interval; its upper end is sufficient."""
        search = Bisection(low, high, relaxation.change.step, is_near=True)
        with suppress(SpentError):
            while (amount := search.amount) is not None:
                search.note(amount, self._needed(relaxation, base, amount, with_arms=with_arms))
                search.is_near = relaxation.needed is not None and search.fails < 0.5 * search.works
        return search.works

    def _require_time(self) -> None:
        if self._is_enough():
            raise SpentError

    def _needed(self, relaxation: Relaxation, base: RelaxedProblem, amount: float, *, with_arms: bool) -> float | None:
        """Return how much of an amount the path found with it really needs; None if it is not sufficient."""
        found = self.with_change(relaxation.change, base, amount, with_arms=with_arms)
        if found is None or not found[1].is_possible:
            return None
        return amount if relaxation.needed is None else min(relaxation.needed(found[1]), amount)


def changed_or_none(base: RelaxedProblem, change: Change, amount: float) -> RelaxedProblem | None:
    """Return a problem with a change made; None where that gives no valid problem."""
    try:
        return base.changed(change, amount)
    except FoldingError:
        return None
