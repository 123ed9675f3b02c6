"""The server's health and the default scene."""

from importlib.metadata import PackageNotFoundError, version
from typing import Any

from fastapi import APIRouter

from app.api.answers import Health, SceneFile
from planner.primitives.scene import Scene

router = APIRouter(prefix="/api")


@router.get("/health", response_model=Health)
async def read_health() -> dict[str, str]:
    """That the server is there, and which."""
    return {"status": "ok", "version": own_version()}


@router.get("/scene", response_model=SceneFile)
async def read_scene() -> dict[str, Any]:
    """The default scene."""
    return Scene().to_dict()


def own_version() -> str:
    """Pleat's version, as it is installed."""
    try:
        return version("pleat")
    except PackageNotFoundError:
        return "0"
