"""Errors of reading and writing files, grouped by their remedy."""

import errno
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import ClassVar

from planner.errors import FoldingError


@dataclass
class StorageError(FoldingError):
    """A file could not be read or written.

    Attributes:
        what: the failed operation, as the beginning of a sentence.
        why: the system's reason, without a path.
    """

    what: str
    why: str
    remedy: ClassVar[str] = ""

    def __str__(self) -> str:
        return f"{self.what}: {self.why}{self.remedy}"


class ForbiddenStorageError(StorageError):
    """The file system is read-only, or the server's user lacks permission."""

    remedy = ". Let the server's user read and write its data folder."


class FullStorageError(StorageError):
    """The disk or the user's quota is full."""

    remedy = ". Make room on the disk of the data folder."


_FORBIDDEN = frozenset({errno.EACCES, errno.EPERM, errno.EROFS})
_FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})


def storage_error(what: str, error: OSError) -> StorageError:
    """Return the error for an operation that the system refused."""
    why = error.strerror or "the system refused"
    if error.errno in _FORBIDDEN:
        return ForbiddenStorageError(what, why)
    return FullStorageError(what, why) if error.errno in _FULL else StorageError(what, why)


@contextmanager
def storing(what: str) -> Iterator[None]:
    """Turn every `OSError` within into a `StorageError`; `what` begins its sentence."""
    try:
        yield
    except OSError as error:
        raise storage_error(what, error) from error
