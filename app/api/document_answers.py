"""Response models of documents and their overlays, which describe the interface at /docs."""

from typing import Literal

from pydantic import BaseModel

from app.api.answers import GarmentAnswer, LayerAnswer, Point, Point3, Says
from app.drawing.drawing import Drawing, End
from planner.geometry.pose import Pose2

Ring = list[Point]


class VersionAnswer(BaseModel):
    """A drawing that a document can go back to: the step that led to it, and when."""

    label: str
    changed_at: str
    drawing: Drawing


class SolvedFold(BaseModel):
    """A fold's legality, and its line on the cloth as it lies when its turn comes (m)."""

    fold: str
    status: Literal["legal", "illegal", "unchecked"]
    start: Point
    end: Point


class StepAnswer(BaseModel):
    """The cloth before a legal fold, or after the last, and what the fold moves (m)."""

    silhouette: list[Ring]
    flap: list[Ring]
    moving: list[Ring] | None
    landed: list[Ring] | None


class DrawingProblem(BaseModel):
    """A problem that keeps the drawing from being planned, and where the board shows it (m)."""

    code: str
    field: str
    message: str
    says: Says | None
    fold: int | None
    points: list[Point]
    lines: list[tuple[Point, Point]]


class HistoryAnswer(BaseModel):
    """The labels of the steps that undo and redo would take."""

    can_undo: str | None
    can_redo: str | None


class RobotPart(BaseModel):
    """The robot that folds: its arms by name, from left to right, and where its parts stand in the base frame (m)."""

    name: str
    title: str
    arms: list[str]
    base: Literal["fixed", "omni", "differential"]
    mounts: list[Point]


class DocumentAnswer(BaseModel):
    """A document: its drawing, the solved folds, the problems, and the history."""

    kind: Literal["document"]
    id: str
    version: int
    robot: RobotPart
    drawing: Drawing
    garment: GarmentAnswer
    solved: list[SolvedFold]
    steps: list[StepAnswer]
    problems: list[DrawingProblem]
    history: HistoryAnswer
    gesture: str | None


class PlaybackAnswer(BaseModel):
    """The playback clock; `version` is the one whose plan is played."""

    kind: Literal["playback"]
    version: int | None
    t_s: float
    duration_s: float
    playing: bool
    speed: float


class CreaseAnswer(BaseModel):
    """A fold that could be drawn: its ends, the cloth that moves, and where it lands (m)."""

    start: End
    end: End
    moving: list[Ring]
    landed: list[Ring]


class MovedLayerAnswer(LayerAnswer):
    """A layer, and whether the last fold moved it."""

    moved: bool


class LayersAnswer(BaseModel):
    """The layers at one moment, bottom to top."""

    layers: list[MovedLayerAnswer]


class StepsAnswer(BaseModel):
    """The layers before each legal fold and after the last."""

    version: int
    steps: list[LayersAnswer]


class QuickFixAnswer(BaseModel):
    """A change that removes a problem of a drawing: its label, and the drawing afterwards."""

    label: str
    says: Says
    drawing: Drawing


class QuickFixesAnswer(BaseModel):
    """The quick fixes of a drawing's first problem."""

    version: int
    quick_fixes: list[QuickFixAnswer]


class RegionAnswer(BaseModel):
    """A connected region (m)."""

    outer: Ring
    holes: list[Ring]


class RobotAnswer(BaseModel):
    """The base's pose (m, rad)."""

    station: str | None
    back_off_m: float
    pose: Pose2
    outline: Ring
    radius_m: float


class ReachAnswer(BaseModel):
    """The region in which an arm can take cloth on the table, within the comfort radius and without it (m)."""

    arm: str
    comfort_m: float
    regions: list[RegionAnswer]
    bare: list[RegionAnswer]


class LimitAnswer(BaseModel):
    """The line to which the cloth may hang over an edge of the table (m)."""

    edge: str
    line: tuple[Point, Point]
    at_m: float
    now_m: float


class SlipAnswer(BaseModel):
    """The cloth that hangs over the table's edges, and how much may (m^2, layers counted)."""

    friction: float
    pull_m2: float
    lying_m2: float
    hanging_m2: dict[str, float]
    holds: bool
    limits: list[LimitAnswer]


class StandAnswer(BaseModel):
    """The base's pose after a primitive (m, rad)."""

    primitive: int
    point: Point
    yaw_rad: float


class BaseWayAnswer(BaseModel):
    """The base's path, and how many of its points have been passed (m)."""

    way: list[Point]
    stands: list[StandAnswer]
    gone: int


class PathGripAnswer(BaseModel):
    """The path of one hand, seen from above and in space, with the height over the table (m)."""

    arm: str
    pick: Point
    apex: Point | None
    place: Point
    points: list[Point3]


class PathsAnswer(BaseModel):
    """The hands' paths of a primitive, in the article frame as the garment lies when the primitive begins."""

    primitive: int
    kind: str
    fold: int | None
    grips: list[PathGripAnswer]


class ShortfallAnswer(BaseModel):
    """The part of the surroundings of a point out of reach that the hand, in its orientation, cannot reach (m, rad).

    `beyond` is a part of a disc of `radius_m` at the point's height, `edge` the lines at which it ends; heading and
    pitch are in the base frame.
    """

    fold: int | None
    arm: str
    station: str
    back_off_m: float
    comfort_m: float
    point: Point3
    heading_rad: float
    pitch_rad: float
    radius_m: float
    beyond: list[RegionAnswer]
    edge: list[list[Point]]


class OverlaysAnswer(BaseModel):
    """The overlays at one moment, in the article frame as the garment lies then."""

    version: int
    plan_version: int | None
    t_s: float | None
    primitive: int | None
    done: list[int]
    fold_step: int | None
    placement: Pose2
    robot: RobotAnswer
    table: Ring
    reach: list[ReachAnswer] | None
    slip: SlipAnswer | None
    base: BaseWayAnswer | None
    paths: list[PathsAnswer] | None
    shortfall: ShortfallAnswer | None


class PlaceAnswer(BaseModel):
    """A placement, as a displacement of the garment (article frame, m), and the cost of the plan there (s)."""

    move: Point
    placement: Pose2
    cost_s: float | None


class PlacesAnswer(BaseModel):
    """The map of placements of a document; not complete when time ran out first."""

    version: int
    step_m: float
    cells: list[PlaceAnswer]
    best: PlaceAnswer | None
    complete: bool
