"""Models of the messages over a document's websocket, both ways, for the description of the interface."""

from typing import Literal

from pydantic import BaseModel, RootModel

from app.api.answers import PictureAnswer, PlanAnswer
from app.api.document_answers import (
    CreaseAnswer,
    DocumentAnswer,
    PlacesAnswer,
    PlaybackAnswer,
    QuickFixesAnswer,
    StepsAnswer,
)
from app.api.document_messages import Sent
from app.api.problems import Problem
from app.held_folds import FoldChecks
from app.overlays.overlays import OverlaysAnswer
from planner.task.world_state import WorldState


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
