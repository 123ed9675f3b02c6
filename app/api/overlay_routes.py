"""Routes of overlays, which show on the board why a plan is as it is, and of the map of placements."""

from dataclasses import replace
from functools import partial
from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Depends, Query, Request
from fastapi.concurrency import run_in_threadpool
from starlette.responses import JSONResponse, Response

from app import searches
from app.api.body import JsonBody
from app.api.described import DescribedRoute, problems
from app.api.disconnect import answer_of, quick_answer
from app.api.messages import PlacesRequest
from app.api.overlay_answers import OverlaysAnswer, PlacesAnswer
from app.api.problems import ProblemResponse
from app.api.request_parsing import TimeLimit, workspace_of
from app.document_state import DocumentState
from app.overlays.moment import Moment, NoClothError, moment_as_drawn, moment_of_plan
from app.overlays.overlays import OVERLAYS, overlays
from app.worker.process import ignore
from app.worker.stop import Stop
from app.workspace import Workspace
from planner.errors import RequestError, SceneError
from planner.explain.suggestion_map import Cell
from planner.geometry.pose import Pose2

router = APIRouter(prefix="/api/documents/{document_id}/overlays", tags=["overlays"], route_class=DescribedRoute)

PlacesRequestBody = Annotated[
    PlacesRequest, Depends(JsonBody(PlacesRequest, {"step_m": 0.5, "time_limit_s": 2.0}, may_be_empty=True))
]

Time = Annotated[float | None, Query(ge=0.0, allow_inf_nan=False)]
BackOff = Annotated[float, Query(allow_inf_nan=False)]
Shown = Annotated[str | None, Query(description=f"some of {', '.join(OVERLAYS)}, separated by commas; all by default")]


@router.get("", responses={200: {"model": OverlaysAnswer}, **problems(404, 409, 422, 429, 503)})
async def read_overlays(
    request: Request,
    document_id: str,
    t_s: Time = None,
    station: str | None = None,
    back_off_m: BackOff = 0.0,
    show: Shown = None,
) -> Response:
    """Return reach, slip limits, the base's way and the paths of the hands at a time of the plan or at a station.

    By default they are those at the document's own time; without a plan, at the station where the robot starts.
    """
    opened = await run_in_threadpool(workspace_of(request).opened, document_id)
    shown = _shown(show)
    if t_s is not None and station is not None:
        raise RequestError("station", "is asked for together with t_s")
    time_s = opened.document.t_s if t_s is None else t_s
    state = opened.document.state
    try:
        return JSONResponse(await quick_answer(request, _overlays, state, time_s, station, back_off_m, shown))
    except NoClothError as error:
        return ProblemResponse(409, str(error))


@router.post(
    "/places",
    responses={200: {"model": PlacesAnswer}, **problems(404, 409, 413, 422, 429, 503)},
)
async def post_places(request: Request, document_id: str, wanted: PlacesRequestBody) -> Response:
    """Plan the document's garment wherever it could be laid, not turned, and return the costs."""
    opened = await run_in_threadpool(workspace_of(request).opened, document_id)
    state = opened.document.state
    if state.task is None:
        return ProblemResponse(409, "The drawing is not finished, so no placement can be tried.")
    limit = TimeLimit(wanted.time_limit_s)
    work = partial(_places, workspace_of(request), state, wanted, limit)
    with opened.in_use():
        return JSONResponse(await answer_of(request, workspace_of(request).lanes.searches, work, limit.limit_s))


def _shown(show: str | None) -> frozenset[str]:
    if show is None:
        return frozenset(OVERLAYS)
    names = frozenset(name for name in show.split(",") if name)
    unknown = sorted(names - set(OVERLAYS))
    if unknown:
        raise RequestError("show", f"expected one of {', '.join(OVERLAYS)}; got {unknown[0][:80]!r}")
    return names


def _overlays(
    state: DocumentState, time_s: float, station: str | None, back_off_m: float, shown: frozenset[str]
) -> dict[str, Any]:
    moment: Moment
    if station is None and state.shown is not None:
        moment = moment_of_plan(state, time_s)
    else:
        moment = moment_as_drawn(state, station, back_off_m)
    try:
        return overlays(state, moment, shown)
    except SceneError as error:
        raise error.within("scene") from None


def _places(
    workspace: Workspace, state: DocumentState, wanted: PlacesRequest, limit: TimeLimit, stop: Stop
) -> dict[str, Any]:
    assert state.task is not None, "what has no task is not planned"
    task = replace(
        state.task, limits=replace(state.task.limits, time_limit_s=limit.left_s, work_limit_s=wanted.work_limit_s)
    )
    found = workspace.lanes.workers.run(searches.map_places, stop, ignore, task, wanted.step_m)
    here = task.start.placement
    return {
        "version": state.version,
        "step_m": found.step_m,
        "cells": [_place(cell, here) for cell in found.cells],
        "best": None if found.best is None else _place(found.best, here),
        "complete": found.is_complete,
    }


def _place(cell: Cell, here: Pose2) -> dict[str, Any]:
    """Return a cell as a displacement of the garment from where it lies now."""
    x, y = here.to_inner(np.array([cell.placement.x_m, cell.placement.y_m]))
    return {"move": [float(x), float(y)], "placement": cell.placement.to_dict(), "cost_s": cell.cost_s}
