"""The repository of robots of one's own: in the database, and as folders, from which planning reads them.

The database has each robot as an archive. The folders of a server are copies, brought up to date at its start and,
where other servers use the database too, every few seconds: `refresh`. Without other servers a folder that differs from
the database was changed by hand, or by a version that kept robots as folders alone, and is taken over.
"""

import hashlib
import io
import json
import logging
import shutil
import tempfile
import threading
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from zipfile import ZIP_DEFLATED, BadZipFile, ZipFile, ZipInfo

from sqlalchemy import delete, insert, select
from sqlalchemy.orm import Session

from app.store.database import Database
from app.store.durable_file import sync_folder, write_at_once
from app.store.schema import RobotRow
from app.store.storage_error import storing
from planner.errors import ReadOnlyRobotError, UnknownRobotError
from planner.robots.card_file import CardFile
from planner.robots.known_robots import shipped_robots
from planner.robots.own_robots import CARD

_BEFORE, _NEW = ".before-", ".new-"
"""Prefixes of the folders of robots that are being replaced, and of new ones."""

_BAD = (
    BadZipFile,
    EOFError,
    FileExistsError,
    IsADirectoryError,
    LookupError,
    NotADirectoryError,
    RuntimeError,
    TypeError,
    ValueError,
    zlib.error,
)
"""Exceptions that a name that is none, or content that is no archive of a robot, raises; never a full disk."""

_log = logging.getLogger(__name__)


class RobotRepository:
    """The user's own robots; safe to use from any thread. Shipped ones are read-only."""

    def __init__(self, folder: Path, database: Database) -> None:
        """Use a folder for the copies of the robots, which the first one makes, and a database."""
        self._folder = folder
        self._database = database
        self._digests: dict[str, str] = {}
        self._left_out: dict[str, str] = {}
        self._lock = threading.RLock()

    def place(self, name: str) -> Path:
        """Return the folder of a robot of one's own, for a valid name; it need not exist.

        Raises:
            ReadOnlyRobotError: a shipped robot has this name.
        """
        if name in shipped_robots():
            raise ReadOnlyRobotError(name)
        return self._folder / name

    @contextmanager
    def beside(self) -> Iterator[Path]:
        """Yield an empty folder in which a robot may be unpacked; it is removed unless it is taken (see `take`)."""
        beside = self.new_folder()
        try:
            yield beside
        finally:
            shutil.rmtree(beside, ignore_errors=True)

    def new_folder(self) -> Path:
        """Return an empty folder in which a robot may be unpacked; what is left of it is removed by `recover`."""
        with storing("the robot could not be saved"):
            self._folder.mkdir(parents=True, exist_ok=True)
            return Path(tempfile.mkdtemp(dir=self._folder, prefix=_NEW))

    def discard(self, folder: Path) -> None:
        """Remove a folder that `new_folder` has made, with all that is in it."""
        if folder.parent == self._folder and folder.name.startswith(_NEW):
            shutil.rmtree(folder, ignore_errors=True)

    def take(self, name: str, unpacked: Path) -> bool:
        """Make an unpacked folder the robot's own, in place of any it has; return whether the robot is new.

        Raises:
            ReadOnlyRobotError: a shipped robot has this name.
            StorageError: it could not be saved; the earlier robot is unchanged.
        """
        place = self.place(name)
        with storing(f"robot {name!r} could not be saved"), self._lock:
            is_new = not (place / CARD).is_file()
            self._swap(name, unpacked, lambda: self._keep(name, place))
        return is_new

    def save(self, card: CardFile) -> bool:
        """Save or replace the card of a robot of one's own, and leave its files; return whether it is new.

        Raises:
            ReadOnlyRobotError: a shipped robot has this name.
            StorageError: it could not be saved; the earlier card is unchanged.
        """
        place = self.place(card.name)
        with storing(f"robot {card.name!r} could not be saved"), self._lock, self.beside() as beside:
            if place.exists():
                shutil.copytree(place, beside, dirs_exist_ok=True)
            write_at_once(beside / CARD, json.dumps(card.to_dict(), indent=1).encode())
            return self.take(card.name, beside)

    def remove(self, name: str) -> None:
        """Remove a robot of one's own with all its files.

        Raises:
            ReadOnlyRobotError: it is a shipped robot.
            UnknownRobotError: there is none.
            StorageError: it could not be removed.
        """
        place = self.place(name)
        with storing(f"robot {name!r} could not be removed"), self._lock:
            if not self._is_own(place) or not (place / CARD).is_file():
                raise UnknownRobotError(name)
            digest = digest_of(place)
            with self._database.writing(f"robot {name!r} could not be removed") as session:
                _put(session, name, digest, None)
            self._drop(name)

    def recover(self) -> None:
        """Finish what the end of a server has interrupted: a robot that was being replaced is as it was before."""
        with suppress(OSError):
            for path in self._folder.glob(f"{_BEFORE}*"):
                place = self._folder / path.name.removeprefix(_BEFORE)
                if not place.exists() and (path / CARD).is_file():
                    path.rename(place)
            for path in (*self._folder.glob(f"{_BEFORE}*"), *self._folder.glob(f"{_NEW}*")):
                shutil.rmtree(path, ignore_errors=True)

    def take_over(self) -> None:
        """Bring folders and database together when a server starts; do nothing where nothing can be written.

        Raises:
            StorageError: the system or the database refuses.
        """
        what = "the robots could not be taken over"
        with storing(what), self._lock:
            self._digests = {
                path.parent.name: digest_of(path.parent)
                for path in self._folder.glob(f"*/{CARD}")
                if not path.parent.name.startswith(".")
            }
            with self._database.reading(what) as session:
                rows = {name: (digest, is_there) for name, digest, is_there in session.execute(_ROWS)}
            if self._database.is_copy:
                return
            for name, digest in self._digests.items():
                known, is_there = rows.get(name, ("", False))
                if digest != known and not (self._database.is_shared and is_there):
                    self._keep(name, self._folder / name)
            self.refresh()

    def refresh(self) -> None:
        """Bring the folders up to date with the database; leave out a robot that it has no good archive of.

        Raises:
            StorageError: the system or the database refuses.
        """
        what = "the robots could not be brought up to date"
        with storing(what), self._lock:
            with self._database.reading(what) as session:
                rows = session.execute(_ROWS).all()
            for name, digest, is_there in rows:
                if is_there and digest not in (self._digests.get(name), self._left_out.get(name)):
                    self._fetch(name, digest)
                elif not is_there and self._digests.get(name) == digest:
                    self._drop(name)

    def _keep(self, name: str, folder: Path) -> None:
        """Save a folder as a robot in the database."""
        digest = digest_of(folder)
        with self._database.writing(f"robot {name!r} could not be saved") as session:
            _put(session, name, digest, packed(folder))
        self._digests[name] = digest

    def _fetch(self, name: str, digest: str) -> None:
        """Make the folder of a robot what the database has; where that is no robot, leave it as it is and log so."""
        try:
            with self._database.reading(f"robot {name!r} could not be read") as session:
                found = session.execute(select(RobotRow.digest, RobotRow.content).where(RobotRow.name == name)).first()
            if found is None or found.content is None:
                return
            if not self._is_own(self._folder / name):
                raise ValueError("this is no name of a robot")
            with self.beside() as beside:
                unpack(found.content, beside)
                self._swap(name, beside, lambda: None)
        except _BAD as error:
            self._left_out[name] = digest
            _log.error("robot %r in the database cannot be read and is left out: %s", name, error)
            return
        self._digests[name] = found.digest
        _log.info("robot %r is as in the database", name)

    def _is_own(self, place: Path) -> bool:
        """Return whether a place is a folder of a robot: right in the folder of all, not one that is in the making."""
        return place.parent == self._folder and not place.name.startswith(".")

    def _swap(self, name: str, unpacked: Path, and_then: Callable[[], None]) -> None:
        """Put a folder in the place of a robot's; if what follows raises an error, the earlier one is put back."""
        place, before = self._folder / name, self._folder / f"{_BEFORE}{name}"
        unpacked.chmod(0o755)
        sync_tree(unpacked)
        if place.exists():
            place.rename(before)
        try:
            unpacked.rename(place)
            and_then()
        except BaseException:
            shutil.rmtree(place, ignore_errors=True)
            with suppress(FileNotFoundError):
                before.rename(place)
            raise
        shutil.rmtree(before, ignore_errors=True)
        sync_folder(self._folder)

    def _drop(self, name: str) -> None:
        """Remove a robot's folder, its card first, so that an interruption leaves no half robot."""
        place, before = self._folder / name, self._folder / f"{_BEFORE}{name}"
        (place / CARD).unlink(missing_ok=True)
        place.rename(before)
        shutil.rmtree(before)
        self._digests.pop(name, None)


_ROWS = select(RobotRow.name, RobotRow.digest, RobotRow.content.is_not(None))


def _put(session: Session, name: str, digest: str, content: bytes | None) -> None:
    session.execute(delete(RobotRow).where(RobotRow.name == name))
    session.execute(insert(RobotRow).values(name=name, digest=digest, content=content))


_ZIP_LEVEL = 1
"""Compression level: meshes compress to about a half already, and a robot of 60 MB is packed within seconds."""


def files_of(folder: Path) -> list[Path]:
    """Return the files of a folder, in the order of their paths below it."""
    return sorted((path for path in folder.rglob("*") if path.is_file()), key=lambda path: path.relative_to(folder))


def digest_of(folder: Path) -> str:
    """Return a digest of the paths and the contents of a folder's files; raises `OSError`."""
    whole = hashlib.sha256()
    for path in files_of(folder):
        with path.open("rb") as file:
            content = hashlib.file_digest(file, "sha256").hexdigest()
        whole.update(f"{path.relative_to(folder).as_posix()}\0{content}\n".encode("utf-8", "surrogateescape"))
    return whole.hexdigest()


def packed(folder: Path) -> bytes:
    """Return an archive of a folder's files; raises `OSError`."""
    target = io.BytesIO()
    with ZipFile(target, "w", ZIP_DEFLATED, compresslevel=_ZIP_LEVEL) as archive:
        for path in files_of(folder):
            archive.writestr(ZipInfo(path.relative_to(folder).as_posix()), path.read_bytes(), ZIP_DEFLATED, _ZIP_LEVEL)
    return target.getvalue()


def unpack(content: bytes, folder: Path) -> None:
    """Unpack an archive that `packed` has made into an empty folder; raises `OSError`, or one of `_BAD`."""
    with ZipFile(io.BytesIO(content)) as archive:
        archive.getinfo(CARD)
        archive.extractall(folder)
    sync_tree(folder)


def sync_tree(folder: Path) -> None:
    """Write the entries of a folder, and of all folders below it, to the disk."""
    for path in (folder, *(one for one in folder.rglob("*") if one.is_dir())):
        sync_folder(path)
