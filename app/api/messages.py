"""The bodies of requests for plans and of what belongs to them."""

from dataclasses import dataclass
from typing import Annotated, Any

from annotated_types import Interval
from pydantic import ConfigDict, Field, PlainValidator
from pydantic_core import PydanticCustomError

from planner.cloth.garment import FOLDS_MAX, Garment
from planner.cloth.garment_files import garment_in
from planner.geometry.given import GivenPose
from planner.planning.robot_task import with_robots_scene
from planner.strict_model import LARGEST_M, Bounded, StrictModel
from planner.task.scene import Scene
from planner.task.task import DEFAULT_ROBOT, TIME_LIMIT_S, Limits
from planner.task.world_state import HeldPoint


def gives(**types: str) -> dict[str, Any]:
    """Return the schema of objects that have these fields, each of a JSON type and not null."""
    return {"properties": {name: {"type": kind} for name, kind in types.items()}, "required": list(types)}


def leaves_out(*names: str) -> dict[str, Any]:
    """Return the schema of objects in which these fields are null or left out."""
    return {"properties": {name: {"type": "null"} for name in names}}


def either(*conditions: dict[str, Any]) -> dict[str, Any]:
    """Return the schema's addition that requires at least one of these conditions."""
    return {"anyOf": list(conditions)}


def _garment(value: Any) -> str | Garment:  # noqa: ANN401
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        return garment_in(value)
    raise PydanticCustomError("garment_type", "should be a garment's name or a garment")


GarmentField = Annotated[str | Garment, PlainValidator(_garment, json_schema_input_type=str | Garment)]
WholeGarment = Annotated[Garment, PlainValidator(garment_in, json_schema_input_type=Garment)]
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
