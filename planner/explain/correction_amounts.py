"""Find the least amount by which a way must change a problem so that its folds can be done."""

from collections.abc import Sequence
from contextlib import suppress

from planner.explain.correction import Way
from planner.explain.correction_trials import SpentError, Trials
from planner.explain.relaxed import Relaxed
from planner.geometry.tolerance import LENGTH_M
from planner.planning.trial import Trial


class LeastAmounts:
    """The search for least sufficient amounts, by bisection."""

    def __init__(self, trials: Trials, folds: int) -> None:
        """Take the trials, and the folds that must become possible, as a bit mask."""
        self._trials = trials
        self._folds = folds

    def is_enough(self, way: Way, base: Relaxed, amount: float, *, with_arms: bool = True) -> bool:
        """Return whether the folds can be done once a way is applied to a problem by an amount."""
        found = self._trials(way, base, amount, self._folds, with_arms=with_arms)
        return found is not None and found[1].is_possible

    def first(self, way: Way, base: Relaxed, low: float, amounts: Sequence[float], *, with_arms: bool) -> float | None:
        """Return the least amount up to the first sufficient one of some amounts; None if none is sufficient."""
        for amount in amounts:
            found = self._trials(way, base, amount, self._folds, with_arms=with_arms)
            if found is not None and found[1].is_possible:
                return self.settled(way, base, low, _needed(way, amount, found[1]), with_arms=with_arms)
            low = amount
        return None

    def settled(self, way: Way, base: Relaxed, low: float, high: float, *, with_arms: bool) -> float:
        """Return the least sufficient amount in an interval: try just below its upper end first, then halfway."""
        probe = high - way.exact
        with suppress(SpentError):
            while high - low > way.exact + LENGTH_M:
                tried = self._trials(way, base, probe, self._folds, with_arms=with_arms)
                if tried is not None and tried[1].is_possible:
                    high = _needed(way, probe, tried[1])
                else:
                    low = probe
                probe = high - way.exact if way.needed is not None and low < 0.5 * high else 0.5 * (low + high)
        return high


def _needed(way: Way, amount: float, trial: Trial) -> float:
    """Return how much of a sufficient amount the path found with it really needs."""
    return amount if way.needed is None else min(way.needed(trial), amount)
