"""A data folder as one file, and back; the server may go on working while its folder is backed up.

A document's files belong together: they are read until two readings in a row agree. The database is copied by SQLite,
which takes one moment of it.
"""

import io
import itertools
import json
import sqlite3
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from app.store.data_folder import DataFolder
from app.store.durable_file import sync_folder
from app.store.storage_error import storing
from planner.errors import FoldingError

_LABEL = "pleat-backup.json"
_FORMAT = 1
_OF_ONE_SERVER = frozenset({"server.lock", "server.json"})
_READINGS_MAX = 50
"""Readings of one document: a drag that goes on for ever must not hold up the backup."""


@dataclass
class NoBackupError(FoldingError):
    """A file is no backup that this version can read."""

    path: Path
    why: str

    def __str__(self) -> str:
        return f"{self.path} is no backup of Pleat: {self.why}"


@dataclass
class UsedFolderError(FoldingError):
    """The folder to restore to has something in it."""

    folder: Path

    def __str__(self) -> str:
        return f"{self.folder} is not empty; restore to a new folder, or move this one away first"


def back_up(folder: DataFolder, target: Path) -> int:
    """Write all that is in a data folder to a file, whole or not at all; return the number of files.

    Raises:
        NoBackupError: there is no such folder.
        StorageError: the system refuses.
    """
    if not folder.path.is_dir():
        raise NoBackupError(folder.path, "there is no such folder")
    count = 0
    with storing(f"{target} cannot be written"), tempfile.NamedTemporaryFile(dir=target.parent, delete=False) as file:
        try:
            with tarfile.open(fileobj=file, mode="w:gz") as archive:
                _add(archive, _LABEL, json.dumps({"format": _FORMAT}).encode())
                for name, content in itertools.chain(_database(folder), _files(folder)):
                    _add(archive, name, content)
                    count += 1
            file.flush()
            Path(file.name).replace(target)
        except BaseException:
            Path(file.name).unlink(missing_ok=True)
            raise
    sync_folder(target.parent)
    return count


def restore(source: Path, folder: DataFolder) -> int:
    """Make a data folder of a backup; return the number of files.

    Raises:
        UsedFolderError: the folder is not empty.
        NoBackupError: the file is no backup, or a newer version of Pleat wrote it.
        StorageError: the system refuses.
    """
    with storing(f"{folder.path} cannot be restored"):
        if folder.path.exists() and any(folder.path.iterdir()):
            raise UsedFolderError(folder.path)
        folder.path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.path.parent, prefix=".restored-") as beside:
            whole = Path(beside) / "data"
            count = _extracted(source, whole)
            whole.replace(folder.path)  # an empty folder may be replaced
    return count


def _extracted(source: Path, target: Path) -> int:
    try:
        with tarfile.open(source, mode="r:gz") as archive:
            label = archive.extractfile(_LABEL)
            found = None if label is None else json.load(label).get("format")
            if found != _FORMAT:
                raise NoBackupError(source, f"its format is {found}, this version reads {_FORMAT}")
            archive.extractall(target, filter="data")
    except (tarfile.TarError, KeyError, ValueError, AttributeError, EOFError) as error:
        raise NoBackupError(source, str(error).strip("'")) from None
    (target / _LABEL).unlink()
    return sum(1 for path in target.rglob("*") if path.is_file())


def _add(archive: tarfile.TarFile, name: str, content: bytes) -> None:
    entry = tarfile.TarInfo(name)
    entry.size, entry.mode = len(content), 0o600
    archive.addfile(entry, io.BytesIO(content))


def _database(folder: DataFolder) -> Iterator[tuple[str, bytes]]:
    if not folder.database.exists():
        return
    try:
        with closing(sqlite3.connect(folder.database)) as ours, closing(sqlite3.connect(":memory:")) as copy:
            ours.backup(copy)
            yield folder.database.name, copy.serialize()
    except sqlite3.DatabaseError as error:
        raise NoBackupError(folder.database, str(error)) from None


def _files(folder: DataFolder) -> Iterator[tuple[str, bytes]]:
    """Yield the files, those that belong together as of one moment."""
    paths = sorted(path for path in folder.path.rglob("*") if path.is_file() and _is_kept(folder, path))
    for _, group in itertools.groupby(paths, key=lambda path: path.with_suffix("")):
        files = list(group)
        content = _read(files)
        for _ in range(_READINGS_MAX):
            before, content = content, _read(files)
            if content == before:
                break
        for path, data in content.items():
            yield str(path.relative_to(folder.path)), data


def _is_kept(folder: DataFolder, path: Path) -> bool:
    """Return whether a file is backed up; temporary files and folders begin with a dot."""
    is_temporary = any(part.startswith(".") for part in path.relative_to(folder.path).parts)
    is_database = path.parent == folder.path and path.name.startswith(folder.database.name)
    return not (is_database or path.name in _OF_ONE_SERVER or is_temporary)


def _read(files: list[Path]) -> dict[Path, bytes]:
    """Return the content of the files that are still there."""
    content = {}
    for path in files:
        try:
            content[path] = path.read_bytes()
        except FileNotFoundError:
            continue
    return content
