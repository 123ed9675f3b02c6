"""Response models of garments, scenes and plans, which describe the interface at /docs.

The planner makes and checks these values; nothing is validated here. The types of the page's JavaScript are
generated from them, so tests compare what is sent with them, field by field.
"""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from planner.cloth.fold_kinds import FoldName
from planner.geometry.pose import Pose2
from planner.task.plan import Statistics
from planner.task.scene import Scene
from planner.task.world_state import BaseStop, Grip

Point = tuple[float, float]
Point3 = tuple[float, float, float]


class Checks(BaseModel):
    """The state of each part of the server: `ok`, or its fault. The workers load for some seconds after the start."""

    disk: str
    database: str
    workers: str


class Health(BaseModel):
    """The server's state and version; `problem` is there only when something is wrong."""

    status: Literal["ok", "degraded"]
    version: str
    checks: Checks
    problem: str | None = None


class GarmentFold(BaseModel):
    """A fold of a garment; the cloth to the left of start -> end moves."""

    name: str
    kind: FoldName
    start: Point
    end: Point
    grip_radius_m: float


class GarmentAnswer(BaseModel):
    """A garment as it is drawn, every field filled in; it may break the rules for garments."""

    name: str
    title: str
    outline: list[Point]
    areal_density_kg_m2: float
    thickness_m: float
    folds: list[GarmentFold]
    grip_radius_m: float
    placement: Pose2


class RobotEntry(BaseModel):
    """A robot in the list; its arms from left to right."""

    name: str
    title: str
    arms: list[str]
    base: Literal["fixed", "omni", "differential"]
    shipped: bool


class DraftAnswer(BaseModel):
    """What was guessed of a drafted robot, and what only its owner knows, a sentence each."""

    guesses: list[str]
    unknown: list[str]


class RobotTaken(RobotEntry):
    """A robot that was imported; `draft` is there if its card was drafted."""

    draft: DraftAnswer | None = None


class LayerAnswer(BaseModel):
    """A layer of the folded cloth, garment frame (m)."""

    polygon: list[Point]
    face: Literal["front", "back"]


class DagPart(BaseModel):
    """The Fold-DAG of a plan."""

    folds: int
    edges: list[tuple[int, int]]


class DagAnswer(DagPart):
    """The Fold-DAG, and the layers after all folds from bottom to top."""

    layers: list[LayerAnswer]


class StepPart(BaseModel):
    """The fields of every primitive: its time in the plan, where it leaves the base, and the arms' grips."""

    start_s: float
    duration_s: float
    base: BaseStop
    grips: list[Grip]


class FoldPart(StepPart):
    """A fold, and whether the hands keep their grip after it."""

    kind: Literal["fold"]
    fold: int
    holds: bool


class DragPart(StepPart):
    """A drag towards the robot (m), and whether the hands keep their grip after it."""

    kind: Literal["drag"]
    distance_m: float
    holds: bool


class ArmDragPart(StepPart):
    """A drag by the arms while the base stands (m), and its direction in the table frame (rad)."""

    kind: Literal["arm_drag"]
    distance_m: float
    heading_rad: float
    holds: bool


class MovePart(StepPart):
    """A drive from one station to another, with the poses of the base in between (m, rad)."""

    kind: Literal["move"]
    start: str = Field(alias="from")
    to: str
    waypoints: list[Point3]


PrimitiveAnswer = Annotated[FoldPart | DragPart | ArmDragPart | MovePart, Field(discriminator="kind")]


class Says(BaseModel):
    """A message as data: its code and the named numbers that belong to the code."""

    model_config = ConfigDict(extra="allow")

    code: str


class Change(BaseModel):
    """The fields of a plan request that a suggestion changes; all others stay."""

    garment: GarmentAnswer | None = None
    placement: Pose2 | None = None
    scene: Scene | None = None
    start_station: str | None = None
    comfort_radius_m: float | None = None
    robot: str | None = None


class ApproachAnswer(BaseModel):
    """A hand's orientation: the direction of its fingers in the base frame, and its pitch below the horizontal."""

    heading_rad: float
    pitch_rad: float


class ReasonAnswer(BaseModel):
    """A reason why there is no plan.

    Points and directions are in the table frame (m), `approach` in that of the base. `point` is given with the
    cloth dragged by `offset_m`; `short_by_m` is only a lower bound where `is_at_least` is true. Reasons of one `set`
    must all be fixed together, and `change` does so. `gives` says what that achieves: a plan, at least the fold, or
    cloth that stays where it lies at the start.
    """

    fold: int | None
    code: str
    message: str
    says: Says
    cause: str | None
    joint: str | None
    point: Point3 | None
    short_by_m: float | None
    is_at_least: bool
    towards: Point3 | None
    arm: str | None
    station: str | None
    back_off_m: float | None
    approach: ApproachAnswer | None
    offset_m: Point | None
    shift_m: float | None
    shift_towards: Point3 | None
    comfort_m: float | None
    needed_friction: float | None
    needed_grip_radius_m: float | None
    set: int | None
    gives: Literal["plan", "fold", "start"] | None
    change: Change | None


class PlanAnswer(BaseModel):
    """A plan, or the reasons why there is none."""

    id: str
    status: Literal["solved", "infeasible", "budget_exceeded"]
    cost_s: float | None
    primitives: list[PrimitiveAnswer]
    dag: DagPart
    final_layers: list[LayerAnswer]
    final_placement: Pose2 | None
    reasons: list[ReasonAnswer]
    statistics: Statistics


class PictureAnswer(BaseModel):
    """Cloth and base between two steps, from above: layers in the garment frame (m), bottom to top."""

    layers: list[LayerAnswer]
    placement: Pose2
    base: BaseStop


class SampleAnswer(BaseModel):
    """The robot at one moment."""

    t_s: float
    primitive: int
    base: Pose2
    torso_m: float
    joints: dict[str, float]
    grippers_m: dict[str, float]


class TimelineAnswer(BaseModel):
    """A plan's timeline, sampled at an even rate."""

    rate_hz: float
    samples: list[SampleAnswer]
