"""A mend: a drawing in which one thing is no longer wrong, and what was done to it, in words."""

from dataclasses import dataclass
from typing import Any

from app.drawing.drawing import Drawing
from app.drawing.drawing_json import drawing_to_dict
from planner.message import Message


@dataclass(frozen=True, slots=True)
class Mend:
    """A change to a drawing that cannot be planned.

    Attributes:
        says: what is done.
        drawing: the drawing afterwards, as it would be committed.
    """

    says: Message
    drawing: Drawing

    @property
    def label(self) -> str:
        """What is done, in words."""
        return self.says.text

    def to_dict(self) -> dict[str, Any]:
        """The mend as JSON."""
        return {"label": self.label, "says": self.says.to_dict(), "drawing": drawing_to_dict(self.drawing)}
