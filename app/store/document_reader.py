"""Reads documents, from journals and from files of the older format."""

from dataclasses import dataclass, replace
from pathlib import Path

from pydantic import ValidationError

from app.drawing.draft import Draft
from app.drawing.drawing import Drawing
from app.drawing.solve import solve
from app.store import document_file
from app.store.document_file import DocumentModel
from app.store.document_files import (
    BROKEN,
    JOURNAL,
    JSON,
    PREVIEW,
    START,
    DocumentFiles,
    NewerDocumentError,
    Preview,
    Start,
    UnknownDocumentError,
    format_of,
    require_known_format,
)
from app.store.document_keeper import DocumentKeeper
from app.store.document_list import DocumentEntry
from app.store.journal import Journal, read_journal
from app.store.picture import Picture
from app.store.tape import Tape, history_of, tape_of
from planner.errors import FoldingError, RequestError
from planner.strict_model import first_error
from planner.task.world_state import WorldState


@dataclass
class BrokenDocumentError(FoldingError):
    """A document's file cannot be read."""

    document_id: str
    why: str
    kept_as: str

    def __str__(self) -> str:
        return f"the file of document {self.document_id!r} cannot be read and is kept as {self.kept_as!r}: {self.why}"


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


def read_document(files: DocumentFiles) -> KeptDocument:
    """Return a document as saved.

    Raises:
        UnknownDocumentError: there is none.
        NewerDocumentError: a newer version of Pleat wrote it.
        BrokenDocumentError: its file is damaged, and has been renamed if possible.
        OSError: the system refuses to read it.
    """
    path = files.document
    if path is None:
        raise _missing(files)
    try:
        resumed = _resumed(files, _kept(files, path))
        return replace(resumed, start=_start(files, resumed.draft.drawing))
    except ValueError as error:
        raise BrokenDocumentError(files.id, _in_short(error), _put_aside(files, path)) from None


def glance_at(files: DocumentFiles) -> DocumentEntry:
    """Return the list entry of a document as quickly as possible, from its head if that is current."""
    head = files.head()
    try:
        if head is not None and head.bytes == files.path(JOURNAL).stat().st_size:
            return DocumentEntry(files.id, head.title, head.name, head.changed_at)
    except OSError:
        pass  # without a journal it may have the older format
    return read_entry(files)


def read_entry(files: DocumentFiles) -> DocumentEntry:
    """Return the list entry of a document after reading all of it, with a problem if that fails."""
    path = files.document
    try:
        if path is None:
            raise _missing(files)
        content = _content(files, path)
    except FoldingError as error:
        return DocumentEntry(files.id, problem=str(error))
    except (ValueError, OSError) as error:
        return DocumentEntry(files.id, problem=_in_short(error))
    if isinstance(content, DocumentModel):
        shown = Picture.of(content.drawing.model_dump())
        return DocumentEntry(files.id, content.title, content.name, content.changed_at, picture=shown)
    drawing = content.raw_drawing
    title, name = (str(drawing.get(field, "")) for field in ("title", "name"))
    return DocumentEntry(files.id, title, name, content.changed_at, picture=Picture.of(drawing))


def _kept(files: DocumentFiles, path: Path) -> KeptDocument:
    content = _content(files, path)
    tape = _tape(content)
    if isinstance(content, DocumentModel):
        keeper = DocumentKeeper.of_older(files, content.version, tape)
    else:
        keeper = DocumentKeeper.of_journal(files, content, tape)
    drawing, history = history_of(tape)
    return KeptDocument(content.version, Draft(solve(drawing), history), keeper)


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


def _tape(content: DocumentModel | Journal) -> Tape[Drawing]:
    if isinstance(content, Journal):
        return content.tape()
    return tape_of(content.drawing.value(), content.history())


def _resumed(files: DocumentFiles, kept: KeptDocument) -> KeptDocument:
    """Return the document with the gesture in progress when the server ended, if its preview file is valid."""
    version, draft, keeper = kept.version, kept.draft, kept.keeper
    try:
        preview = Preview.model_validate_json(files.path(PREVIEW).read_bytes())
        solution = solve(preview.drawing.value())
    except (OSError, ValueError):
        return kept
    if preview.version <= version or solution.drawing == draft.drawing:
        return KeptDocument(max(version, preview.version), draft, keeper)
    history = draft.history.stepped(preview.label, draft.drawing)
    return KeptDocument(preview.version, Draft(solution, history), keeper)


def _start(files: DocumentFiles, drawing: Drawing) -> WorldState | None:
    """Return the world state from which a drawing is planned, if one was chosen for it and can be read."""
    try:
        kept = Start.model_validate_json(files.path(START).read_bytes())
        return kept.start if kept.drawing.value() == drawing else None
    except (OSError, ValueError):
        return None


def _put_aside(files: DocumentFiles, path: Path) -> str:
    """Rename an unreadable file; return its new name, or the old one if renaming fails."""
    try:
        path.replace(files.path(BROKEN))
    except OSError:
        return path.name
    return files.path(BROKEN).name


def _missing(files: DocumentFiles) -> UnknownDocumentError | BrokenDocumentError:
    """Return the error for a missing document: its file was renamed as broken, or it never existed."""
    broken = files.path(BROKEN)
    if not broken.exists():
        return UnknownDocumentError(files.id)
    try:
        _tape(_content(files, broken))
    except (ValueError, OSError, NewerDocumentError) as error:
        return BrokenDocumentError(files.id, _in_short(error), broken.name)
    return BrokenDocumentError(files.id, "it can be read by now: rename it", broken.name)


def _in_short(error: Exception) -> str:
    """Return the first fault, without its context."""
    if isinstance(error, ValidationError):
        return str(first_error(error, RequestError))
    return error.strerror or "the system refused" if isinstance(error, OSError) else str(error)
