"""An immutable value that is replaced under a lock, and the listeners that are called after a change.

A reader takes the value without the lock and never sees half a change; a listener is called outside of the lock, so
that it may read and change the value itself.
"""

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")

Listener = Callable[[], None]


class Observable(Generic[T]):
    """A value that several threads read and change."""

    def __init__(self, value: T) -> None:
        """Start with a value and no listeners."""
        self._value = value
        self._lock = threading.Lock()
        self._listeners: list[Listener] = []

    @property
    def value(self) -> T:
        """The current value."""
        return self._value

    def subscribe(self, listener: Listener) -> Callable[[], None]:
        """Call a function after every change, in the thread that made it; return the function that unsubscribes it."""
        with self._lock:
            self._listeners.append(listener)

        def unsubscribe() -> None:
            with self._lock:
                self._listeners.remove(listener)

        return unsubscribe

    def change(self, change: Callable[[T], T]) -> T:
        """Replace the value by a function of it, and return it; observers hear only of a different value."""
        with self._lock:
            before, self._value = self._value, change(self._value)
            after, listeners = self._value, tuple(self._listeners)
        if after is not before:
            for listener in listeners:
                listener()
        return after
