"""Keep the answers to the questions asked last."""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Generic, TypeVar

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")


class RecentAnswers(Generic[K, V]):
    """The answers used last, by all that they depend on. May be shared between threads.

    Who asks is not kept, unlike in `functools.lru_cache` of a method: an object that keeps its own answers is in no
    reference cycle, in which a search would stay for minutes, until the garbage collector looks at old objects.
    """

    def __init__(self, most: int) -> None:
        """Start without answers; so many are kept."""
        self._most = most
        self._lock = Lock()
        self._known: OrderedDict[K, V] = OrderedDict()

    def answer(self, key: K, ask: Callable[[K], V]) -> V:
        """Return the answer for a key; `ask` is called unless it is known."""
        with self._lock:
            if key in self._known:
                self._known.move_to_end(key)
                return self._known[key]
        found = ask(key)
        with self._lock:
            self._known[key] = found
            if len(self._known) > self._most:
                self._known.popitem(last=False)
        return found
