"""The documents in a folder. A file that cannot be read is put aside and told of; the others can be opened still."""

import re
import secrets
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError

from app.drawing.draft import Draft
from app.drawing.solve import solve
from app.store.document_file import DocumentModel, PreviewModel, header_of
from app.store.document_keeper import DocumentKeeper
from app.store.durable_file import sync_folder, write_at_once
from planner.errors import FieldError, FoldingError, RequestError
from planner.strict_model import first_error

ID_PATTERN = re.compile(r"[a-z0-9]{8}")
_LETTERS = "23456789abcdefghjkmnpqrstuvwxyz"
_KEPT, _PREVIEW, _BROKEN = ".json", ".preview", ".broken"


@dataclass
class UnknownDocumentError(FoldingError):
    """No document has this id."""

    document_id: str

    def __str__(self) -> str:
        return f"there is no document {self.document_id[:80]!r}"


@dataclass
class BrokenDocumentError(FoldingError):
    """A document's file cannot be read."""

    document_id: str
    why: str

    def __str__(self) -> str:
        name = f"{self.document_id}{_BROKEN}"
        return f"the file of document {self.document_id!r} cannot be read and is kept as {name!r}: {self.why}"


@dataclass
class UnreadableDocumentError(FoldingError):
    """The system does not let a document's file be read or written."""

    document_id: str
    why: str

    def __str__(self) -> str:
        return f"the file of document {self.document_id!r}: {self.why}"


@dataclass(frozen=True, slots=True)
class DocumentEntry:
    """A document as the list shows it.

    Attributes:
        id: its id.
        title: the garment's title; empty if the file cannot be read.
        name: the garment's name; likewise.
        changed_at: when it was changed last, UTC, as in RFC 3339; likewise.
        problem: why it cannot be opened, or None.
    """

    id: str
    title: str = ""
    name: str = ""
    changed_at: str = ""
    problem: str | None = None


class DocumentShelf:
    """The documents in a folder, which is made when the first is kept."""

    def __init__(self, folder: Path) -> None:
        """Remove what a server that was killed while it wrote has left."""
        self._folder = folder
        self._last = folder / ".last"
        for left in folder.glob(".?*-*"):
            left.unlink(missing_ok=True)

    def entries(self) -> list[DocumentEntry]:
        """All documents, the one changed last first; those that cannot be read at the end."""
        found = [self._entry(path.stem) for path in self._folder.glob(f"*{_KEPT}") if ID_PATTERN.fullmatch(path.stem)]
        broken = [_broken_entry(path) for path in sorted(self._folder.glob(f"*{_BROKEN}"))]
        good = sorted((one for one in found if one.problem is None), key=lambda one: one.changed_at, reverse=True)
        return good + [one for one in found if one.problem is not None] + broken

    def new_id(self) -> str:
        """An id that no document has."""
        while True:
            document_id = "".join(secrets.choice(_LETTERS) for _ in range(8))
            if not self.has(document_id):
                return document_id

    def has(self, document_id: str) -> bool:
        """Whether there is a document of this id."""
        return bool(ID_PATTERN.fullmatch(document_id)) and self.path(document_id).exists()

    def path(self, document_id: str, suffix: str = _KEPT) -> Path:
        """Where a document's file is; raises `UnknownDocumentError` for what is no id."""
        if not ID_PATTERN.fullmatch(document_id):
            raise UnknownDocumentError(document_id)
        return self._folder / (document_id + suffix)

    def keeper(self, document_id: str) -> DocumentKeeper:
        """What keeps this document on the disk."""
        return DocumentKeeper(document_id, self.path(document_id), self.path(document_id, _PREVIEW))

    def kept(self, document_id: str) -> tuple[int, Draft]:
        """A document's version and draft as they were kept; a gesture that was going on is a step.

        Raises:
            UnknownDocumentError: there is none.
            BrokenDocumentError: its file is no document, and has been put aside.
            UnreadableDocumentError: the system does not let it be read.
        """
        path = self.path(document_id)
        try:
            document = DocumentModel.model_validate_json(path.read_bytes())
            draft = document.draft()
        except FileNotFoundError:
            broken = self.path(document_id, _BROKEN)
            raise (_broken(broken) if broken.exists() else UnknownDocumentError(document_id)) from None
        except (ValueError, FieldError) as error:
            path.replace(path.with_suffix(_BROKEN))
            raise BrokenDocumentError(document_id, _in_short(error)) from None
        except OSError as error:
            raise UnreadableDocumentError(document_id, error.strerror or "it cannot be read") from None
        return self._resumed(document_id, document.version, draft)

    def remove(self, document_id: str) -> None:
        """Remove a document; raises `UnknownDocumentError`."""
        files = [self.path(document_id, suffix) for suffix in (_KEPT, _BROKEN, _PREVIEW)]
        if not any(file.exists() for file in files[:2]):
            raise UnknownDocumentError(document_id)
        for file in files:
            file.unlink(missing_ok=True)
        sync_folder(self._folder)

    def recent(self) -> list[str]:
        """The documents that can be opened, it seems, the one opened last first, then the one changed last."""
        try:
            last = self._last.read_text(encoding="utf-8")
        except (OSError, ValueError):
            last = ""
        good = [entry.id for entry in self.entries() if entry.problem is None]
        return sorted(good, key=lambda document_id: document_id != last)

    def remember_last(self, document_id: str) -> None:
        """Remember which document was opened last."""
        self._folder.mkdir(parents=True, exist_ok=True)
        write_at_once(self._last, document_id, is_synced=False)

    def _entry(self, document_id: str) -> DocumentEntry:
        try:
            with self.path(document_id).open(encoding="utf-8") as file:
                header = header_of(file.readline())
        except (OSError, ValueError) as error:
            return DocumentEntry(document_id, problem=_in_short(error))
        return DocumentEntry(document_id, header.title, header.name, header.changed_at)

    def _resumed(self, document_id: str, version: int, draft: Draft) -> tuple[int, Draft]:
        """The draft with what a gesture had changed when the server ended; a file of it that is broken is dropped."""
        try:
            preview = PreviewModel.model_validate_json(self.path(document_id, _PREVIEW).read_bytes())
            solution = solve(preview.drawing.value())
        except (OSError, ValueError, FieldError):
            return version, draft
        if preview.version <= version or solution.drawing == draft.drawing:
            return max(version, preview.version), draft
        return preview.version, Draft(solution, draft.history.stepped(preview.label, draft.drawing))


def _broken_entry(path: Path) -> DocumentEntry:
    return DocumentEntry(path.stem, problem=str(_broken(path)))


def _broken(path: Path) -> BrokenDocumentError:
    """Why a file that has been put aside cannot be read."""
    try:
        DocumentModel.model_validate_json(path.read_bytes()).draft()
    except (OSError, ValueError, FieldError) as error:
        return BrokenDocumentError(path.stem, _in_short(error))
    return BrokenDocumentError(path.stem, "it can be read by now: rename it")


def _in_short(error: Exception) -> str:
    """The first fault, without what it was found in."""
    if isinstance(error, ValidationError):
        return str(first_error(error, RequestError))
    return str(error)
