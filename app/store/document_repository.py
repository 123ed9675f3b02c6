"""The document repository: the documents in the database. One that cannot be read is reported; the others open."""

import re
import secrets
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

from pydantic_core import from_json
from sqlalchemy import CursorResult, and_, delete, func, select, tuple_, update
from sqlalchemy.orm import Session

from app.store.database import Database
from app.store.document_errors import BrokenDocumentError, NewerDocumentError, UnknownDocumentError
from app.store.document_keeper import FORMAT, DocumentKeeper
from app.store.document_reader import DAMAGES, KeptDocument, KeptVersion, in_short, read_document, read_versions
from app.store.picture import Picture
from app.store.schema import DocumentRow, StepRow
from app.store.storage_error import StorageError
from planner.json_form import STRICT


@dataclass(frozen=True, slots=True)
class DocumentEntry:
    """A document as listed.

    Attributes:
        id: its id.
        title: the garment's title; empty if the document cannot be read.
        name: the garment's name; empty if the document cannot be read.
        changed_at: the time of the last change, UTC, as in RFC 3339; empty if it is not known.
        problem: why it cannot be opened, or None.
        picture: what it looks like; None where it cannot be read.
    """

    __pydantic_config__ = STRICT

    id: str
    title: str = ""
    name: str = ""
    changed_at: str = ""
    problem: str | None = None
    picture: Picture | None = None


@dataclass(frozen=True, slots=True)
class DocumentPage:
    """A page of the list.

    Attributes:
        entries: the documents.
        end: the place of the last of them; None on the last page.
    """

    entries: tuple[DocumentEntry, ...]
    end: tuple[str, str] | None


def read_page(session: Session, after: tuple[str, str] | None, count: int) -> DocumentPage:
    """Return the documents after a place, the latest changed first, those that were never readable last."""
    is_current = and_(StepRow.document_id == DocumentRow.id, StepRow.number == DocumentRow.now)
    wanted = select(DocumentRow, StepRow.drawing).outerjoin(StepRow, is_current)
    if after is not None:
        wanted = wanted.where(tuple_(DocumentRow.changed_at, DocumentRow.id) < after)
    order = DocumentRow.changed_at.desc(), DocumentRow.id.desc()
    rows = session.execute(wanted.order_by(*order).limit(count + 1)).all()
    entries = tuple(_entry(row, drawing) for row, drawing in rows[:count])
    last = rows[:count][-1][0] if len(rows) > count else None
    return DocumentPage(entries, None if last is None else (last.changed_at, last.id))


def _entry(row: DocumentRow, drawing: str | None) -> DocumentEntry:
    """Return the list entry of a row; an error in reading it becomes the problem of this entry alone."""
    texts: tuple[object, ...] = (row.title, row.name, row.changed_at)  # whatever the database holds
    changed_at = row.changed_at if isinstance(texts[-1], str) else ""
    try:
        if row.format > FORMAT or (row.problem is not None and row.format):
            return DocumentEntry(row.id, changed_at=changed_at, problem=str(NewerDocumentError(row.id, row.format)))
        if row.problem is not None or drawing is None:
            raise ValueError(row.problem or "its drawing is missing")
        if not all(isinstance(text, str) for text in texts):
            raise ValueError("its row is damaged")
        picture = Picture.of(from_json(drawing))
    except DAMAGES as error:
        problem = str(BrokenDocumentError(row.id, in_short(error)))
        return DocumentEntry(row.id, changed_at=changed_at, problem=problem)
    return DocumentEntry(row.id, row.title, row.name, changed_at, picture=picture)


ID_PATTERN = re.compile(r"[a-z0-9]{8}")

_LETTERS = "23456789abcdefghjkmnpqrstuvwxyz"
"""Characters of ids, without those that look alike (0, 1, i, l, o)."""


class DocumentRepository:
    """A repository of documents."""

    def __init__(self, database: Database) -> None:
        """Use a database; read nothing yet."""
        self._database = database

    def page(self, after: tuple[str, str] | None, count: int) -> DocumentPage:
        """Return a page of the list, the latest changed documents first, unreadable ones last."""
        with self._database.reading("the documents could not be listed") as session:
            return read_page(session, after, count)

    def new_id(self) -> str:
        """Return an unused id."""
        with self._database.reading("the documents could not be read") as session:
            while True:
                document_id = "".join(secrets.choice(_LETTERS) for _ in range(8))
                if session.get(DocumentRow, document_id) is None:
                    return document_id

    def keeper(self, document_id: str) -> DocumentKeeper:
        """Return the keeper of a new document."""
        return DocumentKeeper(self._database, document_id)

    def kept(self, document_id: str) -> KeptDocument:
        """Return a document as saved.

        Raises:
            UnknownDocumentError: there is none.
            NewerDocumentError: a newer version of Pleat wrote it.
            BrokenDocumentError: it cannot be read.
            StorageError: the database refuses.
        """
        require_id(document_id)
        return self.reread(self.keeper(document_id))

    def reread(self, keeper: DocumentKeeper) -> KeptDocument:
        """Return a document as another server has left it; its keeper goes on from there. Raise as `kept` does."""
        with self._database.reading(f"document {keeper.id!r} could not be read") as session:
            return read_document(session, keeper)

    def versions(self, document_id: str) -> tuple[KeptVersion, ...]:
        """Return the drawings that a document can go back to, the latest first; raise as `kept` does."""
        require_id(document_id)
        with self._database.reading(f"document {document_id!r} could not be read") as session:
            return read_versions(session, document_id)

    def remove(self, document_id: str) -> None:
        """Remove a document.

        Raises:
            UnknownDocumentError: there is none.
            StorageError: it could not be removed, and is still there.
        """
        require_id(document_id)
        with self._database.writing(f"document {document_id!r} could not be removed") as session:
            removed = session.execute(delete(DocumentRow).where(DocumentRow.id == document_id))
            assert isinstance(removed, CursorResult)
            if removed.rowcount == 0:
                raise UnknownDocumentError(document_id)

    def recent(self) -> Iterator[str]:
        """Yield the ids of readable documents: the last opened one, then the others, latest changed first.

        Judged by their rows; opening one may still fail.
        """
        is_readable = DocumentRow.problem.is_(None), DocumentRow.format <= FORMAT
        with self._database.reading("the documents could not be listed") as session:
            opened = select(func.max(DocumentRow.opened_s)).where(*is_readable).scalar_subquery()
            is_last = func.coalesce(DocumentRow.opened_s == opened, False)
            order = is_last.desc(), DocumentRow.changed_at.desc(), DocumentRow.id.desc()
            found = session.scalars(select(DocumentRow.id).where(*is_readable).order_by(*order)).all()
        yield from found

    def remember_last(self, document_id: str) -> None:
        """Save which document was opened last; ignore a failure."""
        opened = update(DocumentRow).where(DocumentRow.id == document_id).values(opened_s=time.time())
        with suppress(StorageError), self._database.writing("it is not remembered", is_synced=False) as session:
            session.execute(opened)


def require_id(document_id: str) -> None:
    """Raise `UnknownDocumentError` for what cannot be an id: PostgreSQL knows no zero byte."""
    if not ID_PATTERN.fullmatch(document_id):
        raise UnknownDocumentError(document_id)
