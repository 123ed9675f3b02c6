"""Errors of a database as errors of storage, grouped by their remedy."""

import sqlite3
import tempfile
from pathlib import Path

from sqlalchemy.exc import DBAPIError

from app.store.storage_error import ForbiddenStorageError, FullStorageError, StorageError, storage_error

_MAIN_CODE = 0xFF
"""The bits of an SQLite error code that are the same for its variants."""

_FORBIDDEN = frozenset({sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM})
_FORBIDDEN_STATES = frozenset({"42501", "25006"})
"""PostgreSQL's states for missing rights, and for a server that only reads."""

_FULL_STATE = "53100"
_UNREACHABLE = "the database server cannot be reached"

_PROBE = b"\0" * 4096
"""Content of the test file; large enough to need a disk block, so that a full disk refuses it."""


def try_writing(folder: Path) -> None:
    """Write a file that has no name, and let it go; raise `OSError` if the system refuses."""
    with tempfile.TemporaryFile(dir=folder, prefix=".probe-") as file:
        file.write(_PROBE)


def database_error(what: str, error: DBAPIError, folder: Path | None) -> StorageError:
    """Return the error for an operation that the database refused.

    Args:
        what: the operation, as the beginning of a sentence.
        error: what the driver says.
        folder: the folder of an SQLite database, None for another one. SQLite gives no cause of a failed write but a
            full disk, so the folder is tried.
    """
    why = str(error.orig)
    if folder is None:
        state = getattr(error.orig, "sqlstate", None)
        if state is None:  # its words would name hosts and files
            return StorageError(what, _UNREACHABLE)
        if state == _FULL_STATE:
            return FullStorageError(what, why)
        return ForbiddenStorageError(what, why) if state in _FORBIDDEN_STATES else StorageError(what, why)
    code = getattr(error.orig, "sqlite_errorcode", 0) & _MAIN_CODE
    if code == sqlite3.SQLITE_FULL:
        return FullStorageError(what, why)
    if code in _FORBIDDEN:
        return ForbiddenStorageError(what, why)
    if code == sqlite3.SQLITE_IOERR:
        try:
            try_writing(folder)
        except OSError as cause:
            return storage_error(what, cause)
    return StorageError(what, why)
