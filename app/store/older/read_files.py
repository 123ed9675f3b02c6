"""Reads a document from its files, of the formats before the database."""

from dataclasses import dataclass
from pathlib import Path

from app.drawing.drawing import Drawing
from app.drawing.drawing_json import drawing_to_dict
from app.drawing.solve import solve
from app.store.document_errors import NewerDocumentError
from app.store.document_reader import in_short
from app.store.older import document_file
from app.store.older.document_file import DocumentModel
from app.store.older.document_files import (
    BROKEN,
    JSON,
    PREVIEW,
    START,
    DocumentFiles,
    Preview,
    Start,
    format_of,
    require_known_format,
)
from app.store.older.journal import Journal, read_journal
from app.store.tape import Tape, tape_of
from planner.task.world_state import WorldState


@dataclass(frozen=True, slots=True)
class OlderDocument:
    """A document as its files hold it.

    Attributes:
        version: its version.
        changed_at: the time of its last change, UTC, as in RFC 3339.
        tape: its drawings.
        times: when each of them was committed, as `changed_at`; empty where that is not known.
        preview: the drawing that a gesture in progress had led to; None without one.
        start: the world state from which the drawing is planned; None for its own.
    """

    version: int
    changed_at: str
    tape: Tape[Drawing]
    times: tuple[str, ...]
    preview: Preview | None
    start: WorldState | None


@dataclass(frozen=True, slots=True)
class UnreadableFile:
    """A document whose file cannot be read.

    Attributes:
        why: what is wrong with it.
        format: its format if it is a newer one, otherwise 0.
    """

    why: str
    format: int = 0


def read_files(files: DocumentFiles) -> OlderDocument | UnreadableFile:
    """Return what a document's files hold."""
    path = files.document or files.path(BROKEN)
    try:
        content = _content(files, path)
        if isinstance(content, DocumentModel):
            tape = tape_of(content.drawing.value(), content.history())
            times: tuple[str, ...] = ("",) * len(tape.sheets)
        else:
            tape, times = content.tape(), content.times
        for sheet in tape.sheets:
            solve(sheet.drawing)
    except NewerDocumentError as error:
        return UnreadableFile(str(error), error.format)
    except ValueError as error:
        return UnreadableFile(in_short(error))
    preview = _preview(files, content.version)
    shown = tape.sheets[tape.now].drawing if preview is None else solve(preview.drawing.value()).drawing
    return OlderDocument(content.version, content.changed_at, tape, times, preview, _start(files, shown))


def _content(files: DocumentFiles, path: Path) -> DocumentModel | Journal:
    """Return the content of a file.

    Raises:
        NewerDocumentError: a newer version of Pleat wrote it.
        ValueError: it is damaged.
    """
    data = path.read_bytes()
    require_known_format(files.id, path, data)
    if path.suffix == JSON or (path.suffix == BROKEN and format_of(data) == document_file.FORMAT):
        return DocumentModel.model_validate_json(data)
    journal, head = read_journal(data), files.head()
    if head is not None and head.generation == journal.generation and head.bytes > journal.whole_bytes:
        raise ValueError(f"it is cut off: of {head.bytes} bytes {journal.whole_bytes} are there")
    return journal


def _preview(files: DocumentFiles, version: int) -> Preview | None:
    """Return the gesture that was in progress when the server ended, if its file is valid."""
    try:
        preview = Preview.model_validate_json(files.path(PREVIEW).read_bytes())
        solve(preview.drawing.value())
    except (OSError, ValueError):
        return None
    return preview if preview.version > version else None


def _start(files: DocumentFiles, drawing: Drawing) -> WorldState | None:
    """Return the world state from which a drawing is planned, if one was chosen for it and can be read."""
    try:
        kept = Start.model_validate_json(files.path(START).read_bytes())
        return kept.start if drawing_to_dict(kept.drawing.value()) == drawing_to_dict(drawing) else None
    except (OSError, ValueError):
        return None
