"""Keep short answers to long questions: which is why the key is a digest and the question is not kept."""

from collections.abc import Callable
from hashlib import blake2b
from typing import Generic, TypeVar

T = TypeVar("T", bool, float)

_DIGEST_BYTES = 16


class AnswerMemory(Generic[T]):
    """Answers by all that they depend on; once there are many, all are forgotten. May be shared between threads."""

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
