"""A folder in which the system refuses to write, as on a disk that is full or read-only.

Permissions do not bind root, who may run the tests, so the calls are refused before they reach the system. SQLite's own
calls cannot be reached: its statements fail with the codes that it makes of such errors.
"""

import errno
import os
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import Engine, event

_SQLITE_ERRORS = {
    "ENOSPC": (sqlite3.SQLITE_FULL, "database or disk is full"),
    "EACCES": (sqlite3.SQLITE_READONLY, "attempt to write a readonly database"),
    "EPERM": (sqlite3.SQLITE_READONLY, "attempt to write a readonly database"),
    "EROFS": (sqlite3.SQLITE_READONLY, "attempt to write a readonly database"),
}
_SQLITE_FAILED = (sqlite3.SQLITE_IOERR_WRITE, "disk I/O error")
_CALLS = ("mkdir", "unlink", "remove", "rename", "replace", "rmdir")
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC


@contextmanager
def refused(monkeypatch: pytest.MonkeyPatch, folder: Path, name: str, *, databases_too: bool = True) -> Iterator[None]:
    """Refuse writing and removing in a folder meanwhile; `name` is that of the error.

    Databases are refused writing too, wherever they are, unless `databases_too` is false: those in memory go on.
    """
    number = getattr(errno, name)

    def refuse(path: Any) -> None:
        if isinstance(path, int):
            return
        where = Path(os.fsdecode(path))
        if where == folder or folder in where.parents:
            raise OSError(number, os.strerror(number), str(path))

    def guarded(call: Any) -> Any:
        def refusing(path: Any, *args: Any, **options: Any) -> Any:
            refuse(path)
            return call(path, *args, **options)

        return refusing

    real_open, real_access, real_io_open = os.open, os.access, open

    def refusing_open(path: Any, flags: int, *args: Any, **options: Any) -> int:
        if flags & _WRITING:
            refuse(path)
        return real_open(path, flags, *args, **options)

    def refusing_io_open(path: Any, mode: str = "r", *args: Any, **options: Any) -> Any:
        if set(mode) & set("wax+") and not isinstance(path, int) and "opener" not in options:
            refuse(path)
        return real_io_open(path, mode, *args, **options)

    def access(path: Any, mode: int, **options: Any) -> bool:
        inside = Path(path) == folder or folder in Path(path).parents
        is_denied = bool(mode & os.W_OK) and inside and number in (errno.EACCES, errno.EROFS, errno.EPERM)
        return not is_denied and real_access(path, mode, **options)

    def refuse_writing(_cursor: object, statement: str, *_: object) -> None:
        if statement.startswith(("INSERT", "UPDATE", "DELETE")):
            code, words = _SQLITE_ERRORS.get(name, _SQLITE_FAILED)
            error = sqlite3.OperationalError(words)
            error.sqlite_errorcode = code
            raise error

    with monkeypatch.context() as patched, _listening(refuse_writing) if databases_too else nullcontext():
        for call in _CALLS:
            patched.setattr(os, call, guarded(getattr(os, call)))
        patched.setattr(os, "open", refusing_open)
        patched.setattr(os, "access", access)
        patched.setattr("io.open", refusing_io_open)
        yield


@contextmanager
def _listening(refuse: Callable[..., None]) -> Iterator[None]:
    """Let a function see each statement of each SQLite database before it is carried out."""
    for name in ("do_execute", "do_executemany"):
        event.listen(Engine, name, refuse)
    try:
        yield
    finally:
        for name in ("do_execute", "do_executemany"):
            event.remove(Engine, name, refuse)
