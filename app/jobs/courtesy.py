"""Makes long work pause for short work.

All threads of a process share one interpreter. A search that runs beside an edit takes it over each time the edit calls
into a library, so an edit of 10 ms takes 100 ms. Searches ask often whether to stop; there they wait while any short
work is in progress.
"""

import threading
from collections.abc import Iterator
from contextlib import contextmanager

GIVE_WAY_S = 0.1
"""Longest wait at one such point (s); it lets long work progress even if short work never pauses."""


class Courtesy:
    """Tracks whether short work is in progress; safe to use from any thread."""

    def __init__(self) -> None:
        """Start with no short work in progress."""
        self._lock = threading.Lock()
        self._count = 0
        self._is_free = threading.Event()
        self._is_free.set()

    @contextmanager
    def short_work(self) -> Iterator[None]:
        """Make long work wait during this context."""
        with self._lock:
            self._count += 1
            self._is_free.clear()
        try:
            yield
        finally:
            with self._lock:
                self._count -= 1
                if not self._count:
                    self._is_free.set()

    def give_way(self) -> None:
        """Wait while short work is in progress, up to `GIVE_WAY_S`."""
        self._is_free.wait(GIVE_WAY_S)
