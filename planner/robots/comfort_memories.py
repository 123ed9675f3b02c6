"""Memories of the places within the comfort radius, handed on from plan to plan.

Where an arm reaches depends on the robot alone, and a garment that has changed a little asks about much the same
places. A memory (see `planner.robots.comfort`) must not be shared between threads, so a plan takes one and leaves it
when done. A plan is charged for what another has asked, so that its work does not depend on what came before it.
"""

from collections import deque

from planner.robots.comfort import GOOD, KNOWN, QUERIES, ROWS, Memory, empty_memory

_LEFT_MAX = 2
"""Memories that are left for plans to come: as many as are mostly made at once."""

_FULL = 0.5
"""Share of a memory's rows from which it has no room for another plan."""

_SMALL_BITS = 4
"""Size of a memory that will hardly be used any more, as a power of two."""


class Memories:
    """The memories of one robot for one torso height and comfort radius. Threads may share it."""

    def __init__(self) -> None:
        self._left: deque[Memory] = deque(maxlen=_LEFT_MAX)

    def take(self) -> Memory:
        """Return the memory left last, or an empty one."""
        try:
            memory = self._left.pop()
        except IndexError:
            return empty_memory()
        memory.bits[:, KNOWN : GOOD + 1] = 0
        memory.counts[QUERIES] = 0
        return memory

    def leave(self, memory: Memory) -> None:
        """Leave a memory for another plan, unless it is too full."""
        if memory.counts[ROWS] < _FULL * len(memory.keys):
            self._left.append(memory)


class PlanMemory:
    """The memory of one plan, and its counters; implements `planner.primitives.reach.ReachMemory`.

    Attributes:
        rows: what the compiled queries remember; they add to it.
        query_time_s: the time spent on answers (s), remembered ones included.
    """

    def __init__(self, others: Memories | None = None) -> None:
        """Take what other plans have found out; None: nothing."""
        self._others = others
        self.rows = empty_memory() if others is None else others.take()
        self.query_time_s = 0.0
        self._more_queries = 0

    @property
    def queries(self) -> int:
        """The number of queries computed by the exact kernel so far, points on the comfort circle included.

        What is remembered, or further away than the arm is long, is answered without a query.
        """
        return int(self.rows.counts[QUERIES]) + self._more_queries

    def charge(self, time_s: float, queries: int = 0) -> None:
        """Add the time of an answer (s), and queries that it took beyond those about remembered places."""
        self.query_time_s += time_s
        self._more_queries += queries

    def forget(self) -> None:
        """Leave the memory, some 4 MB, to another plan and keep the counters; the answers stay the same."""
        queries = self.rows.counts[QUERIES]
        if self._others is not None:
            self._others.leave(self.rows)
            self._others = None
        self.rows = empty_memory(_SMALL_BITS)
        self.rows.counts[QUERIES] = queries

    def share(self) -> None:
        """Leave a copy of the memory to the next plan (1 ms); see `Memories`."""
        if self._others is not None and self.rows.counts[ROWS]:
            self._others.leave(Memory(*(part.copy() for part in self.rows)))
