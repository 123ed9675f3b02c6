"""Studies that are done: their report and tables, and the plans of their cells.

They are asked for as jobs (`app.job_kinds.studies`).
"""

import json
from functools import partial
from typing import Annotated

from fastapi import APIRouter, Path, Request
from fastapi.concurrency import run_in_threadpool
from starlette.responses import Response

from app.api.answers import PlanAnswer
from app.api.asker import workspace_of
from app.api.described import DescribedRoute, answering, problems
from app.api.disconnect import answer_of
from app.api.plan_routes import planned
from app.job_kinds.studies import STUDY_FILES
from app.store.study_store import UnknownStudyError
from app.studies.study import Study
from app.worker.stop import Stop
from app.workspace import Workspace
from planner.errors import RequestError

router = APIRouter(prefix="/api/studies", tags=["studies"], route_class=DescribedRoute)

_SAFE = {"content-security-policy": "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'self'"}

FileName = Annotated[str, Path(json_schema_extra={"enum": list(STUDY_FILES)})]

_CONTENT: dict[str, dict[str, object]] = {media_type.partition(";")[0]: {} for media_type in STUDY_FILES.values()}


@router.get("/{study_id}/{file}", response_class=Response, responses={200: {"content": _CONTENT}, **problems(404)})
async def read_study_file(request: Request, study_id: str, file: FileName) -> Response:
    """Return a file of a study: `report.html`, `table.csv`, `table.parquet`, `timing.csv`."""
    if file not in STUDY_FILES:
        raise UnknownStudyError(study_id)
    content = await run_in_threadpool(workspace_of(request).study_store.file, study_id, file)
    return Response(content, media_type=STUDY_FILES[file], headers=_SAFE)


@router.post("/{study_id}/cells/{cell}/plan", response_class=Response, responses=answering(PlanAnswer, 404, 422, 503))
async def post_cell_plan(request: Request, study_id: str, cell: Annotated[int, Path(ge=0, examples=[0])]) -> Response:
    """Make the plan of a cell again, by its number in the table; it is kept as those of `POST /api/plans` are."""
    workspace = workspace_of(request)
    answer = await answer_of(request, workspace.lanes.searches, partial(_plan, workspace, study_id, cell))
    return Response(answer, media_type="application/json")


def _plan(workspace: Workspace, study_id: str, cell: int, stop: Stop) -> bytes:
    study = Study.from_dict(json.loads(workspace.study_store.content(study_id)))
    if cell >= study.product:
        raise RequestError("cell", f"is {cell}, but the study's cells are 0 to {study.product - 1}")
    found = study.cell(cell)
    if found.task is None:
        raise RequestError("cell", f"has no plan: {found.error}")
    return planned(workspace, found.task, stop)
