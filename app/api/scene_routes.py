"""Routes of the server's health and of the default scene."""

from importlib.metadata import PackageNotFoundError, version

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool

from app.api.answers import Health
from app.api.asked import workspace_of
from planner.task.scene import Scene

router = APIRouter(prefix="/api")


@router.get("/health", response_model=Health, response_model_exclude_none=True)
async def read_health(request: Request) -> Health:
    """Return the server's state and version.

    The state is `degraded` if nothing can be saved; `problem` says why.
    """
    problem = await run_in_threadpool(workspace_of(request).folder.problem)
    return Health(status="degraded" if problem else "ok", version=own_version(), problem=problem)


@router.get("/scene")
async def read_scene() -> Scene:
    """Return the default scene."""
    return Scene()


def own_version() -> str:
    """Return Pleat's version, as it is installed."""
    try:
        return version("pleat")
    except PackageNotFoundError:
        return "0"
