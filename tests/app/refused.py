"""A folder in which the system refuses to write, as on a disk that is full or read-only.

Permissions do not bind root, who may run the tests, so the calls are refused before they reach the system.
"""

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

_CALLS = ("mkdir", "unlink", "remove", "rename", "replace", "rmdir")
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC


@contextmanager
def refused(monkeypatch: pytest.MonkeyPatch, folder: Path, name: str) -> Iterator[None]:
    """Refuse writing and removing in a folder meanwhile; `name` is that of the error."""
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

    with monkeypatch.context() as patched:
        for call in _CALLS:
            patched.setattr(os, call, guarded(getattr(os, call)))
        patched.setattr(os, "open", refusing_open)
        patched.setattr(os, "access", access)
        patched.setattr("io.open", refusing_io_open)
        yield
