"""The shapes of garments, scenes and answers, for the description of the interface at /docs.

The planner makes and checks these values; nothing is validated here. The types of the page's JavaScript are made of
them, so tests hold what is sent against them, field by field.
"""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from planner.geometry.pose import Pose2
from planner.task.grip import BaseStop, Grip
from planner.task.plan import Statistics
from planner.task.scene import Scene

Point = tuple[float, float]
Point3 = tuple[float, float, float]


class Health(BaseModel):
    """How the server is, and which version; `problem` only where something is wrong."""

    status: Literal["ok", "degraded"]
    version: str
    problem: str | None = None


class GarmentFold(BaseModel):
    """A fold of a garment; what lies to the left of start -> end moves."""

    name: str
    kind: Literal["blue", "red"]
    start: Point
    end: Point
    grip_radius_m: float


class GarmentAnswer(BaseModel):
    """A garment as it is drawn, every field filled in; it may be one that cannot be."""

    name: str
    title: str
    outline: list[Point]
    areal_density_kg_m2: float
    folds: list[GarmentFold]
    grip_radius_m: float
    placement: Pose2


class GarmentEntry(BaseModel):
    """A garment in the list."""

    name: str
    title: str
    shipped: bool


class LayerAnswer(BaseModel):
    """A layer of the folded cloth, article frame (m)."""

    polygon: list[Point]
    face: Literal["front", "back"]


class DagAnswer(BaseModel):
    """The Fold-DAG, and the layers after all folds from bottom to top."""

    folds: int
    edges: list[tuple[int, int]]
    layers: list[LayerAnswer]


class StepPart(BaseModel):
    """What every primitive has: its time in the plan, where it leaves the base, and what the arms do."""

    start_s: float
    duration_s: float
    base: BaseStop
    grips: list[Grip]


class FoldPart(StepPart):
    """A fold, and whether the hands hold on after it."""

    kind: Literal["fold"]
    fold: int
    holds: bool


class DragPart(StepPart):
    """A drag towards the robot (m), and whether the hands hold on after it."""

    kind: Literal["drag"]
    distance_m: float
    holds: bool


class MovePart(StepPart):
    """A drive from one station to another, by way of poses of the base (m, rad)."""

    kind: Literal["move"]
    start: str = Field(alias="from")
    to: str
    waypoints: list[Point3]


PrimitiveAnswer = Annotated[FoldPart | DragPart | MovePart, Field(discriminator="kind")]


class DagPart(BaseModel):
    """The Fold-DAG of a plan."""

    folds: int
    edges: list[tuple[int, int]]


class Says(BaseModel):
    """A message as data: its code, and the named numbers of that code."""

    model_config = ConfigDict(extra="allow")

    code: str


class Change(BaseModel):
    """The fields of a plan request that a suggestion changes; the others stay."""

    garment: GarmentAnswer | None = None
    placement: Pose2 | None = None
    scene: Scene | None = None
    start_station: str | None = None
    comfort_radius_m: float | None = None


class ApproachAnswer(BaseModel):
    """How a hand is turned: where its fingers point, in the frame of the base, and how far below the horizontal."""

    heading_rad: float
    pitch_rad: float


class ReasonAnswer(BaseModel):
    """Why there is no plan.

    Points and directions are in the table frame (m), `approach` in that of the base. `point` is where it is with the
    cloth dragged by `offset_m`; `short_by_m` is but a lower bound where `is_at_least` is true. Reasons of one `set`
    must all be mended, `change` does it, and then there is what the set `gives`: a plan, at least the fold, or cloth
    that stays where it lies at the start.
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
    """A plan, or why there is none."""

    id: str
    status: Literal["solved", "infeasible", "budget_exceeded"]
    cost_s: float | None
    primitives: list[PrimitiveAnswer]
    dag: DagPart
    final_layers: list[LayerAnswer]
    final_placement: Pose2 | None
    reasons: list[ReasonAnswer]
    statistics: Statistics


class SampleAnswer(BaseModel):
    """The robot at one time."""

    t_s: float
    primitive: int
    base: Pose2
    torso_m: float
    joints: dict[str, float]
    grippers_m: dict[str, float]


class TimelineAnswer(BaseModel):
    """A plan's timeline, sampled."""

    rate_hz: float
    samples: list[SampleAnswer]
