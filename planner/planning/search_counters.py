"""Count the work that goes into a plan."""

import time
from collections.abc import Iterator
from contextlib import contextmanager

from planner.primitives.reach import ReachMemory
from planner.task.plan import Statistics


class SearchCounters:
    """Counters of one attempt at a plan.

    Attributes:
        expanded: states whose steps were looked at.
        explored: steps looked at.
    """

    def __init__(self) -> None:
        """Start the clock."""
        self.expanded = 0
        self.explored = 0
        self._started = time.perf_counter()
        self._joint_time_s = 0.0

    @contextmanager
    def on_joints(self) -> Iterator[None]:
        """Count the time inside the context as spent on joint paths."""
        begun = time.perf_counter()
        try:
            yield
        finally:
            self._joint_time_s += time.perf_counter() - begun

    def leave_out(self, seconds: float) -> None:
        """Leave out time that is counted elsewhere (s)."""
        self._started += seconds

    def statistics(self, reached: ReachMemory, bound_s: float | None) -> Statistics:
        """Return the statistics so far, for a plan whose lower bound is `bound_s` (s)."""
        search_s = time.perf_counter() - self._started - self._joint_time_s
        return Statistics(
            self.expanded, self.explored, reached.queries, reached.query_time_s, search_s, self._joint_time_s, bound_s
        )
