"""The shapes of garments, scenes and answers, for the description of the interface at /docs.

The planner makes and checks these values; nothing is validated here. The types of the page's JavaScript are made of
them, so tests hold what is sent against them, field by field.
"""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Point = tuple[float, float]
Point3 = tuple[float, float, float]


class Health(BaseModel):
    """How the server is, and which version; `problem` only where something is wrong."""

    status: Literal["ok", "degraded"]
    version: str
    problem: str | None = None


class PoseFile(BaseModel):
    """A pose in the table frame (m, rad)."""

    x_m: float
    y_m: float
    yaw_rad: float


class FoldFile(BaseModel):
    """A fold; what lies to the left of start -> end moves."""

    name: str
    kind: Literal["blue", "red"]
    start: Point
    end: Point
    grip_radius_m: float | None = None


class GarmentFile(BaseModel):
    """A garment file."""

    name: str
    title: str | None = None
    outline: list[Point]
    areal_density_kg_m2: float = 0.2
    folds: list[FoldFile] = Field(default_factory=list)
    grip_radius_m: float = 0.127
    placement: PoseFile | None = None


class GarmentAnswer(GarmentFile):
    """A garment, every field filled in."""

    title: str
    folds: list[FoldFile]


class GarmentEntry(BaseModel):
    """A garment in the list."""

    name: str
    title: str
    shipped: bool


class TableFile(BaseModel):
    """A table (m)."""

    depth_m: float = 1.6
    width_m: float = 0.98
    height_m: float = 0.79


class SceneFile(BaseModel):
    """A scene; every field is optional, given stations replace the five."""

    table: TableFile = Field(default_factory=TableFile)
    stations: dict[str, PoseFile] = Field(default_factory=dict)
    torso_m: float = 0.29
    friction: float = 1.0
    support_angle_rad: float = 0.0873
    approach_cone_rad: float = 1.309
    back_off_max_m: float = 0.8
    edge_clear_m: float = 0.03
    arm_motion_s: float = 3.0
    grip_dwell_s: float = 0.5
    base_speed_m_s: float = 0.25
    base_turn_rad_s: float = 0.5


class SceneAnswer(SceneFile):
    """A scene, every field filled in."""

    table: TableFile
    stations: dict[str, PoseFile]


class LayerAnswer(BaseModel):
    """A layer of the folded cloth, article frame (m)."""

    polygon: list[Point]
    face: Literal["front", "back"]


class DagAnswer(BaseModel):
    """The Fold-DAG, and the layers after all folds from bottom to top."""

    folds: int
    edges: list[tuple[int, int]]
    layers: list[LayerAnswer]


class GripAnswer(BaseModel):
    """What one arm does: tool points in the table frame (m)."""

    arm: str
    pick: Point3
    apex: Point3 | None
    place: Point3


class BaseAnswer(PoseFile):
    """Where a primitive leaves the base."""

    station: str
    back_off_m: float


class StepPart(BaseModel):
    """What every primitive has: its time in the plan, where it leaves the base, and what the arms do."""

    start_s: float
    duration_s: float
    base: BaseAnswer
    grips: list[GripAnswer]


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
    placement: PoseFile | None = None
    scene: SceneAnswer | None = None
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


class StatisticsAnswer(BaseModel):
    """What the search did: counts, and times (s); `bound_s` is what any plan takes at least."""

    expanded: int
    explored: int
    ik_queries: int
    ik_time_s: float
    search_time_s: float
    joint_time_s: float
    bound_s: float | None
    ways: int
    is_cut_short: bool


class PlanAnswer(BaseModel):
    """A plan, or why there is none."""

    id: str
    status: Literal["solved", "infeasible", "budget_exceeded"]
    cost_s: float | None
    primitives: list[PrimitiveAnswer]
    dag: DagPart
    final_layers: list[LayerAnswer]
    final_placement: PoseFile | None
    reasons: list[ReasonAnswer]
    statistics: StatisticsAnswer


class SampleAnswer(BaseModel):
    """The robot at one time."""

    t_s: float
    primitive: int
    base: PoseFile
    torso_m: float
    joints: dict[str, float]
    grippers_m: dict[str, float]


class TimelineAnswer(BaseModel):
    """A plan's timeline, sampled."""

    rate_hz: float
    samples: list[SampleAnswer]
