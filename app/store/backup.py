"""A data folder and its database as one file, and back; the server may go on working while they are backed up.

The database is in the file as SQLite, as of one moment, whatever kind it is of: so it can be restored to another kind.
"""

import io
import json
import sqlite3
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import closing, suppress
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from sqlalchemy import func, insert, select

from app.store.data_folder import DataFolder
from app.store.database import Database
from app.store.durable_file import sync_folder
from app.store.schema import Table
from app.store.storage_error import storing
from planner.errors import FoldingError

_LABEL = "pleat-backup.json"
_FORMAT = 1
_OF_ONE_SERVER = frozenset({"server.lock", "server.json"})


@dataclass
class NoBackupError(FoldingError):
    """A file is not a backup that this version can read."""

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


def back_up(folder: DataFolder, target: Path, url: str | None = None) -> int:
    """Write all that is in a data folder and its database to a file, or nothing; return the number of files.

    Args:
        folder: the data folder.
        target: the file to write.
        url: the PostgreSQL database; None for the one in the folder.

    Raises:
        NoBackupError: there is no such folder.
        BadDatabaseUrlError: the URL names no database that can be used.
        StorageError: the system refuses.
    """
    if not folder.path.is_dir():
        raise NoBackupError(folder.path, "there is no such folder")
    count = 0
    with storing(f"{target} cannot be written"), tempfile.NamedTemporaryFile(dir=target.parent, delete=False) as file:
        try:
            with tarfile.open(fileobj=file, mode="w:gz") as archive:
                _add(archive, _LABEL, json.dumps({"format": _FORMAT}).encode())
                for name, content in chain(_database(folder, url), _files(folder)):
                    _add(archive, name, content)
                    count += 1
            file.flush()
            Path(file.name).replace(target)
        except BaseException:
            Path(file.name).unlink(missing_ok=True)
            raise
    sync_folder(target.parent)
    return count


def restore(source: Path, folder: DataFolder, url: str | None = None) -> int:
    """Make a data folder and a database of a backup; return the number of files.

    Args:
        source: the file that `back_up` has written.
        folder: the data folder.
        url: a PostgreSQL database; None for one in the folder.

    Raises:
        UsedFolderError: the folder is not empty.
        UsedDatabaseError: the PostgreSQL database is not empty.
        BadDatabaseUrlError: the URL names no database that can be used.
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
            if url is not None:
                _move_rows(DataFolder(whole).database, url)
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


def _move_rows(path: Path, url: str) -> None:
    """Move the rows of an SQLite file to a PostgreSQL database."""
    if not path.exists():
        return
    with closing(Database(path)) as source, closing(Database(path, url)) as target:
        copy_rows(source, target)
    path.unlink()


def _database(folder: DataFolder, url: str | None) -> Iterator[tuple[str, bytes]]:
    if url is not None:
        with tempfile.TemporaryDirectory() as beside:
            path = Path(beside) / folder.database.name
            with closing(Database(path, url)) as source, closing(Database(path)) as target:
                copy_rows(source, target)
            yield path.name, path.read_bytes()
        return
    if not folder.database.exists():
        return
    try:
        with closing(sqlite3.connect(folder.database)) as ours, closing(sqlite3.connect(":memory:")) as copy:
            ours.backup(copy)
            yield folder.database.name, copy.serialize()
    except sqlite3.DatabaseError as error:
        raise NoBackupError(folder.database, str(error)) from None


def _files(folder: DataFolder) -> Iterator[tuple[str, bytes]]:
    for path in sorted(path for path in folder.path.rglob("*") if path.is_file() and _is_kept(folder, path)):
        with suppress(FileNotFoundError):  # it was removed meanwhile
            yield str(path.relative_to(folder.path)), path.read_bytes()


def _is_kept(folder: DataFolder, path: Path) -> bool:
    """Return whether a file is backed up; temporary files and folders begin with a dot."""
    is_temporary = any(part.startswith(".") for part in path.relative_to(folder.path).parts)
    is_database = path.parent == folder.path and path.name.startswith(folder.database.name)
    return not (is_database or path.name in _OF_ONE_SERVER or is_temporary)


_AT_ONCE = 100
"""Number of rows copied at a time."""

_GIVEN_ANEW = "number"
"""The column that a database counts up: it gives copied rows numbers of its own, in the same order."""


@dataclass
class UsedDatabaseError(FoldingError):
    """The database to restore to has something in it."""

    table: str

    def __str__(self) -> str:
        return f"the database is not empty, it has {self.table}; restore to a new one"


def copy_rows(source: Database, target: Database) -> None:
    """Copy all rows of a database, as of one moment, to an empty one; all of them or none.

    Raises:
        UsedDatabaseError: the target is not empty.
        StorageError: a database refuses.
    """
    with source.reading("the database could not be read") as old, target.writing("it could not be copied") as new:
        for table in Table.metadata.sorted_tables:
            if new.scalar(select(func.count()).select_from(table)):
                raise UsedDatabaseError(table.name)
        for table in Table.metadata.sorted_tables:
            counted = [
                column for column in table.primary_key if column.name == _GIVEN_ANEW and column.autoincrement is True
            ]
            columns = [column for column in table.columns if column not in counted]
            rows = old.execute(select(*columns).order_by(*(counted or table.primary_key)))
            for some in rows.mappings().partitions(_AT_ONCE):
                new.execute(insert(table), [dict(row) for row in some])
