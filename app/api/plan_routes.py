"""Plans: asking for one, reading it again, its timeline; and the Fold-DAG alone."""

import json
from functools import partial
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request
from fastapi.concurrency import run_in_threadpool
from starlette.responses import JSONResponse, Response

from app.api.answers import DagAnswer, PlanAnswer, TimelineAnswer
from app.api.asked import asked_garment, asked_scene, workspace_of
from app.api.body import read_model
from app.api.described import problems, takes
from app.api.messages import DagRequest, PlanRequest
from app.api.waiting import answer_of
from app.job_pool import ShouldStop
from app.workspace import Workspace
from planner import fold_dag, make_plan
from planner.errors import FoldError, GarmentError, SceneError, UnsolvedPlanError
from planner.geometry.pose import Pose2
from planner.plan.plan import Plan

router = APIRouter(prefix="/api", tags=["plans"])

SampleRate = Annotated[float, Query(ge=1.0, le=200.0, allow_inf_nan=False)]


@router.post("/dag", openapi_extra=takes(DagRequest), responses={200: {"model": DagAnswer}, **problems(404, 413, 422)})
async def post_dag(request: Request) -> JSONResponse:
    """Which fold waits for which, and the layers after all of them."""
    wanted = await read_model(request, DagRequest)
    workspace = workspace_of(request)
    job = workspace.pool.start(lambda _: _dag(workspace, wanted))
    return JSONResponse(await answer_of(request, job))


@router.post(
    "/plans",
    openapi_extra=takes(PlanRequest),
    responses={200: {"model": PlanAnswer}, **problems(404, 413, 422)},
)
async def post_plan(request: Request) -> JSONResponse:
    """Plan; "there is no plan" is an answer, too."""
    wanted = await read_model(request, PlanRequest)
    workspace = workspace_of(request)
    job = workspace.pool.start(partial(_plan, workspace, wanted))
    return JSONResponse(await answer_of(request, job))


@router.get("/plans/{plan_id}", responses={200: {"model": PlanAnswer}, **problems(404)})
async def read_plan(request: Request, plan_id: str) -> JSONResponse:
    """A plan made before."""
    plan = workspace_of(request).plans.plan(plan_id)
    return JSONResponse(await run_in_threadpool(plan_answer, plan_id, plan))


@router.get(
    "/plans/{plan_id}/timeline",
    responses={200: {"model": TimelineAnswer}, **problems(404, 409, 422)},
)
async def read_timeline(request: Request, plan_id: str, rate_hz: SampleRate = 30.0) -> Response:
    """A solved plan's timeline, sampled from 0 to its end."""
    workspace = workspace_of(request)
    plan = workspace.plans.plan(plan_id)
    if plan.status != "solved":
        raise UnsolvedPlanError(plan.status)
    job = workspace.pool.start(partial(_timeline, plan, rate_hz))
    return Response(await answer_of(request, job), media_type="application/json")


def plan_answer(plan_id: str, plan: Plan) -> dict[str, Any]:
    """A plan as the interface has it."""
    return {"id": plan_id, **plan.to_dict()}


def _dag(workspace: Workspace, wanted: DagRequest) -> dict[str, Any]:
    garment = asked_garment(workspace, wanted.garment)
    try:
        answer: dict[str, Any] = fold_dag(garment).to_dict()
    except (FoldError, GarmentError) as error:
        raise error.within("garment") from None
    return answer


def _plan(workspace: Workspace, wanted: PlanRequest, should_stop: ShouldStop) -> dict[str, Any]:
    garment = asked_garment(workspace, wanted.garment)
    scene = asked_scene(wanted.scene)
    placed = wanted.placement
    try:
        plan = make_plan(
            garment,
            scene,
            placement=Pose2(placed.x_m, placed.y_m, placed.yaw_rad) if placed else None,
            start_station=wanted.start_station,
            robot=wanted.robot,
            comfort_radius_m=wanted.comfort_radius_m,
            heuristic=wanted.heuristic,
            time_limit_s=wanted.time_limit_s,
            max_expanded=wanted.max_expanded,
            should_stop=should_stop,
        )
    except (FoldError, GarmentError) as error:
        raise error.within("garment") from None
    except SceneError as error:
        raise error.within("scene") from None
    return plan_answer(workspace.plans.add(plan), plan)


def _timeline(plan: Plan, rate_hz: float, should_stop: ShouldStop) -> bytes:
    """The timeline as JSON, sample by sample: another thread gets its turn in between."""
    samples = []
    for frame in plan.timeline().samples(rate_hz):
        samples.append(json.dumps(frame.to_dict()))
        if should_stop():
            break
    return f'{{"rate_hz": {json.dumps(rate_hz)}, "samples": [{", ".join(samples)}]}}'.encode()
