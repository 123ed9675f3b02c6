"""The garment repository: shipped garments, and the user's own in the database."""

import json
from dataclasses import dataclass

from sqlalchemy import CursorResult, delete, insert, select, update

from app.store.database import Database
from app.store.schema import GarmentRow
from planner.cloth.garment import NAME_PATTERN, Garment
from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.errors import FieldError, GarmentFileError, ReadOnlyGarmentError, UnknownGarmentError


@dataclass(frozen=True, slots=True)
class GarmentEntry:
    """A garment as listed."""

    name: str
    title: str
    shipped: bool


class GarmentRepository:
    """A repository of garments by name. Shipped garments come first and are read-only."""

    def __init__(self, database: Database) -> None:
        """Use a database; read nothing yet."""
        self._database = database

    def entries(self) -> list[GarmentEntry]:
        """Return all garments, shipped ones first; skip those that are not valid."""
        shipped = [GarmentEntry(name, load_garment(name).title, True) for name in shipped_garment_names()]
        with self._database.reading("the garments could not be listed") as session:
            rows = session.execute(select(GarmentRow.name, GarmentRow.content).order_by(GarmentRow.name)).all()
        own = []
        for name, content in rows:
            try:
                own.append(GarmentEntry(name, read_garment(name, content).title, False))
            except GarmentFileError:
                continue
        return shipped + own

    def garment(self, name: str) -> Garment:
        """Return the garment with a name.

        Raises:
            UnknownGarmentError: there is none.
            GarmentFileError: what is stored is no valid garment.
        """
        if name in shipped_garment_names():
            return load_garment(name)
        _require_name(name)
        with self._database.reading(f"garment {name!r} could not be read") as session:
            content = session.scalar(select(GarmentRow.content).where(GarmentRow.name == name))
        if content is None:
            raise UnknownGarmentError(name)
        return read_garment(name, content)

    def save(self, garment: Garment) -> bool:
        """Save or replace a garment of the user's own; return whether it is new.

        Raises:
            ReadOnlyGarmentError: a shipped garment has this name.
            StorageError: it could not be saved; the earlier one is unchanged.
        """
        if garment.name in shipped_garment_names():
            raise ReadOnlyGarmentError(garment.name)
        content = json.dumps(garment.to_dict())
        with self._database.writing(f"garment {garment.name!r} could not be saved") as session:
            changed = update(GarmentRow).where(GarmentRow.name == garment.name).values(content=content)
            result = session.execute(changed)
            assert isinstance(result, CursorResult)
            is_new = result.rowcount == 0
            if is_new:
                session.execute(insert(GarmentRow).values(name=garment.name, content=content))
        return is_new

    def remove(self, name: str) -> None:
        """Remove a garment of the user's own.

        Raises:
            ReadOnlyGarmentError: it is a shipped garment.
            UnknownGarmentError: there is none.
            StorageError: it could not be removed.
        """
        if name in shipped_garment_names():
            raise ReadOnlyGarmentError(name)
        _require_name(name)
        with self._database.writing(f"garment {name!r} could not be removed") as session:
            removed = session.execute(delete(GarmentRow).where(GarmentRow.name == name))
            assert isinstance(removed, CursorResult)
            if removed.rowcount == 0:
                raise UnknownGarmentError(name)


def read_garment(name: str, content: str) -> Garment:
    """Return the garment in a JSON text; raise `GarmentFileError` if there is none of this name."""
    try:
        garment = Garment.from_dict(json.loads(content))
    except (ValueError, RecursionError, FieldError) as error:
        raise GarmentFileError(f"garment {name!r}: {error}") from error
    if garment.name != name:
        raise GarmentFileError(f"garment {name!r}: its own name is {garment.name!r}")
    return garment


def _require_name(name: str) -> None:
    if not NAME_PATTERN.fullmatch(name):
        raise UnknownGarmentError(name)
