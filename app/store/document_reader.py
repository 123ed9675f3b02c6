"""Reads documents from the database."""

from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError
from pydantic_core import from_json
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.drawing.draft import Draft
from app.drawing.drawing import Drawing
from app.drawing.drawing_json import drawing_from_dict
from app.drawing.solve import solve
from app.store.document_errors import BrokenDocumentError, NewerDocumentError, UnknownDocumentError
from app.store.document_keeper import FORMAT, DocumentKeeper, Kept
from app.store.schema import DocumentRow, StepRow
from app.store.tape import Sheet, Tape, history_of
from planner.errors import RequestError
from planner.json_form import JsonForm
from planner.strict_model import first_error
from planner.task.world_state import WorldState

_WORLD_STATE = JsonForm(WorldState)


DAMAGES = (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError)
"""What is raised by a row whose values are not what this program writes."""


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


def read_document(session: Session, keeper: DocumentKeeper) -> KeptDocument:
    """Return a keeper's document as saved; the keeper goes on from there.

    Raises:
        UnknownDocumentError: there is none.
        NewerDocumentError: a newer version of Pleat wrote it.
        BrokenDocumentError: it cannot be read.
    """
    row = _readable(session, keeper.id)
    steps = session.scalars(select(StepRow).where(StepRow.document_id == row.id).order_by(StepRow.number)).all()
    try:
        if [step.number for step in steps] != [*range(row.first, row.first + len(steps))] or not (
            row.first <= row.now < row.first + len(steps)
        ):
            raise ValueError("steps of it are missing")
        labels = ["", *(step.label for step in steps[1:])]
        sheets = tuple(Sheet(label, _drawing(step.drawing)) for label, step in zip(labels, steps, strict=True))
        tape = Tape(sheets, row.now - row.first)
        version, draft = _resumed(row, tape)
    except DAMAGES as error:
        raise BrokenDocumentError(keeper.id, in_short(error)) from None
    keeper.kept = Kept(tape, row.first, row.revision)
    return KeptDocument(version, draft, keeper, _start(row))


def read_versions(session: Session, document_id: str) -> tuple[KeptVersion, ...]:
    """Return the versions of a document before its current one, the latest first; raise as `read_document` does."""
    row = _readable(session, document_id)
    earlier = select(StepRow).where(StepRow.document_id == row.id, StepRow.number < row.now)
    steps = session.scalars(earlier.order_by(StepRow.number.desc())).all()
    try:
        return tuple(
            KeptVersion(step.label if step.number > row.first else "", step.changed_at, from_json(step.drawing))
            for step in steps
        )
    except DAMAGES as error:
        raise BrokenDocumentError(document_id, in_short(error)) from None


def in_short(error: Exception) -> str:
    """Return the first fault, without its context."""
    return str(first_error(error, RequestError)) if isinstance(error, ValidationError) else str(error)


def _readable(session: Session, document_id: str) -> DocumentRow:
    row = session.get(DocumentRow, document_id)
    if row is None:
        raise UnknownDocumentError(document_id)
    if not isinstance(row.format, int):
        raise BrokenDocumentError(document_id, f"its format is {row.format!r}")
    if row.format > FORMAT or (row.problem is not None and row.format):
        raise NewerDocumentError(document_id, row.format)
    if row.problem is not None:
        raise BrokenDocumentError(document_id, row.problem)
    return row


def _drawing(text: str) -> Drawing:
    return drawing_from_dict(from_json(text))


def _start(row: DocumentRow) -> WorldState | None:
    """Return the world state from which the drawing is planned, if one was chosen and can be read."""
    try:
        return None if row.start is None else _WORLD_STATE.read(from_json(row.start))
    except ValueError:
        return None


def _resumed(row: DocumentRow, tape: Tape[Drawing]) -> tuple[int, Draft]:
    """Return version and draft, with the gesture that was in progress when the server ended."""
    drawing, history = history_of(tape)
    draft = Draft(solve(drawing), history)
    if row.preview is None or row.preview_version is None:
        return row.version, draft
    version = max(row.version, row.preview_version)
    solution = solve(_drawing(row.preview))
    if solution.drawing == drawing:
        return version, draft
    return version, Draft(solution, history.stepped(row.preview_label or "", drawing))
