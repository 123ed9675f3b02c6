"""All exports of a document: the kinds of file, when each is available, and how it is made."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from app.document_state import DocumentState
from app.drawing.solve import garment_of
from app.files.fold_format import fold_format
from app.files.instruction_sheet import instruction_sheet
from app.files.plan_table import plan_table
from app.files.recording import recording
from app.files.sheet_pdf import page_pdf
from app.files.sheet_svg import page_svg
from app.files.svg_drawing import svg_drawing
from app.jobs.job_pool import ShouldStop
from planner.cloth.garment import Garment
from planner.errors import FoldingError, GarmentError
from planner.message import Message
from planner.task.plan import Plan

Make = Callable[[DocumentState, float, ShouldStop], bytes]
"""Makes a file from a document's state and a frame rate (Hz), unless it should stop."""


class UnavailableFileError(FoldingError):
    """A file cannot be made from a document in its present state."""


@dataclass(frozen=True, slots=True)
class Export:
    """A kind of file to export.

    Attributes:
        what: its name in a request.
        title: its displayed name.
        text: its use, in a sentence.
        ending: the ending of the file's name.
        media_type: its media type.
        why_not: returns the reason why a state cannot be exported now; None if it can.
        make: makes the file from a state that can be exported.
    """

    what: str
    title: str
    text: str
    ending: str
    media_type: str
    why_not: Callable[[DocumentState], Message | None]
    make: Make

    @property
    def needs_plan(self) -> bool:
        """Whether the file needs a plan, and not only the garment."""
        return self.why_not in (_no_answer, _no_plan)

    def filename(self, state: DocumentState) -> str:
        """Return the name of the file."""
        return f"{state.drawing.name}{self.ending}"

    def file(self, state: DocumentState, rate_hz: float, should_stop: ShouldStop) -> bytes:
        """Return the file; raise `UnavailableFileError` if it cannot be made now."""
        if (reason := self.why_not(state)) is not None:
            raise UnavailableFileError(reason.text)
        return self.make(state, rate_hz, should_stop)

    def to_dict(self, state: DocumentState) -> dict[str, Any]:
        """Return the entry for the list of exports, as JSON."""
        reason = self.why_not(state)
        return {
            "what": self.what,
            "title": self.title,
            "text": self.text,
            "filename": self.filename(state),
            "media_type": self.media_type,
            "available": reason is None,
            "reason": None if reason is None else reason.text,
            "says": None if reason is None else reason.to_dict(),
        }


def find_export(what: str) -> Export | None:
    """Return the export with a name, or None."""
    return next((export for export in EXPORTS if export.what == what), None)


def _no_outline(state: DocumentState) -> Message | None:
    """Return why there is no garment file: it needs a valid outline, but its folds may be illegal."""
    try:
        _as_drawn(state)
    except GarmentError as error:
        return _not_finished(error.says or Message.plain(error.message), error.field)
    return None


def _not_legal(state: DocumentState) -> Message | None:
    if not state.solution.problems:
        return None
    first = state.solution.problems[0]
    return _not_finished(first.says or Message.plain(first.message), "")


def _not_finished(why: Message, field: str) -> Message:
    """Return the message that the drawing has a problem, so that there is no garment."""
    text = f"The drawing is not finished: {f'{field}: ' if field else ''}{why.text}."
    return Message("not_finished", text, {"message": why.text, "says": why.to_dict()})


def _no_answer(state: DocumentState) -> Message | None:
    if (unfinished := _not_legal(state)) is not None:
        return unfinished
    if state.failure is not None:
        return Message.plain(f"There is no plan: {state.failure}.")
    return None if state.is_answered else Message.plain("It is still being planned; try again in a moment.")


def _no_plan(state: DocumentState) -> Message | None:
    if (unanswered := _no_answer(state)) is not None:
        return unanswered
    plan = _plan(state)
    if plan.is_solved:
        return None
    if not (first := next(iter(plan.reasons), None)):
        return Message.plain("There is no plan: the planner ran out of time.")
    values = {"fold": first.fold, "message": first.message, "says": first.says.to_dict()}
    return Message("no_plan", f"There is no plan: {first.message}.", values)


def _as_drawn(state: DocumentState) -> Garment:
    """Return the garment with its folds as drawn, legal or not; raise `GarmentError` without a valid outline."""
    return state.solution.garment or garment_of(state.solution.drawing)


def _garment(state: DocumentState) -> Garment:
    garment = state.solution.garment
    if garment is None:
        raise UnavailableFileError("The drawing is not finished.")
    return garment


def _plan(state: DocumentState) -> Plan:
    if state.answer is None:
        raise UnavailableFileError("It is still being planned; try again in a moment.")
    return state.answer.plan


def _json(data: Any) -> bytes:  # noqa: ANN401
    return (json.dumps(data, indent=1) + "\n").encode("ascii")


def _garment_json(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    return _json(_as_drawn(state).to_dict())


def _garment_svg(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    return svg_drawing(_as_drawn(state)).encode("utf-8", "replace")


def _garment_fold(state: DocumentState, _: float, should_stop: ShouldStop) -> bytes:
    return _json(fold_format(_garment(state), state.solution.cloths, should_stop))


def _plan_json(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    return (json.dumps(_plan(state).to_dict()) + "\n").encode("ascii")


def _plan_csv(state: DocumentState, _: float, __: ShouldStop) -> bytes:
    return plan_table(_plan(state)).encode("utf-8", "replace")


def _recording(state: DocumentState, rate_hz: float, should_stop: ShouldStop) -> bytes:
    return recording(_plan(state), rate_hz, should_stop, is_dark=state.is_dark)


EXPORTS = (
    Export(
        "garment.json",
        "Garment (JSON)",
        "Outline, folds and placement; Pleat opens it again.",
        ".json",
        "application/json",
        _no_outline,
        _garment_json,
    ),
    Export(
        "garment.svg",
        "Drawing (SVG)",
        "The outline and the fold lines in centimetres, for any drawing program; Pleat reads it again.",
        ".svg",
        "image/svg+xml",
        _no_outline,
        _garment_svg,
    ),
    Export(
        "garment.fold",
        "Folding (FOLD)",
        "The crease pattern and the cloth after each fold, for origami programs.",
        ".fold",
        "application/json",
        _not_legal,
        _garment_fold,
    ),
    Export(
        "plan.json",
        "Plan (JSON)",
        "What was asked, what the robot does at every moment, or why it cannot; Pleat reads it again.",
        ".plan.json",
        "application/json",
        _no_answer,
        _plan_json,
    ),
    Export(
        "plan.csv",
        "Plan (CSV)",
        "A row for each step: times, the base, and each hand's points as table and base see them.",
        "-plan.csv",
        "text/csv; charset=utf-8",
        _no_plan,
        _plan_csv,
    ),
    Export(
        "sheet.pdf",
        "Instruction sheet (PDF)",
        "The steps on one page to print: a numbered picture each, where the hands go, and from where.",
        "-steps.pdf",
        "application/pdf",
        _no_plan,
        lambda state, *_: page_pdf(instruction_sheet(_plan(state))),
    ),
    Export(
        "sheet.svg",
        "Instruction sheet (SVG)",
        "The same page for any drawing program.",
        "-steps.svg",
        "image/svg+xml",
        _no_plan,
        lambda state, *_: page_svg(instruction_sheet(_plan(state))),
    ),
    Export(
        "recording.html",
        "Recording (HTML)",
        "The animation in one file that plays in any browser, without a server.",
        ".html",
        "text/html; charset=utf-8",
        _no_plan,
        _recording,
    ),
)
"""All exports, in the order shown."""
