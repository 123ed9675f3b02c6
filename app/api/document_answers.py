"""Response models of documents and their overlays, which describe the interface at /docs."""

from typing import Literal

from pydantic import BaseModel

from app.api.answers import GarmentAnswer, LayerAnswer, Point, Says
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
