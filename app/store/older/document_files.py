"""The files of one document as versions before the database kept them.

======== ==========================================================================
ending   content
======== ==========================================================================
.journal the document (see `app.store.older.journal`)
.head    the journal's list entry and least length
.preview the drawing changed by a gesture in progress
.start   the world state from which the drawing is planned, if not from the beginning
.json    a document of format 1 (see `app.store.older.document_file`); a journal supersedes it
.broken  an unreadable file, renamed
======== ==========================================================================
"""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from pydantic import Field
from pydantic_core import from_json

from app.drawing.drawing_json import DrawingModel
from app.store.document_errors import NewerDocumentError
from app.store.older import document_file, journal
from planner.strict_model import StrictModel
from planner.task.world_state import WorldState

JOURNAL, HEAD, PREVIEW, START, JSON, BROKEN = ".journal", ".head", ".preview", ".start", ".json", ".broken"
ID_PATTERN = re.compile(r"[a-z0-9]{8}")

_FORMAT_AT_START = re.compile(rb'\s*\{\s*"format"\s*:\s*(\d{1,9})\b')


class Head(StrictModel):
    """The list entry of a journal, and the journal's length when it was written (bytes)."""

    id: str
    generation: Annotated[int, Field(ge=0)]
    bytes: Annotated[int, Field(ge=0)]
    title: str
    name: str
    changed_at: str


class Preview(StrictModel):
    """A gesture in progress."""

    version: Annotated[int, Field(ge=1)]
    label: str
    drawing: DrawingModel


class Start(StrictModel):
    """A world state from which to plan, and the drawing for which it was chosen."""

    drawing: DrawingModel
    start: WorldState


@dataclass(frozen=True, slots=True)
class DocumentFiles:
    """The paths of a document's files.

    Attributes:
        id: the document's id.
        folder: the folder of all documents.
    """

    id: str
    folder: Path

    def path(self, suffix: str) -> Path:
        """Return the path of the file with this ending."""
        return self.folder / (self.id + suffix)

    @property
    def document(self) -> Path | None:
        """The file that holds the document; None if there is none to open."""
        return next((path for path in map(self.path, (JOURNAL, JSON)) if path.exists()), None)

    def head(self) -> Head | None:
        """Return the journal's head; None if it cannot be read, since the journal can replace it."""
        try:
            return Head.model_validate_json(self.path(HEAD).read_bytes())
        except (OSError, ValueError):
            return None


def require_known_format(document_id: str, path: Path, data: bytes) -> None:
    """Raise `NewerDocumentError` if a file has a newer format."""
    known = document_file.FORMAT if path.suffix == JSON else journal.FORMAT
    found = format_of(data)
    if found is not None and found > known:
        raise NewerDocumentError(document_id, found)


def format_of(data: bytes) -> int | None:
    """Return the format number in a file, or None."""
    if at_start := _FORMAT_AT_START.match(data):
        return int(at_start[1])
    try:
        content = from_json(data)
    except ValueError:
        return None
    found = content.get("format") if isinstance(content, dict) else None
    return found if isinstance(found, int) else None
