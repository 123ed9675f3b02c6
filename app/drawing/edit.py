"""Changes to a drawing: the gestures, fields and nudges that come from a page."""

from dataclasses import dataclass
from enum import StrEnum

from app.drawing.drawing import Drawing
from planner.errors import FoldingError

COALESCE_S = 0.6
"""Nudges that are not further apart are one step (s)."""


class Phase(StrEnum):
    """Where in a gesture a change is."""

    PREVIEW = "preview"
    COMMIT = "commit"
    CANCEL = "cancel"


@dataclass(frozen=True, slots=True)
class Edit:
    """A change that is wanted.

    Attributes:
        label: what is done, in words; the name of the step.
        drawing: the drawing as it is to be; None only to cancel.
        phase: a preview makes no step, a commit does, a cancel takes the previews back.
        base_version: the version that was changed; None: whatever it is now.
        coalesce: commits with the same key that follow at once are one step.
        gesture: which gesture it belongs to.
    """

    label: str
    drawing: Drawing | None
    phase: Phase = Phase.COMMIT
    base_version: int | None = None
    coalesce: str | None = None
    gesture: str | None = None


@dataclass(frozen=True, slots=True)
class Gesture:
    """A gesture that is going on.

    Attributes:
        key: which.
        label: what is done, in words.
        before: the drawing when it began.
    """

    key: str | None
    label: str
    before: Drawing


@dataclass
class StaleVersionError(FoldingError):
    """A change was made to a version that is no longer the current one."""

    asked: int
    current: int

    def __str__(self) -> str:
        return f"the change was made to version {self.asked}, but the document is at version {self.current}"
