"""Lists the documents in the database, page by page."""

from dataclasses import dataclass

from pydantic_core import from_json
from sqlalchemy import and_, select, tuple_
from sqlalchemy.orm import Session

from app.store.document_errors import BrokenDocumentError, NewerDocumentError
from app.store.document_keeper import FORMAT
from app.store.document_reader import DAMAGES, in_short
from app.store.picture import Picture
from app.store.schema import DocumentRow, StepRow


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
    """Return what is listed of a row; whatever is wrong with it is its problem and no other document's."""
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
