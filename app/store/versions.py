"""The versions of a document: the drawings that its journal holds, with the steps that led to them and their times."""

from dataclasses import dataclass
from typing import Any

from app.store.document_files import JOURNAL, DocumentFiles, UnknownDocumentError
from app.store.journal import read_journal


@dataclass(frozen=True, slots=True)
class KeptVersion:
    """A drawing that a document can go back to.

    Attributes:
        label: the step that led to it, in words; empty for the first.
        changed_at: when, UTC, as in RFC 3339; empty where that is not known any more.
        drawing: the drawing as JSON.
    """

    label: str
    changed_at: str
    drawing: dict[str, Any]


def read_versions(files: DocumentFiles) -> tuple[KeptVersion, ...]:
    """Return the versions of a document before its current one, the latest first; none of an older format.

    Raises:
        UnknownDocumentError: there is no such document.
        ValueError: its journal is damaged.
        OSError: the system refuses to read it.
    """
    if files.document is None:
        raise UnknownDocumentError(files.id)
    if not files.path(JOURNAL).exists():
        return ()
    journal = read_journal(files.path(JOURNAL).read_bytes())
    sheets, now = journal.raw_tape
    past = zip(sheets[:now], journal.times, strict=False)
    return tuple(KeptVersion(sheet.label, time, sheet.drawing) for sheet, time in reversed(tuple(past)))
