"""Makes long work pause for short work.

All threads of a process share one interpreter. A search that runs beside an edit takes it over each time the edit calls
into a library, so an edit of 10 ms takes 100 ms. Searches ask often whether to stop; there they wait while any short
work is in progress, longer the longer they have worked. While short work keeps coming, as when hands move, they also
take turns, one at a time: each of them would keep the next edit from the interpreter until it asks again. Pieces of
short work do so too: three of them side by side would all take three times as long.
"""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

GIVE_WAY_S = 0.1
"""Longest wait for a turn (s)."""

WAIT_SHARE = 3.0
"""Longest wait for short work, as a multiple of what the long work has done since it waited last."""

RECENT_S = 0.5
"""Time after short work for which more of it is expected (s)."""


class Courtesy:
    """Tracks whether short work is in progress; safe to use from any thread."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        """Start with no short work in progress."""
        self._clock = clock
        self._lock = threading.Lock()
        self._count = 0
        self._is_free = threading.Event()
        self._is_free.set()
        self._recent_until_s = -1.0
        self._short = threading.RLock()
        self._next = threading.Lock()
        self._turn = threading.Lock()

    @contextmanager
    def short_work(self) -> Iterator[None]:
        """Make long work wait during this context, after a wait for other short work of up to `GIVE_WAY_S`."""
        with self._lock:
            self._count += 1
            self._is_free.clear()
        has_turn = self._short.acquire(timeout=GIVE_WAY_S)
        try:
            yield
        finally:
            if has_turn:
                self._short.release()
            with self._lock:
                self._count -= 1
                self._recent_until_s = self._clock() + RECENT_S
                if not self._count:
                    self._is_free.set()

    def give_way(self, at_most_s: float = GIVE_WAY_S) -> None:
        """Wait while short work is in progress, up to some time (s)."""
        self._is_free.wait(at_most_s)

    def take_turn(self) -> bool:
        """Wait for a turn while short work keeps coming, up to `GIVE_WAY_S`; return whether there is one to end.

        Who waits already is next: a turn that was ended and asked for again does not overtake it.
        """
        if self._clock() >= self._recent_until_s:
            return False
        with self._next:
            return self._turn.acquire(timeout=GIVE_WAY_S)

    def end_turn(self) -> None:
        """Let the next work take its turn."""
        self._turn.release()


class LongWork:
    """A piece of long work, in one thread, that gives way and takes turns."""

    def __init__(self, courtesy: Courtesy, clock: Callable[[], float] = time.monotonic) -> None:
        """Begin without a turn."""
        self._courtesy = courtesy
        self._clock = clock
        self._has_turn = False
        self._waited_at_s = clock()

    def give_way(self) -> None:
        """Wait for short work and for a turn."""
        self.end()
        self._courtesy.give_way(WAIT_SHARE * (self._clock() - self._waited_at_s))
        self._has_turn = self._courtesy.take_turn()
        self._waited_at_s = self._clock()

    def end(self) -> None:
        """End the turn, if there is one."""
        if self._has_turn:
            self._has_turn = False
            self._courtesy.end_turn()
