"""Routes of the server's health and of the default scene."""

from typing import Final

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool

from app.api.answers import Checks, Health
from app.api.asker import workspace_of
from app.distribution import own_version
from planner.task.scene import Scene

router = APIRouter(prefix="/api")

OK: Final = "ok"


@router.get("/health", response_model=Health, response_model_exclude_none=True)
async def read_health(request: Request) -> Health:
    """Return the server's state and version, and what of that on which it depends is well.

    The state is `degraded` if something is not; `problem` says what.
    """
    problems = await run_in_threadpool(workspace_of(request).problems)
    checks = Checks(**{name: problem or OK for name, problem in problems.items()})
    problem = next((problem for problem in problems.values() if problem), None)
    return Health(status="degraded" if problem else OK, version=own_version(), checks=checks, problem=problem)


@router.get("/scene")
async def read_scene() -> Scene:
    """Return the default scene."""
    return Scene()
