"""A document as a file: the drawing, and every step that can be undone or redone.

The first line has what a list of documents shows, so that a list need not read whole histories. What a gesture that is
going on has changed stands in a second, small file.
"""

import json
from datetime import UTC, datetime
from typing import Annotated, Any, Literal

from pydantic import Field

from app.drawing.draft import Draft
from app.drawing.drawing import Drawing
from app.drawing.drawing_json import DrawingModel, drawing_to_dict
from app.drawing.history import STEPS_MAX, History, Step
from app.drawing.solve import solve
from planner.strict_model import StrictModel

FORMAT = 1


class Header(StrictModel):
    """What a list shows."""

    format: Literal[1]
    id: str
    version: Annotated[int, Field(ge=1)]
    title: str
    name: str
    changed_at: str


class _StepModel(StrictModel):
    label: str
    drawing: DrawingModel

    def value(self) -> Step:
        return Step(self.label, self.drawing.value())


class DocumentModel(Header):
    """A document's file."""

    drawing: DrawingModel
    past: Annotated[list[_StepModel], Field(max_length=STEPS_MAX)]
    future: Annotated[list[_StepModel], Field(max_length=STEPS_MAX)]

    def draft(self) -> Draft:
        """The draft as it was kept; raises `FieldError`."""
        past, future = (tuple(step.value() for step in steps) for steps in (self.past, self.future))
        return Draft(solve(self.drawing.value()), History(past, future))


class PreviewModel(StrictModel):
    """The file of a gesture that was going on."""

    version: Annotated[int, Field(ge=1)]
    label: str
    drawing: DrawingModel


def document_text(document_id: str, version: int, drawing: Drawing, history: History) -> str:
    """A document's file."""
    header: dict[str, Any] = {
        "format": FORMAT,
        "id": document_id,
        "version": version,
        "title": drawing.title,
        "name": drawing.name,
        "changed_at": datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z"),
    }
    past, future = (",\n".join(step.text for step in steps) for steps in (history.past, history.future))
    drawn = json.dumps(drawing_to_dict(drawing))
    return f'{json.dumps(header)[:-1]},\n"drawing": {drawn},\n"past": [{past}],\n"future": [{future}]}}\n'


def header_of(first_line: str) -> Header:
    """What a list shows, from a file's first line; raises `ValueError`."""
    return Header.model_validate_json(first_line.rstrip().removesuffix(",") + "}")


def preview_text(version: int, label: str, drawing: Drawing) -> str:
    """The file of a gesture that is going on."""
    return json.dumps({"version": version, "label": label, "drawing": drawing_to_dict(drawing)})
