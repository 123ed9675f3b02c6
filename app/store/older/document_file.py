"""The document format before journals: one JSON object with the whole history.

Such files are taken over into the database.
"""

from typing import Annotated, Literal

from pydantic import Field

from app.drawing.drawing_json import DrawingModel
from app.drawing.history import STEPS_MAX, History, Step
from planner.strict_model import StrictModel

FORMAT = 1
"""The format number of these files."""


class _StepModel(StrictModel):
    label: str
    drawing: DrawingModel

    def value(self) -> Step:
        return Step(self.label, self.drawing.value())


class DocumentModel(StrictModel):
    """A document's file."""

    format: Literal[1]
    id: str
    version: Annotated[int, Field(ge=1)]
    title: str
    name: str
    changed_at: str
    drawing: DrawingModel
    past: Annotated[list[_StepModel], Field(max_length=STEPS_MAX)]
    future: Annotated[list[_StepModel], Field(max_length=STEPS_MAX)]

    def history(self) -> History:
        """Return the undo history; raise `FieldError` if a drawing in it is invalid."""
        past, future = (tuple(step.value() for step in steps) for steps in (self.past, self.future))
        return History(past, future)
