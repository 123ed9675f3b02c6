"""Find the least amount by which a relaxation must change a problem so that its folds can be done."""

from collections.abc import Sequence
from contextlib import suppress

from planner.explain.relaxation import Relaxation
from planner.explain.relaxation_trials import SpentError, Trials
from planner.explain.relaxed_problem import RelaxedProblem
from planner.geometry.tolerance import LENGTH_M
from planner.planning.trial import Trial


class LeastAmounts:
    """The search for least sufficient amounts, by bisection."""

    def __init__(self, trials: Trials, folds: int) -> None:
        """Take the trials, and the folds that must become possible, as a bit mask."""
        self._trials = trials
        self._folds = folds

    def is_enough(self, relaxation: Relaxation, base: RelaxedProblem, amount: float, *, with_arms: bool = True) -> bool:
        """Return whether the folds can be done once a relaxation is applied to a problem by an amount."""
        found = self._trials(relaxation, base, amount, self._folds, with_arms=with_arms)
        return found is not None and found[1].is_possible

    def first(
        self, relaxation: Relaxation, base: RelaxedProblem, low: float, amounts: Sequence[float], *, with_arms: bool
    ) -> float | None:
        """Return the least amount up to the first sufficient one of some amounts; None if none is sufficient."""
        for amount in amounts:
            found = self._trials(relaxation, base, amount, self._folds, with_arms=with_arms)
            if found is not None and found[1].is_possible:
                return self.settled(relaxation, base, low, _needed(relaxation, amount, found[1]), with_arms=with_arms)
            low = amount
        return None

    def settled(
        self, relaxation: Relaxation, base: RelaxedProblem, low: float, high: float, *, with_arms: bool
    ) -> float:
        """Return the least sufficient amount in an interval: try just below its upper end first, then halfway."""
        probe = high - relaxation.exact
        with suppress(SpentError):
            while high - low > relaxation.exact + LENGTH_M:
                tried = self._trials(relaxation, base, probe, self._folds, with_arms=with_arms)
                if tried is not None and tried[1].is_possible:
                    high = _needed(relaxation, probe, tried[1])
                else:
                    low = probe
                probe = (
                    high - relaxation.exact
                    if relaxation.needed is not None and low < 0.5 * high
                    else 0.5 * (low + high)
                )
        return high


def _needed(relaxation: Relaxation, amount: float, trial: Trial) -> float:
    """Return how much of a sufficient amount the path found with it really needs."""
    return amount if relaxation.needed is None else min(relaxation.needed(trial), amount)
