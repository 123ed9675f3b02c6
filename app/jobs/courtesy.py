"""Lets long work step aside for short work.

All threads of a process share one interpreter. A search that runs beside an edit takes it away each time the edit
calls into a library, and the edit of a hundredth of a second takes a tenth. So searches, which ask again and again
whether they should stop, wait at these moments while anything short is under way.
"""

import threading
from collections.abc import Iterator
from contextlib import contextmanager

GIVE_WAY_S = 0.1
"""Longest wait at one such moment (s): without a pause in the short work long work gets on nevertheless."""


class Courtesy:
    """Knows whether anything short is under way; may be used from any thread."""

    def __init__(self) -> None:
        """Begin with nothing under way."""
        self._lock = threading.Lock()
        self._count = 0
        self._is_free = threading.Event()
        self._is_free.set()

    @contextmanager
    def short_work(self) -> Iterator[None]:
        """Have long work wait meanwhile."""
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
        """Wait while anything short is under way, but not for long."""
        self._is_free.wait(GIVE_WAY_S)
