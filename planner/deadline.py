"""The time that somebody waits for an answer; long loops, also deep inside, poll it.

It is the processor time of the process that searches: beside other programs a search takes longer, and finds the same.
So that whoever waits gets an answer all the same, the clock on the wall ends it too, much later (`WALL_FACTOR`).
"""

import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

ShouldStop = Callable[[], bool]
"""Is called repeatedly by a piece of work that takes long: whether nobody wants its answer any more."""

clock_s = time.process_time
"""The clock of every time limit: the processor time of this process (s)."""

wall_clock_s = time.perf_counter
"""The clock that guards against a process that hardly gets a processor, or waits for something (s)."""

WALL_FACTOR, WALL_LEAST_S = 10.0, 5.0
"""The time by the clock on the wall after which a search ends: so many times its time limit, and this much more (s)."""

LOOK_S = 1e-3
"""Least time from one look at the processor time to the next (s): on a busy machine a look takes half a millisecond."""

_GRACE_S = 0.15
"""Time that a step may take after the deadline before it is cut short (s): callers allow half a second in all."""

_left_out = threading.local()


def longest_wait_s(time_limit_s: float) -> float:
    """Return after how long by the clock on the wall a search with a time limit has ended (s)."""
    return WALL_FACTOR * time_limit_s + WALL_LEAST_S


@contextmanager
def left_out() -> Iterator[None]:
    """Leave the processor time of this thread inside the context out of what deadlines count, once it is done."""
    begun_s = time.thread_time()
    yield
    _left_out.spent_s = _left_out_s() + time.thread_time() - begun_s


class Deadline:
    """When the time of a search is up, or nobody wants its answer any more. Once it is over it stays so."""

    def __init__(self, time_limit_s: float = math.inf, should_stop: ShouldStop | None = None) -> None:
        """Begin now.

        Args:
            time_limit_s: the time until it is over (s).
            should_stop: polled as well; it is over once this returns true.
        """
        self._own_s = _own_s() + time_limit_s
        self._wall_s = wall_clock_s() + longest_wait_s(time_limit_s)
        self._should_stop = should_stop
        self._is_over = False
        self._look_s = 0.0

    @property
    def left_s(self) -> float:
        """The time that is left (s); negative once it is up."""
        return min(self._own_s - _own_s(), self._wall_s - wall_clock_s())

    @property
    def is_stopped(self) -> bool:
        """Whether nobody wants the answer any more."""
        return self._should_stop is not None and self._should_stop()

    @property
    def is_over(self) -> bool:
        """Whether the time is up, or nobody wants the answer any more."""
        now_s = wall_clock_s()
        if not self._is_over and now_s >= self._look_s:
            self._look_s = now_s + LOOK_S
            self._is_over = self.left_s < 0.0
        self._is_over = self._is_over or self.is_stopped
        return self._is_over

    @property
    def is_long_over(self) -> bool:
        """Whether it is over since a moment, so that a single step that was begun in time has mostly ended."""
        return self.left_s < -_GRACE_S or self.is_stopped

    def put_off(self, later: "Deadline") -> None:
        """Have the time be up when it is for another deadline."""
        self._own_s, self._wall_s = later._own_s, later._wall_s

    def forget(self) -> None:
        """Limit nothing any more, and know nothing of who waited."""
        self._own_s = self._wall_s = math.inf
        self._should_stop, self._is_over = None, False


def _own_s() -> float:
    """Return the processor time of this process without what is left out (s)."""
    return clock_s() - _left_out_s()


def _left_out_s() -> float:
    found: float = getattr(_left_out, "spent_s", 0.0)
    return found


ENDLESS = Deadline()
"""The deadline of what nobody waits for."""
