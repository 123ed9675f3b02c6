"""Saves one document to the disk.

A commit adds a synced line to the document's journal. Previews come many times a second, so they go into a small file
of their own, which survives the end of this process but need not survive a power failure.
"""

import os
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime

from pydantic_core import to_json

from app.drawing.draft import Draft
from app.drawing.drawing import Drawing
from app.store.document_files import HEAD, JOURNAL, JSON, PREVIEW, START, DocumentFiles, preview_text, start_text
from app.store.durable_file import write_at_once
from app.store.journal import Journal, change_line, start_line
from app.store.storage_error import storing
from app.store.tape import Tape, tape_of, whole
from planner.task.world_state import WorldState

_SLACK_BYTES = 1 << 16
"""Growth after which a journal is rewritten, unless its initial length is larger: then it may double (bytes)."""


@dataclass(slots=True)
class _Kept:
    """The saved state: the drawings, their version, and the journal's length."""

    version: int
    tape: Tape[Drawing]
    generation: int = -1
    base_bytes: int = 0
    bytes: int = 0

    @property
    def is_overgrown(self) -> bool:
        """Whether the journal has grown so much that it should be rewritten."""
        return self.bytes - self.base_bytes > max(_SLACK_BYTES, self.base_bytes)


class DocumentKeeper:
    """Saves the drafts of one document, one at a time."""

    def __init__(self, files: DocumentFiles) -> None:
        """Start with a document that is not on the disk."""
        self._files = files
        self._kept: _Kept | None = None

    @staticmethod
    def of_journal(files: DocumentFiles, journal: Journal, tape: Tape[Drawing]) -> "DocumentKeeper":
        """Return the keeper that continues a journal just read."""
        keeper = DocumentKeeper(files)
        keeper._kept = _Kept(journal.version, tape, journal.generation, journal.base_bytes, journal.whole_bytes)
        return keeper

    @staticmethod
    def of_older(files: DocumentFiles, version: int, tape: Tape[Drawing]) -> "DocumentKeeper":
        """Return the keeper that continues a document of an older format."""
        keeper = DocumentKeeper(files)
        keeper._kept = _Kept(version, tape)
        return keeper

    def keep(self, version: int, draft: Draft) -> None:
        """Save a draft; raise `StorageError` if that fails, with the earlier state still saved."""
        with storing(f"document {self._files.id!r} could not be written, so the change was not made"):
            self._keep(version, draft)

    def keep_start(self, drawing: Drawing, start: WorldState | None) -> None:
        """Save the world state from which a drawing is planned; raise `StorageError` if that fails."""
        path = self._files.path(START)
        if start is None:
            with suppress(OSError):  # readers ignore the start of another drawing
                path.unlink()
            return
        with storing(f"document {self._files.id!r} could not be written, so its start was not changed"):
            write_at_once(path, start_text(drawing, start), is_synced=False)

    def _keep(self, version: int, draft: Draft) -> None:
        gesture = draft.gesture
        if gesture is None:
            self._write(version, tape_of(draft.drawing, draft.history))
            with suppress(OSError):  # readers ignore a preview of an older version
                self._files.path(PREVIEW).unlink()
            return
        before = tape_of(gesture.before, draft.history)
        if self._kept is None or self._kept.tape != before:
            self._write(version - 1, before)
        text = preview_text(version, gesture.label, draft.drawing)
        write_at_once(self._files.path(PREVIEW), text, is_synced=False)

    def _write(self, version: int, tape: Tape[Drawing]) -> None:
        if self._kept is None:
            self._files.folder.mkdir(parents=True, exist_ok=True)
            self._begin(_Kept(version, tape))
            return
        if self._kept.is_overgrown:
            with suppress(OSError):  # the old journal still works
                self._begin(self._kept)
        if not self._is_in_place(self._kept):
            self._files.folder.mkdir(parents=True, exist_ok=True)
            self._begin(self._kept)
        self._append(self._kept, version, tape)

    def _is_in_place(self, kept: _Kept) -> bool:
        """Return whether the journal exists and holds all saved changes."""
        try:
            return 0 < kept.bytes <= self._files.path(JOURNAL).stat().st_size
        except FileNotFoundError:
            return False

    def _begin(self, kept: _Kept) -> None:
        """Write a new journal with the saved state, in place of the old one."""
        generation, now = kept.generation + 1, _now()
        line = change_line(kept.version, now, whole(kept.tape))
        text = start_line(self._files.id, generation) + line
        write_at_once(self._files.path(JOURNAL), text)
        kept.generation, kept.base_bytes, kept.bytes = generation, len(text), len(text)
        self._kept = kept
        self._write_head(kept, now)
        with suppress(OSError):  # readers prefer the journal
            self._files.path(JSON).unlink()

    def _append(self, kept: _Kept, version: int, tape: Tape[Drawing]) -> None:
        now = _now()
        line = change_line(version, now, kept.tape.change_to(tape))
        with self._files.path(JOURNAL).open("r+b") as file:
            file.truncate(kept.bytes)  # drop a line that a killed server left unfinished
            file.seek(kept.bytes)
            try:
                file.write(line)
                file.flush()
                os.fsync(file.fileno())
            except OSError:
                with suppress(OSError):
                    file.truncate(kept.bytes)
                raise
        kept.version, kept.tape, kept.bytes = version, tape, kept.bytes + len(line)
        self._write_head(kept, now)

    def _write_head(self, kept: _Kept, now: str) -> None:
        drawing = kept.tape.sheets[kept.tape.now].drawing
        head = {
            "id": self._files.id,
            "generation": kept.generation,
            "bytes": kept.bytes,
            "title": drawing.title,
            "name": drawing.name,
            "changed_at": now,
        }
        with suppress(OSError):  # it can be made again from the journal
            write_at_once(self._files.path(HEAD), to_json(head), is_synced=False)


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
