"""Answers to what pages and programs ask about a document; none of them changes it."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from app import searches
from app.api.document_messages import AskOverlays, AskPictures, AskQuickFixes, AskSteps, CreaseRequest
from app.api.messages import PlacesRequest
from app.api.request_parsing import TimeLimit
from app.document_state import DocumentState
from app.drawing.place_crease import along_line, grab_and_drop
from app.drawing.quick_fixes import quick_fixes
from app.jobs.job_pool import JobPool
from app.open_document import OpenDocument
from app.overlays.moment import Moment, NoClothError, moment_as_drawn, moment_of_plan
from app.overlays.overlays import OVERLAYS, overlays
from app.worker.process import ignore
from app.worker.stop import Stop
from app.workspace import Workspace
from planner.errors import RequestError, SceneError
from planner.explain.suggestion_map import Cell
from planner.geometry.pose import Pose2
from planner.geometry.segment import Segment
from planner.task.plan import Plan
from planner.task.task import Task

Asked: TypeAlias = CreaseRequest | AskSteps | AskQuickFixes | AskPictures | AskOverlays | PlacesRequest


class Work(NamedTuple):
    """The work that answers a question, as JSON.

    Attributes:
        pool: the lane in which it is done.
        work: the work.
        begins_within_s: how long it may wait for its turn (s); None: as long as somebody waits for the answer.
    """

    pool: JobPool
    work: Callable[[Stop], Any]
    begins_within_s: float | None = None


def work_of(asked: Asked, workspace: Workspace, opened: OpenDocument) -> Work:
    """Return the work that answers a question about a document as it is now; raises an error for a bad question."""
    state, quick = opened.document.state, workspace.lanes.quick
    match asked:
        case CreaseRequest():
            return Work(quick, lambda _: _crease(state, asked))
        case AskSteps():
            return Work(quick, lambda _: {"version": state.version, "steps": state.solution.layers()})
        case AskQuickFixes():
            return Work(quick, lambda _: _quick_fixes(state))
        case AskPictures(plan=plan_id):
            return Work(quick, lambda _: pictures(workspace.plans.plan(plan_id)))
        case AskOverlays():
            time_s, shown = opened.document.t_s if asked.t_s is None else asked.t_s, _shown(asked)
            return Work(quick, lambda _: _overlays(state, time_s, asked, shown))
        case PlacesRequest():
            task, limit = state.task, TimeLimit(asked.time_limit_s)
            if task is None:
                raise NoClothError("The drawing is not finished, so no placement can be tried.")
            places = lambda stop: _places(workspace, state.version, task, asked, limit, stop)  # noqa: E731
            return Work(workspace.lanes.searches, places, limit.limit_s)


def pictures(plan: Plan) -> list[dict[str, Any]]:
    """Return cloth and base before each step of a plan and after the last."""
    worlds = [*(step.before for step in plan.steps), plan.end]
    return [
        {
            "layers": [layer.to_dict() for layer in plan.sequence.cloth(world.done).layers],
            "placement": world.placement.to_dict(),
            "base": world.base.to_dict(),
        }
        for world in worlds
    ]


def _crease(state: DocumentState, asked: CreaseRequest) -> dict[str, Any]:
    solution = state.solution
    if (asked.grab is None) == (asked.line is None):
        raise RequestError("grab", "a fold is asked for by either grab or line")
    if asked.grab is not None:
        (px, py), (qx, qy) = asked.grab.start, asked.grab.to
        return grab_and_drop(solution, asked.after, (px, py), (qx, qy), asked.kind).to_dict()
    assert asked.line is not None
    (ax, ay), (bx, by) = asked.line.start, asked.line.end
    if (ax, ay) == (bx, by):
        raise RequestError("line.end", "is the line's start")
    return along_line(solution, asked.after, Segment((ax, ay), (bx, by)), asked.kind).to_dict()


def _quick_fixes(state: DocumentState) -> dict[str, Any]:
    return {"version": state.version, "quick_fixes": [found.to_dict() for found in quick_fixes(state.draft)]}


def _shown(asked: AskOverlays) -> frozenset[str]:
    """Return the names of the overlays that are asked for."""
    if asked.t_s is not None and asked.station is not None:
        raise RequestError("station", "is asked for together with t_s")
    if asked.show is None:
        return frozenset(OVERLAYS)
    names = frozenset(name for name in asked.show.split(",") if name)
    unknown = sorted(names - set(OVERLAYS))
    if unknown:
        raise RequestError("show", f"expected one of {', '.join(OVERLAYS)}; got {unknown[0][:80]!r}")
    return names


def _overlays(state: DocumentState, time_s: float, asked: AskOverlays, shown: frozenset[str]) -> dict[str, Any]:
    moment: Moment
    if asked.station is None and state.shown is not None:
        moment = moment_of_plan(state, time_s)
    else:
        moment = moment_as_drawn(state, asked.station, asked.back_off_m)
    try:
        return overlays(state, moment, shown).model_dump()
    except SceneError as error:
        raise error.within("scene") from None


def _places(
    workspace: Workspace, version: int, task: Task, asked: PlacesRequest, limit: TimeLimit, stop: Stop
) -> dict[str, Any]:
    limits = replace(task.limits, time_limit_s=limit.left_s, work_limit_s=asked.work_limit_s)
    found = workspace.lanes.workers.run(searches.map_places, stop, ignore, replace(task, limits=limits), asked.step_m)
    here = task.start.placement
    return {
        "version": version,
        "step_m": found.step_m,
        "cells": [_place(cell, here) for cell in found.cells],
        "best": None if found.best is None else _place(found.best, here),
        "complete": found.is_complete,
    }


def _place(cell: Cell, here: Pose2) -> dict[str, Any]:
    """Return a cell as a displacement of the garment from where it lies now."""
    x, y = here.to_inner(np.array([cell.placement.x_m, cell.placement.y_m]))
    return {"move": [float(x), float(y)], "placement": cell.placement.to_dict(), "cost_s": cell.cost_s}
