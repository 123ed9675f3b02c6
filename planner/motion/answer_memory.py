"""Keep answers by all that they depend on: the last ones used, or many short answers to long questions."""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from hashlib import blake2b
from threading import Lock
from typing import Generic, TypeVar

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")
T = TypeVar("T", bool, float)

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


class AnswerMemory(Generic[T]):
    """Short answers by a digest of long questions, which are not kept; once there are many, all are forgotten.

    May be shared between threads.
    """

    def __init__(self, most: int) -> None:
        """Start without answers.

        Args:
            most: the number of answers kept, some 100 bytes each.
        """
        self._most = most
        self._known: dict[bytes, T] = {}

    def answer(self, ask: Callable[[], T], *about: bytes) -> T:
        """Return the answer to a question about some data; `ask` is called unless the answer is known."""
        key = _digest(about)
        found = self._known.get(key)
        if found is None:
            found = ask()
            if len(self._known) >= self._most:
                self._known.clear()
            self._known[key] = found
        return found


def _digest(parts: tuple[bytes, ...]) -> bytes:
    """Return a short key; the lengths are in it, so that no byte passes from one part to the next."""
    digest = blake2b(digest_size=_DIGEST_BYTES)
    for part in parts:
        digest.update(len(part).to_bytes(8, "little"))
        digest.update(part)
    return digest.digest()
