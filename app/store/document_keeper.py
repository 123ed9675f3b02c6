"""Keeps one document on the disk.

A commit is written with its whole history, and synced. Previews come many times a second: they go into a small file of
their own, which outlives the end of this process and need not outlive a power failure.
"""

from dataclasses import dataclass
from pathlib import Path

from app.drawing.draft import Draft
from app.drawing.drawing import Drawing
from app.drawing.history import History
from app.store.document_file import document_text, preview_text
from app.store.durable_file import write_at_once
from planner.errors import FoldingError


@dataclass
class UnkeptDocumentError(FoldingError):
    """A change could not be written, so it was not made."""

    document_id: str
    why: str

    def __str__(self) -> str:
        return f"the change was not made, because document {self.document_id!r} could not be written: {self.why}"


class DocumentKeeper:
    """Writes the drafts of one document, one at a time."""

    def __init__(self, document_id: str, path: Path, preview: Path) -> None:
        """Nothing is written yet.

        Args:
            document_id: the document.
            path: its file.
            preview: the file of a gesture that is going on.
        """
        self._id = document_id
        self._path = path
        self._preview = preview
        self._history: History | None = None
        self._drawing: Drawing | None = None

    def keep(self, version: int, draft: Draft) -> None:
        """Write a draft; raises `UnkeptDocumentError`, and then what was written before is still there."""
        try:
            self._keep(version, draft)
        except OSError as error:
            raise UnkeptDocumentError(self._id, error.strerror or str(error)) from error

    def _keep(self, version: int, draft: Draft) -> None:
        gesture = draft.gesture
        if gesture is None:
            self._write(version, draft.drawing, draft.history)
            self._preview.unlink(missing_ok=True)
            return
        if self._history is not draft.history or self._drawing != gesture.before:
            self._write(version - 1, gesture.before, draft.history)
        write_at_once(self._preview, preview_text(version, gesture.label, draft.drawing), is_synced=False)

    def _write(self, version: int, drawing: Drawing, history: History) -> None:
        self._path.parent.mkdir(parents=True, exist_ok=True)
        write_at_once(self._path, document_text(self._id, version, drawing, history))
        self._drawing, self._history = drawing, history
