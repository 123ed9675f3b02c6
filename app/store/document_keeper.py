"""Saves one document in the database.

A commit writes what it changes of the document's tape (see `app.store.tape`): most often one step. It is on the disk
when it returns. Previews come many times a second, so they survive the end of this process, but need not survive a
power failure.
"""

from datetime import UTC, datetime
from typing import Any, NamedTuple

from pydantic_core import to_json
from sqlalchemy import CursorResult, bindparam, delete, insert, or_, select, update
from sqlalchemy.orm import Session

from app.drawing.draft import Draft
from app.drawing.drawing import Drawing
from app.drawing.drawing_json import drawing_to_dict
from app.drawing.edit import OvertakenError
from app.store.database import Database
from app.store.document_errors import UnknownDocumentError
from app.store.schema import Table
from app.store.tape import Tape, TapeChange, tape_of, whole
from planner.task.world_state import WorldState

FORMAT = 4
"""The newest format number of documents in the database."""

_STRAIGHT = 3
"""The format number of documents without curves, which versions that know no curves read."""

_DOCUMENTS, _STEPS = (Table.metadata.tables[name] for name in ("documents", "document_steps"))

# Built once: to build a statement takes longer than to find it compiled.
_CHANGE = update(_DOCUMENTS).where(_DOCUMENTS.c.id == bindparam("of"), _DOCUMENTS.c.revision == bindparam("known"))
_DROP_STEPS = delete(_STEPS).where(
    _STEPS.c.document_id == bindparam("of"),
    or_(_STEPS.c.number < bindparam("begin"), _STEPS.c.number >= bindparam("end")),
)
_ADD, _ADD_STEPS = insert(_DOCUMENTS), insert(_STEPS)
_FIND = select(_DOCUMENTS.c.id).where(_DOCUMENTS.c.id == bindparam("of"))

_NO_PREVIEW = {"preview_version": None, "preview_label": None, "preview": None}


class Kept(NamedTuple):
    """The saved data: the drawings, the number of the first drawing's step, and how often the document was changed."""

    tape: Tape[Drawing]
    first: int
    revision: int


class DocumentKeeper:
    """Saves the drafts of one document, one at a time.

    Attributes:
        id: the document's id.
        kept: what is saved; None: nothing yet.
    """

    def __init__(self, database: Database, document_id: str, kept: Kept | None = None) -> None:
        """Continue from what is saved; None if nothing is."""
        self._database = database
        self.id = document_id
        self.kept = kept

    def keep(self, version: int, draft: Draft) -> None:
        """Save a draft, and forget the world state from which the one before was planned.

        Raises:
            OvertakenError: another server has changed the document.
            UnknownDocumentError: it was removed.
            StorageError: the draft could not be saved; the earlier state still is.
        """
        gesture, kept = draft.gesture, self.kept
        committed = tape_of(draft.drawing if gesture is None else gesture.before, draft.history)
        is_step = kept is None or gesture is None or kept.tape != committed
        what = f"document {self.id!r} could not be written, so the change was not made"
        with self._database.writing(what, is_synced=is_step) as session:
            if is_step:
                kept = self._commit(session, version if gesture is None else version - 1, committed)
            if gesture is not None:
                preview = {
                    "preview_label": _text(gesture.label),
                    "preview": _json(draft.drawing),
                    "preview_version": version,
                }
                self._update(session, kept, {"start": None, **preview})
        self.kept = kept

    def keep_start(self, start: WorldState | None) -> None:
        """Save the world state from which the drawing is planned, None for its own start; raise as `keep` does."""
        what = f"document {self.id!r} could not be written, so its start was not changed"
        with self._database.writing(what, is_synced=False) as session:
            text = None if start is None else to_json(start.to_dict()).decode()
            self._update(session, self.kept, {"start": text})

    def _commit(self, session: Session, version: int, tape: Tape[Drawing]) -> Kept:
        """Write a tape where another one is saved, and return what is saved then."""
        kept = self.kept or Kept(Tape((), 0), 0, -1)
        change = whole(tape) if self.kept is None else kept.tape.change_to(tape)
        after = Kept(tape, kept.first + change.dropped, kept.revision + 1)
        changed_at = datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
        drawing = tape.sheets[tape.now].drawing
        row: dict[str, Any] = {
            "revision": after.revision,
            "format": _format_of(tape),
            "version": version,
            "changed_at": changed_at,
            "title": _text(drawing.title),
            "name": drawing.name,
            "first": after.first,
            "now": after.first + tape.now,
            "start": None,
            **_NO_PREVIEW,
        }
        if self.kept is None:
            session.execute(_ADD, {"id": self.id, **row})
        else:
            self._update(session, kept, row)
        self._write_steps(session, kept, change, changed_at)
        return after

    def _write_steps(self, session: Session, kept: Kept, change: TapeChange[Drawing], changed_at: str) -> None:
        first = kept.first + change.dropped
        end = first + change.kept
        if change.dropped or end < kept.first + len(kept.tape.sheets):
            session.execute(_DROP_STEPS, {"of": self.id, "begin": first, "end": end})
        added = [
            {
                "document_id": self.id,
                "number": end + place,
                "label": _text(sheet.label),
                "changed_at": changed_at,
                "drawing": _json(sheet.drawing),
            }
            for place, sheet in enumerate(change.added)
        ]
        if added:
            session.execute(_ADD_STEPS, added)

    def _update(self, session: Session, kept: Kept | None, row: dict[str, Any]) -> None:
        """Change the document's row, if it is as this server knows it."""
        known = -1 if kept is None else kept.revision
        result = session.execute(_CHANGE, {"of": self.id, "known": known, **row})
        assert isinstance(result, CursorResult)
        if result.rowcount == 0:
            is_there = session.execute(_FIND, {"of": self.id}).first() is not None
            raise OvertakenError if is_there else UnknownDocumentError(self.id)


def _format_of(tape: Tape[Drawing]) -> int:
    """Return the number of the first format that has all that a tape holds."""
    corners = (corner for sheet in tape.sheets for corner in sheet.drawing.outline)
    return FORMAT if any(corner.curve is not None for corner in corners) else _STRAIGHT


def _json(drawing: Drawing) -> str:
    return to_json(drawing_to_dict(drawing)).decode()


def _text(text: str) -> str:
    """Return a text that PostgreSQL keeps: it knows no zero character."""
    return text.replace("\0", "\ufffd")
