"""The files of studies that are done: report, table, times. They are asked for as jobs (`app.job_kinds.studies`)."""

import re
from typing import Annotated

from fastapi import APIRouter, Path, Request
from fastapi.concurrency import run_in_threadpool
from starlette.responses import FileResponse

from app.api.asked import workspace_of
from app.api.described import problems
from app.job_kinds.studies import STUDY_FILES
from app.studies.study_job import UnknownStudyError
from app.workspace import Workspace

router = APIRouter(prefix="/api/studies", tags=["studies"])

_ID = re.compile(r"[0-9a-f]{32}")
_SAFE = {"content-security-policy": "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'self'"}

FileName = Annotated[str, Path(json_schema_extra={"enum": list(STUDY_FILES)})]

_CONTENT: dict[str, dict[str, object]] = {media_type.partition(";")[0]: {} for media_type in STUDY_FILES.values()}


@router.get("/{study_id}/{file}", response_class=FileResponse, responses={200: {"content": _CONTENT}, **problems(404)})
async def read_study_file(request: Request, study_id: str, file: FileName) -> FileResponse:
    """Return a file of a study: `report.html`, `table.csv`, `table.parquet`, `timing.csv`."""
    return await run_in_threadpool(_file, workspace_of(request), study_id, file)


def _file(workspace: Workspace, study_id: str, file: str) -> FileResponse:
    path = workspace.folder.studies / study_id / file
    if not _ID.fullmatch(study_id) or file not in STUDY_FILES or not path.is_file():
        raise UnknownStudyError(study_id)
    return FileResponse(path, media_type=STUDY_FILES[file], headers=_SAFE)
