"""What clients send: the bodies of requests, and the page's commands."""

from typing import Annotated, Any, Literal, TypeAlias

from pydantic import Field, PlainValidator, TypeAdapter, WithJsonSchema
from pydantic_core import PydanticCustomError

from app.api.answers import GarmentFile, SceneFile
from app.api.described import whole_schema
from app.playback import SPEED_MAX, SPEED_MIN
from planner.cloth.garment import FOLDS_MAX
from planner.geometry.given import PlanePoint
from planner.strict_model import LARGEST_M, Bounded, StrictModel


def _name_or_object(value: Any) -> Any:  # noqa: ANN401
    if not isinstance(value, str | dict):
        raise PydanticCustomError("garment_type", "should be a garment's name or a garment")
    return value


def _object(value: Any) -> Any:  # noqa: ANN401
    if not isinstance(value, dict):
        raise PydanticCustomError("scene_type", "should be a scene")
    return value


GarmentField = Annotated[
    Any,
    PlainValidator(_name_or_object),
    WithJsonSchema({"anyOf": [{"type": "string"}, whole_schema(GarmentFile)]}),
]
SceneField = Annotated[Any, PlainValidator(_object), WithJsonSchema(whole_schema(SceneFile))]
TimeLimit = Annotated[float, Field(ge=0.01, le=60.0)]


class Placement(StrictModel):
    """A pose in the table frame (m, rad)."""

    x_m: Bounded
    y_m: Bounded
    yaw_rad: Annotated[float, Field(ge=-LARGEST_M, le=LARGEST_M)]


class DagRequest(StrictModel):
    """Asks which fold waits for which."""

    garment: GarmentField


class BaseField(StrictModel):
    """Where the base stands: at a station, backed off from it, or by its pose in the table frame (m, rad)."""

    station: str | None = None
    back_off_m: Annotated[float, Field(ge=0.0, le=LARGEST_M)] = 0.0
    x_m: Bounded | None = None
    y_m: Bounded | None = None
    yaw_rad: Bounded | None = None


class HeldField(StrictModel):
    """A point of the cloth that an arm holds, article frame (m)."""

    arm: str
    point: PlanePoint


class StartField(StrictModel):
    """The state of the world at the start; what is left out is as it is before all folds."""

    folds_done: Annotated[list[int], Field(max_length=FOLDS_MAX)] = Field(default_factory=list)
    placement: Placement | None = None
    base: BaseField | None = None
    held: Annotated[list[HeldField], Field(max_length=16)] = Field(default_factory=list)
    dragged_m: Annotated[float, Field(ge=0.0, le=LARGEST_M)] = 0.0


class PlanRequest(StrictModel):
    """Asks for a plan; only `garment` is required."""

    garment: GarmentField
    start: StartField | None = None
    placement: Placement | None = None
    scene: SceneField | None = None
    start_station: str = "front"
    robot: str = "pr2"
    comfort_radius_m: Annotated[float, Field(ge=0.0, le=0.1)] = 0.03
    heuristic: Literal["arm_time", "zero"] = "arm_time"
    time_limit_s: TimeLimit = 10.0
    work_limit_s: TimeLimit | None = None
    max_expanded: Annotated[int, Field(ge=1, le=1_000_000)] = 100_000


class PlacesRequest(StrictModel):
    """Asks what the plan costs wherever a garment could be laid."""

    step_m: Annotated[float, Field(ge=0.02, le=1.0)] = 0.1
    time_limit_s: TimeLimit = 10.0
    work_limit_s: TimeLimit | None = None


class PlacementsRequest(PlacesRequest):
    """Asks that of a garment on the default table."""

    garment: GarmentField


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
    """Let time run at another speed."""

    do: Literal["speed"]
    speed: Annotated[float, Field(ge=SPEED_MIN, le=SPEED_MAX)]


class SetTheme(StrictModel):
    """Show the stage on a dark ground or on a light one."""

    do: Literal["theme"]
    dark: bool


class Choose(StrictModel):
    """Take another garment."""

    do: Literal["choose"]
    garment: str


class Stop(StrictModel):
    """Stop planning; the next edit is planned again."""

    do: Literal["stop"]


class PlanAgain(StrictModel):
    """Plan what has no answer because planning was stopped or has failed."""

    do: Literal["plan"]


class LookLonger(StrictModel):
    """Do more work for a plan, or a quicker one, where the search ended before it came to its end."""

    do: Literal["look_longer"]


class PlanFrom(StrictModel):
    """Plan what is left after a step of the plan, counted from 0; null: plan from before all folds, as drawn."""

    do: Literal["plan_from"]
    step: Annotated[int, Field(ge=-1, le=10_000)] | None


Command: TypeAlias = Play | Pause | Seek | SetSpeed | SetTheme | Choose | Stop | PlanAgain | LookLonger | PlanFrom
COMMANDS: TypeAdapter[Command] = TypeAdapter(Annotated[Command, Field(discriminator="do")])
