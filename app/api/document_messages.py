"""The bodies of requests about documents."""

from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, PlainValidator
from pydantic_core import PydanticCustomError

from app.api.conditions import either, gives, leaves_out
from app.api.messages import GarmentField
from app.drawing.drawing_json import DrawingModel
from planner.cloth.fold_kinds import FoldName
from planner.geometry.given import PlanePoint
from planner.strict_model import StrictModel

Label = Annotated[str, Field(max_length=200)]
Key = Annotated[str, Field(max_length=64)]
Version = Annotated[int, Field(ge=1)]
Arcs = Annotated[
    bool,
    Field(description="whether edges that stand for the arc of a circle, as in an imported drawing, become curves"),
]

_IS_CANCEL = {"properties": {"phase": {"const": "cancel"}}, "required": ["phase"]}


def _drawing(value: Any) -> Any:  # noqa: ANN401
    if not isinstance(value, dict):
        raise PydanticCustomError("drawing_type", "should be a drawing")
    return value


class NewDocument(StrictModel):
    """A request for a new document: for a garment, as a copy of another document, or blank."""

    model_config = ConfigDict(json_schema_extra=either(leaves_out("garment"), leaves_out("copy_of")))

    garment: GarmentField | None = None
    copy_of: str | None = None
    arcs: Arcs = False


class EditRequest(StrictModel):
    """A change of the drawing, made to a version.

    A preview adds no step to the history, a commit adds one, a cancel (which needs no drawing) undoes the previews.
    Successive commits with the same key `coalesce` are one step. A change with another key `gesture` first commits a
    gesture that is still open.
    """

    model_config = ConfigDict(json_schema_extra=either(gives(drawing="object"), _IS_CANCEL))

    base_version: Version
    label: Label = "Edit"
    phase: Literal["preview", "commit", "cancel"] = "commit"
    drawing: Annotated[Any, PlainValidator(_drawing, json_schema_input_type=DrawingModel)] | None = None
    coalesce: Key | None = None
    gesture: Key | None = None


class GarmentRequest(StrictModel):
    """A request to put another garment in place of the one that is drawn."""

    garment: GarmentField
    label: Label | None = None
    base_version: Version | None = None
    arcs: Arcs = False


class RobotRequest(StrictModel):
    """A request to have another robot fold; it is given by its name."""

    robot: str
    label: Label | None = None
    base_version: Version | None = None


class TravelRequest(StrictModel):
    """A request to undo or redo, optionally only at a given version."""

    base_version: Version | None = None


class Grab(StrictModel):
    """A point of the cloth, and where it lands (m)."""

    start: PlanePoint = Field(alias="from")
    to: PlanePoint


class Line(StrictModel):
    """A line anywhere on the board (m)."""

    start: PlanePoint
    end: PlanePoint


class CreaseRequest(StrictModel):
    """A request for the position of a new fold, after some number of folds: by grab and drop, or along a line."""

    model_config = ConfigDict(
        json_schema_extra=either(
            {"allOf": [gives(grab="object"), leaves_out("line")]}, {"allOf": [gives(line="object"), leaves_out("grab")]}
        )
    )

    after: Annotated[int, Field(ge=0)] | None = None
    kind: FoldName = "blue"
    grab: Grab | None = None
    line: Line | None = None
