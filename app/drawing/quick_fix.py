"""A quick fix: a labelled change that removes one problem from a drawing."""

from dataclasses import dataclass
from typing import Any

from app.drawing.drawing import Drawing
from app.drawing.drawing_json import drawing_to_dict
from planner.message import Message


@dataclass(frozen=True, slots=True)
class QuickFix:
    """A quick fix for a drawing that cannot be planned.

    Attributes:
        says: the change as a message.
        drawing: the drawing after the change, ready to commit.
    """

    says: Message
    drawing: Drawing

    @property
    def label(self) -> str:
        """The change, in words."""
        return self.says.text

    def to_dict(self) -> dict[str, Any]:
        """Return the quick fix as JSON."""
        return {"label": self.label, "says": self.says.to_dict(), "drawing": drawing_to_dict(self.drawing)}
