"""Response models of documents and of the messages over their websockets, which describe the interface at /docs."""

from typing import Literal

from pydantic import BaseModel, RootModel

from app.api.answers import GarmentAnswer, LayerAnswer, PictureAnswer, PlanAnswer, Point, Says
from app.api.document_messages import Sent
from app.api.problems import Problem
from app.drawing.drawing import Drawing, End
from app.held_folds import FoldChecks
from app.overlays.overlays import OverlaysAnswer
from planner.geometry.pose import Pose2
from planner.task.world_state import WorldState

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
    """A placement, as a displacement of the garment (garment frame, m), and the cost of the plan there (s)."""

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


class PlanOnShow(PlanAnswer):
    """A plan that the page shows, with the version it belongs to.

    `version` is the document's, `is_stale` whether the document has changed since, `is_final` whether the search for a
    quicker plan has ended, `at_least_s` a lower bound on the cost of any plan: null if this one is known to be optimal.
    """

    version: int
    is_stale: bool
    is_final: bool
    at_least_s: float | None


class PlanBefore(BaseModel):
    """The figures of the previous plan."""

    version: int
    status: Literal["solved", "infeasible", "budget_exceeded"]
    cost_s: float | None


class PlanMessage(BaseModel):
    """The answer to the drawing; while it is being planned, `plan` is the previous one.

    `start` is the state from which the drawing is planned, null if that is before all folds, as drawn.
    """

    kind: Literal["plan"]
    version: int
    status: Literal["planning", "solved", "infeasible", "budget_exceeded", "illegal", "failed"]
    text: str
    plan: PlanOnShow | None
    prepared: float | None
    is_compiling: bool
    may_look_longer: bool
    start: WorldState | None
    before: PlanBefore | None
    checks: FoldChecks | None


class Result(BaseModel):
    """The answer to what the page has sent with a number, `ask`.

    `version` is the one that a change has made, `result` the answer to a question; null for a change.
    """

    kind: Literal["answer"]
    ask: int
    version: int
    result: CreaseAnswer | StepsAnswer | QuickFixesAnswer | OverlaysAnswer | PlacesAnswer | list[PictureAnswer] | None


class Refusal(Problem):
    """A refusal: the problem, and the number of the page's message, null if it has no number."""

    kind: Literal["problem"]
    ask: int | None


class LiveMessage(RootModel[DocumentAnswer | PlanMessage | PlaybackAnswer | Result | Refusal]):
    """A message to the page over the websocket."""


class LiveCommand(RootModel[Sent]):
    """What the page sends over the websocket; with a number, `ask`, it is answered with the same number."""
