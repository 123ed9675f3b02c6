"""A mend: a drawing in which one thing is no longer wrong, and what was done to it, in words."""

from dataclasses import dataclass
from typing import Any

from app.drawing.drawing import Drawing
from app.drawing.drawing_json import drawing_to_dict


@dataclass(frozen=True, slots=True)
class Mend:
    """A change to a drawing that cannot be planned.

    Attributes:
        label: what is done, in words; the name of the step.
        drawing: the drawing afterwards, as it would be committed.
    """

    label: str
    drawing: Drawing

    def to_dict(self) -> dict[str, Any]:
        """The mend as JSON."""
        return {"label": self.label, "drawing": drawing_to_dict(self.drawing)}
