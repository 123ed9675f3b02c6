"""The garment repository: shipped garments, and the user's own in a folder."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from app.store.durable_file import write_at_once
from app.store.storage_error import storing
from planner.cloth.garment import NAME_PATTERN, Garment
from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.errors import FieldError, GarmentFileError, ReadOnlyGarmentError, UnknownGarmentError


@dataclass(frozen=True, slots=True)
class ListedGarment:
    """A garment as listed."""

    name: str
    title: str
    shipped: bool


class GarmentRepository:
    """A repository of garments by name. Shipped garments come first and are read-only."""

    def __init__(self, folder: Path) -> None:
        """Use a folder for the user's garments; saving the first one makes it."""
        self._folder = folder

    def entries(self) -> list[ListedGarment]:
        """Return all garments, shipped ones first; skip files that are not valid garments."""
        shipped = [ListedGarment(name, load_garment(name).title, True) for name in shipped_garment_names()]
        return shipped + [ListedGarment(own.name, own.title, False) for own in self._own()]

    def garment(self, name: str) -> Garment:
        """Return the garment with a name.

        Raises:
            UnknownGarmentError: there is none.
            GarmentFileError: its file in the user's folder cannot be read, or is invalid.
        """
        if name in shipped_garment_names():
            return load_garment(name)
        path = self._path(name)
        if not path.is_file():
            raise UnknownGarmentError(name)
        return _read(path)

    def save(self, garment: Garment) -> bool:
        """Save or replace a garment in the user's folder, synced to the disk; return whether it is new.

        Raises:
            ReadOnlyGarmentError: a shipped garment has this name.
            StorageError: it could not be written; the earlier file is unchanged.
        """
        if garment.name in shipped_garment_names():
            raise ReadOnlyGarmentError(garment.name)
        path = self._path(garment.name)
        with storing(f"garment {garment.name!r} could not be saved"):
            is_new = not path.exists()
            self._folder.mkdir(parents=True, exist_ok=True)
            write_at_once(path, json.dumps(garment.to_dict(), indent=1).encode())
        return is_new

    def remove(self, name: str) -> None:
        """Remove a garment from the user's folder.

        Raises:
            ReadOnlyGarmentError: it is a shipped garment.
            UnknownGarmentError: there is none.
            StorageError: it could not be removed.
        """
        if name in shipped_garment_names():
            raise ReadOnlyGarmentError(name)
        path = self._path(name)
        with storing(f"garment {name!r} could not be removed"):
            try:
                path.unlink()
            except FileNotFoundError:
                raise UnknownGarmentError(name) from None

    def _own(self) -> Iterator[Garment]:
        for path in sorted(self._folder.glob("*.json")):
            try:
                own = self.garment(path.stem)
            except (GarmentFileError, UnknownGarmentError):
                continue
            if own.name == path.stem and own.name not in shipped_garment_names():
                yield own

    def _path(self, name: str) -> Path:
        """Return the path of a user's garment; raise `UnknownGarmentError` for an invalid name, such as a path."""
        if not NAME_PATTERN.fullmatch(name):
            raise UnknownGarmentError(name)
        return self._folder / f"{name}.json"


def _read(path: Path) -> Garment:
    try:
        return Garment.from_dict(json.loads(path.read_text(encoding="utf-8")))
    except OSError as error:
        raise GarmentFileError(f"{path.name}: {error.strerror}") from error
    except (ValueError, RecursionError, FieldError) as error:
        raise GarmentFileError(f"{path.name}: {error}") from error
