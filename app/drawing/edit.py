"""Edits of a drawing: the gestures, field changes and nudges that come from a page."""

from dataclasses import dataclass
from enum import StrEnum

from app.drawing.drawing import Drawing
from planner.errors import FoldingError

COALESCE_S = 0.6
"""Longest gap between nudges that count as one undo step (s)."""


class Phase(StrEnum):
    """The phase of a gesture that a change belongs to."""

    PREVIEW = "preview"
    COMMIT = "commit"
    CANCEL = "cancel"


@dataclass(frozen=True, slots=True)
class Edit:
    """A requested change.

    Attributes:
        label: the label of the undo step.
        drawing: the drawing after the change; None only to cancel.
        phase: a preview makes no step, a commit makes one, a cancel takes the previews back.
        base_version: the version that was changed; None for the current one.
        coalesce: commits with the same key in quick succession count as one step.
        gesture: the key of the gesture that the change belongs to.
    """

    label: str
    drawing: Drawing | None
    phase: Phase = Phase.COMMIT
    base_version: int | None = None
    coalesce: str | None = None
    gesture: str | None = None


@dataclass(frozen=True, slots=True)
class Gesture:
    """A gesture in progress.

    Attributes:
        key: the gesture's key.
        label: the label of its undo step.
        before: the drawing when it began.
    """

    key: str | None
    label: str
    before: Drawing


@dataclass
class StaleVersionError(FoldingError):
    """A change was based on a version that is no longer current."""

    asked: int
    current: int

    def __str__(self) -> str:
        return f"the change was made to version {self.asked}, but the document is at version {self.current}"


class OvertakenError(FoldingError):
    """Another server has changed the document."""

    def __str__(self) -> str:
        return "the document was changed by another server meanwhile"
