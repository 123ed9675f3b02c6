"""The repository of robots: shipped ones, and the user's own, each in a folder with its card and its files."""

import json
import shutil
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from app.store.durable_file import sync_folder, write_at_once
from app.store.storage_error import storing
from planner.errors import ReadOnlyRobotError, UnknownRobotError
from planner.robots.card_file import CardFile
from planner.robots.described_robot import shipped_robots
from planner.robots.own_robots import CARD

_BEFORE, _NEW = ".before-", ".new-"
"""Prefixes of the folders of robots that are being replaced, and of new ones."""


class RobotRepository:
    """The user's own robots. Shipped ones are read-only."""

    def __init__(self, folder: Path) -> None:
        """Use a folder for the user's robots; saving the first one makes it."""
        self._folder = folder
        self._lock = threading.Lock()

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
        with storing("the robot could not be saved"):
            self._folder.mkdir(parents=True, exist_ok=True)
            beside = Path(tempfile.mkdtemp(dir=self._folder, prefix=_NEW))
        try:
            yield beside
        finally:
            shutil.rmtree(beside, ignore_errors=True)

    def take(self, name: str, unpacked: Path) -> bool:
        """Make an unpacked folder a robot's, instead of the one it may have had; return whether it is new.

        Raises:
            ReadOnlyRobotError: a shipped robot has this name.
            StorageError: it could not be saved; the earlier robot is unchanged.
        """
        place, before = self.place(name), self._folder / f"{_BEFORE}{name}"
        with storing(f"robot {name!r} could not be saved"), self._lock:
            unpacked.chmod(0o755)
            for path in (unpacked, *(one for one in unpacked.rglob("*") if one.is_dir())):
                sync_folder(path)
            is_new = not (place / CARD).is_file()
            if place.exists():
                place.rename(before)
            try:
                unpacked.rename(place)
            except OSError:
                with suppress(FileNotFoundError):
                    before.rename(place)
                raise
            shutil.rmtree(before, ignore_errors=True)
            sync_folder(self._folder)
        return is_new

    def save(self, card: CardFile) -> bool:
        """Save or replace the card of a robot of one's own, and leave its files; return whether it is new.

        Raises:
            ReadOnlyRobotError: a shipped robot has this name.
            StorageError: it could not be saved; the earlier card is unchanged.
        """
        place = self.place(card.name)
        with storing(f"robot {card.name!r} could not be saved"), self._lock:
            is_new = not (place / CARD).exists()
            place.mkdir(parents=True, exist_ok=True)
            write_at_once(place / CARD, json.dumps(card.to_dict(), indent=1).encode())
        return is_new

    def remove(self, name: str) -> None:
        """Remove a robot of one's own with all its files.

        Raises:
            ReadOnlyRobotError: it is a shipped robot.
            UnknownRobotError: there is none.
            StorageError: it could not be removed.
        """
        place = self.place(name)
        with storing(f"robot {name!r} could not be removed"), self._lock:
            if place.parent != self._folder or name.startswith(".") or not (place / CARD).is_file():
                raise UnknownRobotError(name)
            before = self._folder / f"{_BEFORE}{name}"
            # Its card goes first: interrupted between the two, the rest is no robot, and is removed by `recover`.
            (place / CARD).unlink()
            place.rename(before)
            shutil.rmtree(before)

    def recover(self) -> None:
        """Finish what the end of a server has interrupted: a robot that was being replaced is as it was before."""
        with suppress(OSError):
            for path in self._folder.glob(f"{_BEFORE}*"):
                place = self._folder / path.name.removeprefix(_BEFORE)
                if not place.exists() and (path / CARD).is_file():
                    path.rename(place)
            for path in (*self._folder.glob(f"{_BEFORE}*"), *self._folder.glob(f"{_NEW}*")):
                shutil.rmtree(path, ignore_errors=True)
