"""A kind of file that a document is exported as, when it is available, and what it is made from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from app.distribution import missing
from app.language import ENGLISH, say
from planner.errors import FoldingError, GarmentError
from planner.message import Message

if TYPE_CHECKING:
    from app.document_state import DocumentState
    from planner.cloth.garment import Garment
    from planner.deadline import ShouldStop
    from planner.task.plan import Plan

RATES_HZ = (1.0, 30.0)
"""Range of the frame rate of a recording (Hz)."""

DEFAULT_RATE_HZ = 10.0
"""Frame rate where none is given (Hz)."""

Group = Literal["look", "robot", "open"]

Make = Callable[["DocumentState", float, "ShouldStop"], bytes]
"""Makes a file from a document's state and a frame rate (Hz), unless it should stop."""


class UnavailableFileError(FoldingError):
    """A file cannot be made from a document in its present state."""


@dataclass(frozen=True, slots=True)
class Export:
    """A kind of file to export.

    Attributes:
        what: its name in a request.
        ending: the ending of the file's name.
        media_type: its media type.
        why_not: returns the reason why a state cannot be exported now; None if it can.
        make: makes the file from a state that can be exported.
        group: what it is for: to look at, for robots and simulators, or to be opened again.
        is_slow: whether it takes a while to be made.
        is_folder: whether the file is a zipped folder, which the command line unpacks.
        needs: the modules of optional libraries that make it.
    """

    what: str
    ending: str
    media_type: str
    why_not: Callable[[DocumentState], Message | None]
    make: Make
    group: Group = "open"
    is_slow: bool = False
    is_folder: bool = False
    needs: tuple[str, ...] = ()

    @property
    def title(self) -> str:
        """Its displayed name."""
        return say(ENGLISH, f"file.{self.what}")

    @property
    def text(self) -> str:
        """Its use, in a sentence."""
        return say(ENGLISH, f"file.{self.what}.text")

    @property
    def needs_plan(self) -> bool:
        """Whether the file needs a plan, and not only the garment."""
        return self.why_not in (no_answer, no_plan)

    def reason(self, state: DocumentState) -> Message | None:
        """Return why the file cannot be made here and now; None if it can."""
        return missing(*self.needs) or self.why_not(state)

    def filename(self, state: DocumentState) -> str:
        """Return the name of the file."""
        return f"{state.drawing.name}{self.ending}"

    def file(self, state: DocumentState, rate_hz: float, should_stop: ShouldStop) -> bytes:
        """Return the file; raise `UnavailableFileError` if it cannot be made now."""
        if (reason := self.reason(state)) is not None:
            raise UnavailableFileError(reason.text)
        return self.make(state, rate_hz, should_stop)

    def to_dict(self, state: DocumentState) -> dict[str, Any]:
        """Return the entry for the list of exports, as JSON."""
        reason = self.reason(state)
        return {
            "what": self.what,
            "title": self.title,
            "text": self.text,
            "filename": self.filename(state),
            "media_type": self.media_type,
            "group": self.group,
            "is_slow": self.is_slow,
            "available": reason is None,
            "reason": None if reason is None else reason.text,
            "says": None if reason is None else reason.to_dict(),
        }


def no_outline(state: DocumentState) -> Message | None:
    """Return why there is no garment file: it needs a valid outline, but its folds may be illegal."""
    try:
        as_drawn(state)
    except GarmentError as error:
        return _not_finished(error.says or Message.plain(error.message), error.field)
    return None


def not_legal(state: DocumentState) -> Message | None:
    """Return why there is no file of the folded cloth: the drawing has a problem."""
    if not state.solution.problems:
        return None
    first = state.solution.problems[0]
    return _not_finished(first.says or Message.plain(first.message), "")


def _not_finished(why: Message, field: str) -> Message:
    """Return the message that the drawing has a problem, so that there is no garment."""
    text = f"The drawing is not finished: {f'{field}: ' if field else ''}{why.text}."
    return Message("not_finished", text, {"message": why.text, "says": why.to_dict()})


def no_answer(state: DocumentState) -> Message | None:
    """Return why there is no file of the answer: there is none yet."""
    if (unfinished := not_legal(state)) is not None:
        return unfinished
    if state.failure is not None:
        return Message.plain(f"There is no plan: {state.failure}.")
    return None if state.is_answered else Message.plain("It is still being planned; try again in a moment.")


def no_plan(state: DocumentState) -> Message | None:
    """Return why there is no file of the plan: there is no plan."""
    if (unanswered := no_answer(state)) is not None:
        return unanswered
    plan = plan_in(state)
    if plan.is_solved:
        return None
    if not (first := next(iter(plan.reasons), None)):
        return Message.plain("There is no plan: the planner ran out of time.")
    values = {"fold": first.fold, "message": first.message, "says": first.says.to_dict()}
    return Message("no_plan", f"There is no plan: {first.message}.", values)


def as_drawn(state: DocumentState) -> Garment:
    """Return the garment with its folds as drawn, legal or not; raise `GarmentError` without a valid outline."""
    from app.drawing.solve import garment_of

    return state.solution.garment or garment_of(state.solution.drawing)


def garment_in(state: DocumentState) -> Garment:
    """Return the garment; raise `UnavailableFileError` if the drawing is not finished."""
    garment = state.solution.garment
    if garment is None:
        raise UnavailableFileError("The drawing is not finished.")
    return garment


def plan_in(state: DocumentState) -> Plan:
    """Return the plan, solved or not; raise `UnavailableFileError` if there is no answer yet."""
    if state.answer is None:
        raise UnavailableFileError("It is still being planned; try again in a moment.")
    return state.answer.plan
