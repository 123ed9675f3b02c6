"""The bodies of requests, and the page's commands."""

from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeAlias, cast

from annotated_types import Interval
from pydantic import ConfigDict, Field, PlainValidator
from pydantic_core import PydanticCustomError

from app.api.conditions import either, gives
from app.language import Language
from app.playback import SPEED_MAX, SPEED_MIN
from planner.cloth.garment import FOLDS_MAX, Garment
from planner.geometry.given import GivenPose
from planner.json_form import JsonForm
from planner.planning.robot_task import with_robots_scene
from planner.strict_model import LARGEST_M, Bounded, StrictModel
from planner.task.scene import Scene
from planner.task.task import DEFAULT_ROBOT, TIME_LIMIT_S, Limits
from planner.task.world_state import HeldPoint


def _garment(value: Any) -> str | Garment:  # noqa: ANN401
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        return Garment.from_dict(value)
    raise PydanticCustomError("garment_type", "should be a garment's name or a garment")


GarmentField = Annotated[str | Garment, PlainValidator(_garment, json_schema_input_type=str | Garment)]
WholeGarment = Annotated[Garment, PlainValidator(Garment.from_dict, json_schema_input_type=Garment)]
TimeLimit = Annotated[float, Interval(ge=TIME_LIMIT_S[0], le=TIME_LIMIT_S[1])]


class DagRequest(StrictModel):
    """A request for the Fold-DAG of a garment."""

    garment: GarmentField


class BaseField(StrictModel):
    """The base's place: at a station, at a standoff from it, or at a pose in the table frame (m, rad)."""

    model_config = ConfigDict(
        json_schema_extra=either(gives(station="string"), gives(x_m="number", y_m="number", yaw_rad="number"))
    )

    station: str | None = None
    back_off_m: Annotated[float, Field(ge=0.0, le=LARGEST_M)] = 0.0
    x_m: Bounded | None = None
    y_m: Bounded | None = None
    yaw_rad: Bounded | None = None


class StartField(StrictModel):
    """The state of the world at the start; fields left out are as before all folds."""

    folds_done: Annotated[tuple[int, ...], Field(max_length=FOLDS_MAX)] = ()
    placement: GivenPose | None = None
    base: BaseField | None = None
    held: Annotated[tuple[HeldPoint, ...], Field(max_length=16)] = ()
    dragged_m: Annotated[float, Field(ge=0.0, le=LARGEST_M)] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanRequest(Limits):
    """A request for a plan; only `garment` is required."""

    garment: GarmentField
    start: StartField | None = None
    placement: GivenPose | None = None
    scene: Scene | None = None
    start_station: str | None = None
    robot: str = DEFAULT_ROBOT
    work_limit_s: TimeLimit | None = None

    @staticmethod
    def completed(data: object) -> object:
        """Return a request's JSON with a scene that is given in part filled up by that of the robot."""
        return with_robots_scene(data)


class PlacesRequest(StrictModel):
    """A request for the cost of the plan at every placement of the garment."""

    step_m: Annotated[float, Field(ge=0.02, le=1.0)] = 0.1
    time_limit_s: TimeLimit = 10.0
    work_limit_s: TimeLimit | None = None


class PlacementsRequest(PlacesRequest):
    """A request for the cost of the plan at every placement of a garment on the default table."""

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
    """Have the 3D view show a plan by its id, that of a suggestion; null: the document's own again."""

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
COMMANDS: JsonForm[Command] = JsonForm(cast("type[Command]", AnyCommand))
