"""The folder in which one server keeps its database, robots and studies.

Two servers on one folder would not see each other's changes, so a server locks its folder. The system releases the
lock when the process ends, however it ends. A file beside the lock says who holds it, for the error of a second server.
"""

import fcntl
import json
import logging
import os
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path

from app.store.database_error import try_writing
from app.store.durable_file import write_at_once
from app.store.storage_error import ForbiddenStorageError, storage_error
from planner.errors import FoldingError
from planner.robots.own_robots import ROBOTS

_log = logging.getLogger(__name__)


@dataclass
class UnusableFolderError(FoldingError):
    """The data folder is not a folder, or cannot be made."""

    folder: Path
    why: str

    def __str__(self) -> str:
        return f"the data folder {self.folder} cannot be used: {self.why}"


@dataclass
class HeldFolderError(FoldingError):
    """Another server uses the data folder."""

    folder: Path
    holder: str

    def __str__(self) -> str:
        return (
            f"the data folder {self.folder} is in use by {self.holder}. "
            "Stop that server, or give this one another folder with --data."
        )


@dataclass(frozen=True, slots=True)
class Holder:
    """The server that uses a folder.

    Attributes:
        pid: its process id.
        host: its machine.
        since: its start, UTC, as in RFC 3339.
        url: its URL; None until it answers requests.
    """

    pid: int
    host: str
    since: str
    url: str | None

    def __str__(self) -> str:
        where = f" at {self.url}" if self.url else ""
        return f"the server{where}, process {self.pid} on {self.host}, since {self.since}"


class DataFolder:
    """The folder of a server.

    Attributes:
        path: the folder.
        robots: the folder of robots.
        database: the file of the database.
        token: the file of the token's hash.
        studies: the folder of studies.
    """

    def __init__(self, path: Path) -> None:
        """Describe the folder without touching the disk."""
        self.path = path
        self.robots = path / ROBOTS
        self.database = path / "pleat.db"
        self.token = path / "token.json"
        self.studies = path / "studies"
        self._holder = path / "server.json"

    @contextmanager
    def held(self) -> Iterator[Callable[[str], None]]:
        """Hold the folder's lock; yield the function to call with the server's URL.

        A read-only folder is used without a lock.

        Raises:
            UnusableFolderError: it is not a folder, or cannot be made.
            HeldFolderError: another server uses it.
        """
        self._make()
        try:
            lock = _locked(self.path / "server.lock")
        except BlockingIOError:
            raise HeldFolderError(self.path, self._known_holder()) from None
        except OSError as error:
            if not self._is_read_only(error):
                raise UnusableFolderError(self.path, f"it cannot be locked: {error.strerror}") from None
            _log.warning("the data folder %s is read-only: nothing can be saved", self.path)
            yield lambda _: None
            return
        since = datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")

        def announce(url: str | None) -> None:
            holder = Holder(os.getpid(), socket.gethostname(), since, url)
            with suppress(OSError):  # the lock works without it
                write_at_once(self._holder, json.dumps(asdict(holder)).encode(), is_synced=False)

        announce(None)
        try:
            yield announce
        finally:
            with suppress(OSError):
                self._holder.unlink()
            os.close(lock)

    def problem(self) -> str | None:
        """Return why nothing can be saved here now; None if saving works."""
        for folder in (self.path, self.robots):
            try:
                self._try_writing(folder)
            except OSError as error:
                name = "" if folder == self.path else f"'s {folder.name}"
                return str(storage_error(f"the data folder{name} cannot be written", error))
        return None

    def _try_writing(self, folder: Path) -> None:
        if folder != self.path and not folder.exists():
            return  # saving the first of its kind makes it
        try_writing(folder)

    def _make(self) -> None:
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except FileExistsError:
            raise UnusableFolderError(self.path, "it is a file") from None
        except OSError as error:
            raise UnusableFolderError(self.path, f"it cannot be made: {error.strerror}") from None
        if self.robots.is_file():
            raise UnusableFolderError(self.path, f"{self.robots.name!r} in it is a file")

    def _is_read_only(self, error: OSError) -> bool:
        if not isinstance(storage_error("", error), ForbiddenStorageError):
            return False
        return not any(os.access(folder, os.W_OK) for folder in (self.path, self.robots))

    def _known_holder(self) -> str:
        try:
            return str(Holder(**json.loads(self._holder.read_text(encoding="utf-8"))))
        except (OSError, ValueError, TypeError):
            return "another server"


def _locked(path: Path) -> int:
    """Lock a file until its descriptor, which is returned, is closed; raise `BlockingIOError` if another has it."""
    lock = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(lock)
        raise
    return lock
