"""Keep the answers used last, by all that they depend on, or by a digest of it where that is long."""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from hashlib import blake2b
from threading import Lock
from typing import Generic, TypeVar

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")

_DIGEST_BYTES = 16


class RecentAnswers(Generic[K, V]):
    """The answers used last, by all that they depend on. May be shared between threads.

    Who asks is not kept, unlike in `functools.lru_cache` of a method: an object that keeps its own answers is in no
    reference cycle, in which a search would stay for minutes, until the garbage collector looks at old objects.
    """

    def __init__(self, most: int) -> None:
        """Start empty, with room for a number of answers."""
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


def digest(*parts: bytes) -> bytes:
    """Return a short key of a long question; the parts' lengths are in it, so that no byte passes to the next part."""
    found = blake2b(digest_size=_DIGEST_BYTES)
    for part in parts:
        found.update(len(part).to_bytes(8, "little"))
        found.update(part)
    return found.digest()
