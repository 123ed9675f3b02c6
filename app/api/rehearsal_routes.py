"""Routes of rehearsals' traces: what became of the cloth in a run, for people to look at."""

from typing import Any

import numpy as np
from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from pydantic import BaseModel
from starlette.responses import JSONResponse

from app.api.answers import Point, Point3, Says
from app.api.asker import workspace_of
from app.api.described import DescribedRoute, answering
from app.rehearsal.trace import UNIT_M, Frames, RunTrace
from app.workspace import Workspace
from planner.geometry.pose import Pose2
from planner.task.world_state import WorldState

router = APIRouter(prefix="/api/rehearsals/traces", tags=["jobs"], route_class=DescribedRoute)


class OutlinesAnswer(BaseModel):
    """The silhouettes of the cloth after a step of the plan, as simulated and as planned, table frame (m)."""

    of_plan: int
    found: list[list[Point]]
    planned: list[list[Point]]


class StackFitAnswer(BaseModel):
    """Where a stack lies as seen; 95 of 100 corners are within `error_m` of where they are said to be."""

    placement: Pose2
    error_m: float
    residual_m: float
    share_on_outline: float
    share_seen: float
    overlap: float
    others: list[Pose2]
    known: bool
    reason: str | None
    says: Says | None


class CreaseAnswer(BaseModel):
    """How the last fold lies as seen: how far left of its line and turned, and creases how far inside of theirs."""

    offset_m: float
    turn_rad: float
    inset_m: float


class LookAnswer(BaseModel):
    """A picture that the robot took before step `of_plan` of the plan: a JPEG in base 64, outlines in its pixels.

    `fitted_px` is the outline fitted to what is seen, `expected_px` where it ought to lie. `start` is the state as
    seen, from which can be planned; null where it is not known where the stack lies, for a `reason` that `says` has as
    data.
    """

    step: int
    of_plan: int | None
    is_clear: bool
    size_px: tuple[int, int]
    jpeg: str
    fit: StackFitAnswer | None
    fitted_px: list[Point]
    expected_px: list[Point]
    known: bool
    reason: str | None
    says: Says | None
    crease: CreaseAnswer | None
    start: WorldState | None


class TraceAnswer(BaseModel):
    """The trace of a run: outlines after each judged step of the plan, and what the robot looked at."""

    steps: list[OutlinesAnswer]
    pictures: list[LookAnswer]


class ClothsAnswer(BaseModel):
    """The points of the cloth after a step of the plan, as simulated and as planned, table frame (m)."""

    of_plan: int
    found: list[Point3]
    planned: list[Point3]


class TraceClothAnswer(BaseModel):
    """The cloth of a run after each judged step of the plan, and the triangles between its points."""

    triangles: list[tuple[int, int, int]]
    steps: list[ClothsAnswer]


@router.get("/{trace_id}", responses=answering(TraceAnswer, 404))
async def read_trace(request: Request, trace_id: str) -> JSONResponse:
    """Return the outlines and pictures of a rehearsed run, by the `trace` of the run in the job's result.

    The newest are kept.
    """
    return JSONResponse(await run_in_threadpool(_trace, workspace_of(request), trace_id))


@router.get("/{trace_id}/cloth", responses=answering(TraceClothAnswer, 404))
async def read_trace_cloth(request: Request, trace_id: str) -> JSONResponse:
    """Return the points of the cloth after each judged step of a rehearsed run, to a tenth of a millimetre."""
    return JSONResponse(await run_in_threadpool(_cloth, workspace_of(request), trace_id))


def _trace(workspace: Workspace, trace_id: str) -> dict[str, Any]:
    trace = RunTrace.unpacked(workspace.traces.content(trace_id))
    return {"steps": [{"of_plan": step.of_plan, **step.outlines} for step in trace.steps], "pictures": trace.pictures}


def _cloth(workspace: Workspace, trace_id: str) -> dict[str, Any]:
    trace = RunTrace.unpacked(workspace.traces.content(trace_id))
    steps = [
        {"of_plan": step.of_plan, "found": _metres(step.found), "planned": _metres(step.planned)}
        for step in trace.steps
    ]
    return {"triangles": trace.triangles.tolist(), "steps": steps}


def _metres(positions: Frames) -> list[list[float]]:
    rows: list[list[float]] = np.round(UNIT_M * positions, 4).tolist()
    return rows
