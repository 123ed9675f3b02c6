"""The bodies of requests about documents."""

from typing import Annotated, Any, Literal

from pydantic import Field, PlainValidator
from pydantic_core import PydanticCustomError

from app.api.messages import GarmentField
from app.drawing.drawing_json import DrawingModel
from planner.geometry.given import PlanePoint
from planner.strict_model import StrictModel

Label = Annotated[str, Field(max_length=200)]
Key = Annotated[str, Field(max_length=64)]
Version = Annotated[int, Field(ge=1)]


def _drawing(value: Any) -> Any:  # noqa: ANN401
    if not isinstance(value, dict):
        raise PydanticCustomError("drawing_type", "should be a drawing")
    return value


class NewDocument(StrictModel):
    """Asks for a new document: on a garment, as a copy of another document, or blank."""

    garment: GarmentField | None = None
    copy_of: str | None = None


class EditRequest(StrictModel):
    """A change of the drawing that was made to a version.

    A preview makes no step, a commit makes one, a cancel (which needs no drawing) takes the previews back. Commits with
    the same key `coalesce` that follow at once are one step. A change with another key `gesture` first makes a gesture
    that is still open a step of its own.
    """

    base_version: Version
    label: Label = "Edit"
    phase: Literal["preview", "commit", "cancel"] = "commit"
    drawing: Annotated[Any, PlainValidator(_drawing, json_schema_input_type=DrawingModel)] | None = None
    coalesce: Key | None = None
    gesture: Key | None = None


class GarmentRequest(StrictModel):
    """Another garment in place of the one that is drawn."""

    garment: GarmentField
    label: Label | None = None
    base_version: Version | None = None


class TravelRequest(StrictModel):
    """Undo or redo, perhaps only at a version."""

    base_version: Version | None = None


class Grab(StrictModel):
    """A point of the cloth, and where it is to land (m)."""

    start: PlanePoint = Field(alias="from")
    to: PlanePoint


class Line(StrictModel):
    """A line, anywhere (m)."""

    start: PlanePoint
    end: PlanePoint


class CreaseRequest(StrictModel):
    """Asks where a fold would be, after so many folds: by grab and drop, or along a line."""

    after: Annotated[int, Field(ge=0)] | None = None
    kind: Literal["blue", "red"] = "blue"
    grab: Grab | None = None
    line: Line | None = None
