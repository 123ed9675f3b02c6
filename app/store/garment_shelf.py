"""The garments that can be asked for by name: the shipped ones, and one's own in a folder."""

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
class ShelfEntry:
    """A garment as the list shows it."""

    name: str
    title: str
    shipped: bool


class GarmentShelf:
    """Garments by name. Shipped ones come first and cannot be changed."""

    def __init__(self, folder: Path) -> None:
        """One's own garments are in this folder, which is made when the first is saved."""
        self._folder = folder

    def entries(self) -> list[ShelfEntry]:
        """All garments, the shipped ones first; own files that are no garment are left out."""
        shipped = [ShelfEntry(name, load_garment(name).title, True) for name in shipped_garment_names()]
        return shipped + [ShelfEntry(own.name, own.title, False) for own in self._own()]

    def garment(self, name: str) -> Garment:
        """The garment of this name.

        Raises:
            UnknownGarmentError: there is none.
            GarmentFileError: it is one's own and its file cannot be read, or is not valid.
        """
        if name in shipped_garment_names():
            return load_garment(name)
        path = self._path(name)
        if not path.is_file():
            raise UnknownGarmentError(name)
        return _read(path)

    def save(self, garment: Garment) -> bool:
        """Save or replace one's own garment; whether it is new. It is on the disk when this returns.

        Raises:
            ReadOnlyGarmentError: a shipped one has this name.
            StorageError: it could not be written; what was there before still is.
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
        """Remove one's own garment.

        Raises:
            ReadOnlyGarmentError: it is a shipped one.
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
        """Where one's own garment is; a name that is no name (or a path) is unknown, never looked up."""
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
