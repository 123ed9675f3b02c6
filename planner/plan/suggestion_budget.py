"""The time that a search for suggestions has, and how much of it one trial may take."""

import time
from collections.abc import Callable

from planner.plan.make_plan import TIME_LIMIT_S

SHORTEST_TRIAL_S = 1.0
"""Less would cut off most plans just before they are found."""

TRIALS_LEFT = 6
_LEAST_S, _MOST_S = TIME_LIMIT_S


class Budget:
    """Time that runs out, or is cut short by `should_stop`."""

    def __init__(self, time_limit_s: float, should_stop: Callable[[], bool] | None = None) -> None:
        """Begins now."""
        self._started = time.perf_counter()
        self._time_limit_s = time_limit_s
        self.is_stopped = should_stop or (lambda: False)

    @property
    def elapsed_s(self) -> float:
        """How long it has run (s)."""
        return time.perf_counter() - self._started

    def has_spent(self, share: float) -> bool:
        """Whether this share of the time has gone, or somebody wants it to stop."""
        return self.elapsed_s >= share * self._time_limit_s or self.is_stopped()

    @property
    def trial_s(self) -> float:
        """What the next trial may take (s): a fraction of what is left."""
        return self.at_most(max(self._left_s / TRIALS_LEFT, SHORTEST_TRIAL_S))

    def at_most(self, wanted_s: float) -> float:
        """So much time, or what is left if that is less (s); never too little for a planner to take it."""
        return min(max(min(wanted_s, self._left_s), _LEAST_S), _MOST_S)

    @property
    def _left_s(self) -> float:
        return self._time_limit_s - self.elapsed_s
