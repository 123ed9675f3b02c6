"""The document repository: the documents in the database. One that cannot be read is told; the others still open."""

import re
import secrets
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

from sqlalchemy import CursorResult, delete, func, select, update

from app.drawing.draft import Draft
from app.store.database import Database
from app.store.document_errors import UnknownDocumentError
from app.store.document_keeper import FORMAT, DocumentKeeper
from app.store.document_list import DocumentPage, read_page
from app.store.document_reader import KeptVersion, read_document, read_versions
from app.store.schema import DocumentRow
from app.store.storage_error import StorageError
from planner.task.world_state import WorldState

ID_PATTERN = re.compile(r"[a-z0-9]{8}")

_LETTERS = "23456789abcdefghjkmnpqrstuvwxyz"
"""Characters of ids, without those that look alike (0, 1, i, l, o)."""


@dataclass(frozen=True, slots=True)
class KeptDocument:
    """A document as saved; a gesture in progress counts as a step.

    Attributes:
        version: its version.
        draft: its drawing and history.
        keeper: saves its further changes.
        start: the world state from which it is planned; None for the drawing's own.
    """

    version: int
    draft: Draft
    keeper: DocumentKeeper
    start: WorldState | None = None


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
        with self._database.reading(f"document {document_id!r} could not be read") as session:
            found = read_document(session, document_id)
        keeper = DocumentKeeper(self._database, document_id, found.kept)
        return KeptDocument(found.version, found.draft, keeper, found.start)

    def reread(self, keeper: DocumentKeeper) -> KeptDocument:
        """Return a document as another server has left it; its keeper goes on from there. Raise as `kept` does."""
        with self._database.reading(f"document {keeper.id!r} could not be read") as session:
            found = read_document(session, keeper.id)
        keeper.kept = found.kept
        return KeptDocument(found.version, found.draft, keeper, found.start)

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
