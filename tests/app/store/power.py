"""A disk that loses power: what was written is there for sure only once it was synced.

The statements of a real database, its settings included, are carried out again by another SQLite whose files note every
write and every sync. A cut somewhere in this log leaves each file as it was synced last, and by chance some of the
sectors that were written since.
"""

import random
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import apsw

SECTOR = 512
"""Bytes that a disk writes as a whole."""

_VFS = "noted"


@dataclass(frozen=True, slots=True)
class Write:
    """Bytes written to a file at an offset; None at the end of a truncated file."""

    file: str
    offset: int
    data: bytes | None


@dataclass(frozen=True, slots=True)
class Sync:
    """A sync of a file: all that was written to it before is on the disk."""

    file: str


@dataclass(frozen=True, slots=True)
class Deleted:
    """A file was removed."""

    file: str


@dataclass(frozen=True, slots=True)
class Acknowledged:
    """A change was told to be kept."""

    version: int


Event: TypeAlias = Write | Sync | Deleted | Acknowledged


class _NotedFile(apsw.VFSFile):
    """A file that notes what happens to it."""

    def __init__(self, name: str | apsw.URIFilename | None, flags: list[int], log: list[Event]) -> None:
        path = name.filename() if isinstance(name, apsw.URIFilename) else name
        self._name = Path(path or "temporary").name
        self._log = log
        super().__init__("", name, flags)

    def xWrite(self, data: bytes, offset: int) -> None:  # noqa: N802
        self._log.append(Write(self._name, offset, bytes(data)))
        super().xWrite(data, offset)

    def xTruncate(self, newsize: int) -> None:  # noqa: N802
        self._log.append(Write(self._name, newsize, None))
        super().xTruncate(newsize)

    def xSync(self, flags: int) -> None:  # noqa: N802
        self._log.append(Sync(self._name))
        super().xSync(flags)


class _NotedFiles(apsw.VFS):
    """A file system that notes what happens to its files."""

    def __init__(self, log: list[Event]) -> None:
        self._log = log
        super().__init__(_VFS, base="")

    def xOpen(self, name: str | apsw.URIFilename | None, flags: list[int]) -> apsw.VFSFile:  # noqa: N802
        return _NotedFile(name, flags, self._log)

    def xDelete(self, filename: str, syncdir: bool) -> None:  # noqa: N802
        self._log.append(Deleted(Path(filename).name))
        super().xDelete(filename, syncdir)


def written_by(statements: Sequence[str | Acknowledged], folder: Path) -> list[Event]:
    """Carry statements out on a new database, and return what happened to its files."""
    log: list[Event] = []
    files = _NotedFiles(log)
    connection = apsw.Connection(str(folder / "pleat.db"), vfs=_VFS)
    try:
        connection.execute("PRAGMA locking_mode=EXCLUSIVE")  # there is no shared memory; syncs are the same
        for statement in statements:
            if isinstance(statement, Acknowledged):
                log.append(statement)
            else:
                connection.execute(statement).fetchall()
        events = [*log]
    finally:
        connection.close()
        files.unregister()
    return events


def cut(events: Sequence[Event], folder: Path, rng: random.Random) -> int:
    """Write into a folder what a power cut after the events leaves; return the version acknowledged last, 0 if none.

    Of what was not synced some sectors are there and some are not, in whatever order.
    """
    synced: dict[str, bytearray] = {}
    loose: dict[str, list[Write]] = {}
    acknowledged = 0
    for event in events:
        match event:
            case Write():
                loose.setdefault(event.file, []).append(event)
            case Sync():
                content = synced.setdefault(event.file, bytearray())
                for write in loose.pop(event.file, []):
                    _put(content, write)
            case Deleted():
                synced.pop(event.file, None)
                loose.pop(event.file, None)
            case Acknowledged():
                acknowledged = event.version
    for name, writes in loose.items():
        content = synced.setdefault(name, bytearray())
        for write in writes:
            for part in _sectors(write):
                if rng.random() < 0.5:
                    _put(content, part)
    for name, content in synced.items():
        (folder / name).write_bytes(content)
    return acknowledged


def _sectors(write: Write) -> list[Write]:
    if write.data is None:
        return [write]
    starts = range(0, len(write.data), SECTOR)
    return [Write(write.file, write.offset + start, write.data[start : start + SECTOR]) for start in starts]


def _put(content: bytearray, write: Write) -> None:
    if write.data is None:
        del content[write.offset :]
        return
    end = write.offset + len(write.data)
    content.extend(bytes(max(end - len(content), 0)))
    content[write.offset : end] = write.data
