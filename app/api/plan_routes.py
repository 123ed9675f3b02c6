"""Routes of plans: making one, reading it again, its timeline; and the Fold-DAG alone."""

import json
from functools import partial
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Query, Request
from fastapi.concurrency import run_in_threadpool
from starlette.responses import JSONResponse, Response

from app import searches
from app.api.answers import DagAnswer, PictureAnswer, PlanAnswer, TimelineAnswer
from app.api.asker import workspace_of
from app.api.body import JsonBody, read_object
from app.api.described import DescribedRoute, answering, problems
from app.api.disconnect import answer_of, quick_answer
from app.api.messages import DagRequest, PlanRequest
from app.api.questions import pictures
from app.api.request_parsing import TimeLimit, requested_garment, requested_task, within_request
from app.files.import_file import LARGEST_PLAN_FILE
from app.worker.process import ignore
from app.worker.stop import Stop
from app.workspace import Workspace
from planner import Plan, Timeline, fold_dag
from planner.errors import UnsolvedPlanError
from planner.task.task import Task

router = APIRouter(prefix="/api", tags=["plans"], route_class=DescribedRoute)

DagRequestBody = Annotated[DagRequest, Depends(JsonBody(DagRequest, {"garment": "t-shirt"}))]
PlanRequestBody = Annotated[PlanRequest, Depends(JsonBody(PlanRequest, {"garment": "hand-towel"}))]

PLAN_FILE_TYPE = "application/vnd.pleat.plan+json"

_PLAN_FILE = {
    "type": "object",
    "properties": {"pleat_plan": {"type": "integer", "minimum": 1}},
    "required": ["pleat_plan"],
}

_PLAN_FILE_BODY = {
    "requestBody": {
        "required": True,
        "content": {kind: {"schema": _PLAN_FILE} for kind in ("application/json", PLAN_FILE_TYPE)},
    }
}

SampleRate = Annotated[float, Query(ge=1.0, le=200.0, allow_inf_nan=False)]


@router.post("/dag", responses=answering(DagAnswer, 404, 413, 422, 503))
async def post_dag(request: Request, wanted: DagRequestBody) -> JSONResponse:
    """Return the Fold-DAG, and the layers after all folds."""
    return JSONResponse(await quick_answer(request, _dag, workspace_of(request), wanted))


@router.post("/plans", responses=answering(PlanAnswer, 404, 413, 422, 503))
async def post_plan(request: Request, wanted: PlanRequestBody) -> Response:
    """Plan a garment; "there is no plan" is an answer, too.

    The time limit runs from the arrival of the request. Answers 503 if it passes before the request's turn comes.
    """
    workspace, limit = workspace_of(request), TimeLimit(wanted.time_limit_s)
    work = partial(_plan, workspace, wanted, limit)
    answer = await answer_of(request, workspace.lanes.searches, work, limit.limit_s)
    return Response(answer, media_type="application/json")


@router.post("/plans/imports", openapi_extra=_PLAN_FILE_BODY, responses=answering(PlanAnswer, 413, 422, 503))
async def post_plan_file(request: Request) -> JSONResponse:
    """Import a plan file: replay it and keep it under a new id.

    Refuses a plan that does not replay; the problem names the step at which it fails.
    """
    data = await read_object(request, most=LARGEST_PLAN_FILE)
    workspace = workspace_of(request)
    return JSONResponse(await answer_of(request, workspace.lanes.files, partial(_imported, workspace, data)))


@router.get(
    "/plans/{plan_id}", responses={200: {"model": PlanAnswer, "content": {PLAN_FILE_TYPE: {}}}, **problems(404)}
)
async def read_plan(request: Request, plan_id: str) -> Response:
    """Return a plan made before; with task and trajectory, as a plan file, if `Accept` asks for that."""
    plan = await _kept(request, plan_id)
    if PLAN_FILE_TYPE in request.headers.get("accept", ""):
        return await _plan_file(plan)
    return JSONResponse(await run_in_threadpool(plan_answer, plan_id, plan), headers={"Vary": "Accept"})


@router.get(
    "/plans/{plan_id}/file",
    response_class=Response,
    responses={200: {"content": {PLAN_FILE_TYPE: {}}}, **problems(404)},
)
async def read_plan_file(request: Request, plan_id: str) -> Response:
    """Return a plan made before as a plan file: with its task and its trajectory."""
    return await _plan_file(await _kept(request, plan_id))


@router.get("/plans/{plan_id}/timeline", responses=answering(TimelineAnswer, 404, 409, 422, 503))
async def read_timeline(request: Request, plan_id: str, rate_hz: SampleRate = 30.0) -> Response:
    """Return a solved plan's timeline, sampled from 0 to its end."""
    plan = await _kept(request, plan_id)
    if plan.status != "solved":
        raise UnsolvedPlanError(plan.status)
    sampled = await answer_of(request, workspace_of(request).lanes.files, partial(_timeline, plan, rate_hz))
    return Response(sampled, media_type="application/json")


@router.get("/plans/{plan_id}/pictures", responses=answering(list[PictureAnswer], 404))
async def read_pictures(request: Request, plan_id: str) -> JSONResponse:
    """Return cloth and base before each step of a plan and after the last, as seen from above."""
    return JSONResponse(await run_in_threadpool(pictures, await _kept(request, plan_id)))


def plan_answer(plan_id: str, plan: Plan) -> dict[str, Any]:
    """Return a plan in its REST form."""
    return {"id": plan_id, **plan.answer()}


async def _kept(request: Request, plan_id: str) -> Plan:
    """Return a plan by its id; it may have to be read and unpacked, so other requests go on meanwhile."""
    return await run_in_threadpool(workspace_of(request).plans.plan, plan_id)


async def _plan_file(plan: Plan) -> Response:
    """Return a plan as a file to save."""
    text = await run_in_threadpool(lambda: json.dumps(plan.to_dict()))
    name = f'attachment; filename="{plan.garment.name}.plan.json"'
    return Response(text, media_type=PLAN_FILE_TYPE, headers={"Content-Disposition": name, "Vary": "Accept"})


def _imported(workspace: Workspace, data: dict[str, Any], stop: Stop) -> dict[str, Any]:
    plan = workspace.lanes.workers.run_alone(searches.read_plan, stop, ignore, data)
    return plan_answer(workspace.plans.add(plan), plan)


def _dag(workspace: Workspace, wanted: DagRequest) -> dict[str, Any]:
    garment = requested_garment(workspace, wanted.garment)
    with within_request():
        answer: dict[str, Any] = fold_dag(garment).to_dict()
    return answer


def _plan(workspace: Workspace, wanted: PlanRequest, limit: TimeLimit, stop: Stop) -> bytes:
    task = requested_task(workspace, wanted, limit)
    with within_request():
        return planned(workspace, task, stop)


def planned(workspace: Workspace, task: Task, stop: Stop) -> bytes:
    """Plan a task in a worker unless its answer is known, keep the plan, and return it in its REST form, as JSON."""
    packed = workspace.plans.answers.get(task)
    if packed is None:
        packed = workspace.lanes.workers.run(searches.plan, stop, ignore, task)
        workspace.plans.answers.add(task, packed)
    return b'{"id":"%b",%b' % (workspace.plans.add_packed(packed).encode(), packed.answer.removeprefix(b"{"))


def _timeline(plan: Plan, rate_hz: float, should_stop: Stop) -> bytes:
    """Yield the timeline as JSON, sample by sample, so that other threads get their turn in between."""
    samples = []
    for frame in Timeline.of(plan).samples(rate_hz):
        samples.append(json.dumps(frame.to_dict()))
        if should_stop():
            break
    return f'{{"rate_hz": {json.dumps(rate_hz)}, "samples": [{", ".join(samples)}]}}'.encode()
