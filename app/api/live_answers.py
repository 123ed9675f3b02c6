"""The shapes of what is sent over a document's websocket, either way, for the description of the interface."""

from typing import Literal

from pydantic import BaseModel, RootModel

from app.api.answers import PlanAnswer, Point
from app.api.document_answers import DocumentAnswer, PlaybackAnswer
from app.api.messages import Command
from planner.task.world_state import WorldState


class PlanOnShow(PlanAnswer):
    """A plan, and what it belongs to.

    `version` is the document's, `is_stale` whether that has gone on since, `is_final` whether no quicker one is looked
    for any more, `at_least_s` what any plan takes: null if that is known to be this one's cost.
    """

    version: int
    is_stale: bool
    is_final: bool
    at_least_s: float | None


class PlanBefore(BaseModel):
    """The figures of the plan before."""

    version: int
    status: Literal["solved", "infeasible", "budget_exceeded"]
    cost_s: float | None


class FoldCheck(BaseModel):
    """Which corners of a fold must be held, and where hands grip to hold them (m)."""

    must_hold: list[Point]
    grips: list[Point]
    grips_needed: int | None


class ChecksAnswer(BaseModel):
    """What must be held in each legal fold of a version."""

    version: int
    folds: list[FoldCheck]


class PlanMessage(BaseModel):
    """The answer to the drawing; while that is being planned, `plan` is the one before.

    `start` is the state from which the drawing is planned, null where that is before all folds, as drawn.
    """

    kind: Literal["plan"]
    version: int
    status: Literal["planning", "solved", "infeasible", "budget_exceeded", "illegal", "failed"]
    text: str
    plan: PlanOnShow | None
    may_look_longer: bool
    start: WorldState | None
    before: PlanBefore | None
    checks: ChecksAnswer | None


class Refusal(BaseModel):
    """A command that could not be obeyed."""

    kind: Literal["problem"]
    detail: str


class LiveMessage(RootModel[DocumentAnswer | PlanMessage | PlaybackAnswer | Refusal]):
    """What a page is told over the websocket."""


class LiveCommand(RootModel[Command]):
    """What a page may ask for over the websocket."""
