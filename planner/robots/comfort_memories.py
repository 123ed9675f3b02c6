"""Memories of the places within the comfort radius, handed on from plan to plan.

Where an arm reaches depends on the robot alone, and a garment that has changed a little asks about much the same
places. A memory (see `planner.robots.comfort`) must not be shared between threads, so a plan takes one and leaves it
when done. A plan is charged for what another has asked, so that its work does not depend on what came before it.
"""

from collections import deque

from planner.robots.comfort import GOOD, KNOWN, QUERIES, ROWS, Memory, empty_memory, no_hints

_LEFT_MAX = 2
"""Memories that are left for plans to come: as many as are mostly made at once."""

_FULL = 0.5
"""Share of a memory's rows from which it has no room for another plan."""


class Memories:
    """The memories of one robot for one torso height and comfort radius. Threads may share it."""

    def __init__(self) -> None:
        """Start without any."""
        self._left: deque[Memory] = deque(maxlen=_LEFT_MAX)

    def take(self) -> Memory:
        """Return the memory left last, or an empty one."""
        try:
            memory = self._left.pop()
        except IndexError:
            return empty_memory()
        memory.bits[:, KNOWN : GOOD + 1] = 0
        memory.counts[QUERIES] = 0
        return memory._replace(hints=no_hints())

    def leave(self, memory: Memory) -> None:
        """Leave a memory for another plan, unless it is too full."""
        if memory.counts[ROWS] < _FULL * len(memory.keys):
            self._left.append(memory)
