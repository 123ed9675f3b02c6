"""The messages of pages and programs about a document: changes, questions, and commands.

A page sends all of them over its websocket, as an object whose `do` says which it is; a program has a route for each
change and question.
"""

from typing import Annotated, Any, Literal, TypeAlias, cast

from pydantic import ConfigDict, Field, PlainValidator
from pydantic_core import PydanticCustomError

from app.api.messages import GarmentField, PlacesRequest, StartField, either, gives, leaves_out
from app.drawing.drawing import Drawing
from app.language import Language
from app.playback import SPEED_MAX, SPEED_MIN
from planner.cloth.fold_kinds import FoldName
from planner.geometry.given import PlanePoint
from planner.json_form import JsonForm
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
    drawing: Annotated[Any, PlainValidator(_drawing, json_schema_input_type=Drawing)] | None = None
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


class Play(StrictModel):
    """Let time run."""

    do: Literal["play"]


class Pause(StrictModel):
    """Stop time."""

    do: Literal["pause"]


class Seek(StrictModel):
    """Go to a time (s)."""

    do: Literal["seek"]
    t_s: Annotated[float, Field(ge=0.0, le=1e6)]


class SetSpeed(StrictModel):
    """Set the speed of playback."""

    do: Literal["speed"]
    speed: Annotated[float, Field(ge=SPEED_MIN, le=SPEED_MAX)]


class SetTheme(StrictModel):
    """Set the 3D view's theme, dark or light."""

    do: Literal["theme"]
    dark: bool


class SetLanguage(StrictModel):
    """Set the language of the 3D view's words and of the instruction sheet."""

    do: Literal["language"]
    language: Language


class SetEffort(StrictModel):
    """Set the work of each search from the next one on (s, as `work_limit_s`); null: the usual."""

    do: Literal["effort"]
    work_s: Annotated[float, Field(ge=0.1, le=60.0)] | None


class Choose(StrictModel):
    """Replace the garment by another."""

    do: Literal["choose"]
    garment: str


class Stop(StrictModel):
    """Stop planning; the next edit starts it again."""

    do: Literal["stop"]


class PlanAgain(StrictModel):
    """Plan again what has no answer because planning was stopped or has failed."""

    do: Literal["plan"]


class LookLonger(StrictModel):
    """Continue a search that ran out of work, for a plan or for a quicker one."""

    do: Literal["look_longer"]


class PlanFrom(StrictModel):
    """Plan what is left after a step of the plan, counted from 0; null: plan from before all folds, as drawn."""

    do: Literal["plan_from"]
    step: Annotated[int, Field(ge=-1, le=10_000)] | None


class PlanFromState(StrictModel):
    """Plan what is left from a state of the world, as `start` of a plan request."""

    do: Literal["plan_from_state"]
    start: StartField


class ShowTrace(StrictModel):
    """Have the 3D view show the cloth of a rehearsed run along with the plan, by the id of its trace; null: no more."""

    do: Literal["show_trace"]
    trace: Annotated[str, Field(max_length=64)] | None


class Preview(StrictModel):
    """Have the 3D view show a plan by its id, that of a suggestion or a proposal; null: the document's own again."""

    do: Literal["preview"]
    plan: Annotated[str, Field(max_length=64)] | None


Command: TypeAlias = (
    Play
    | Pause
    | Seek
    | SetSpeed
    | SetTheme
    | SetLanguage
    | SetEffort
    | Choose
    | Stop
    | PlanAgain
    | LookLonger
    | PlanFrom
    | PlanFromState
    | Preview
    | ShowTrace
)
AnyCommand = Annotated[Command, Field(discriminator="do")]


class Edit(EditRequest):
    """Change the drawing."""

    do: Literal["edit"]


class PutGarment(GarmentRequest):
    """Put another garment in place of the one that is drawn."""

    do: Literal["put_garment"]


class PutRobot(RobotRequest):
    """Have another robot fold."""

    do: Literal["put_robot"]


class Undo(TravelRequest):
    """Undo the last step; without one nothing happens."""

    do: Literal["undo"]


class Redo(TravelRequest):
    """Redo the step undone last; without one nothing happens."""

    do: Literal["redo"]


class AskCrease(CreaseRequest):
    """Ask where a new fold would be."""

    do: Literal["crease"]


class AskSteps(StrictModel):
    """Ask for the layers before each legal fold, and after the last."""

    do: Literal["steps"]


class AskQuickFixes(StrictModel):
    """Ask for changes that remove the drawing's first problem."""

    do: Literal["quick_fixes"]


class AskPictures(StrictModel):
    """Ask for cloth and base before each step of a plan, and after the last."""

    do: Literal["pictures"]
    plan: Annotated[str, Field(max_length=64)]


class AskOverlays(StrictModel):
    """Ask for the overlays at a time of the plan (s), or with the robot at a station (m back from it).

    `show` names some of them, separated by commas; all by default.
    """

    do: Literal["overlays"]
    t_s: Annotated[float, Field(ge=0.0)] | None = None
    station: str | None = None
    back_off_m: float = 0.0
    show: str | None = None


class AskPlaces(PlacesRequest):
    """Ask for the cost of the plan at each placement."""

    do: Literal["places"]


class Drop(StrictModel):
    """Stop working on an answer, by the number of its question."""

    do: Literal["drop"]
    question: Annotated[int, Field(ge=0)]


Change: TypeAlias = Edit | PutGarment | PutRobot | Undo | Redo
Question: TypeAlias = AskCrease | AskSteps | AskQuickFixes | AskPictures | AskOverlays | AskPlaces
Sent: TypeAlias = Command | Change | Question | Drop
"""The messages that a page may send over its websocket."""

COMMANDS: JsonForm[Command] = JsonForm(cast("type[Command]", AnyCommand))
SENT: JsonForm[Sent] = JsonForm(cast("type[Sent]", Annotated[Sent, Field(discriminator="do")]))
