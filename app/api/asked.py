"""Turns what a request names or contains into the planner's values; fields are named as in the request."""

from typing import Any

from fastapi import Request

from app.workspace import Workspace
from planner.cloth.garment import Garment
from planner.errors import FieldError
from planner.primitives.scene import Scene


def workspace_of(request: Request) -> Workspace:
    """The server's workspace."""
    workspace: Workspace = request.app.state.workspace
    return workspace


def asked_garment(workspace: Workspace, garment: str | dict[str, Any]) -> Garment:
    """The garment of a request's field `garment`: by name, or given whole.

    Raises:
        UnknownGarmentError: no garment has this name.
        GarmentError: the one that is given is not valid; the field begins with ``garment``.
    """
    if isinstance(garment, str):
        return workspace.garments.garment(garment)
    try:
        return Garment.from_dict(garment)
    except FieldError as error:
        raise error.within("garment") from None


def asked_scene(scene: dict[str, Any] | None) -> Scene:
    """The scene of a request's field `scene`, or the default one; raises `SceneError`."""
    if scene is None:
        return Scene()
    try:
        return Scene.from_dict(scene)
    except FieldError as error:
        raise error.within("scene") from None
