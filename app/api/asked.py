"""Turns what a request names or contains into the planner's values; fields are named as in the request."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from fastapi import Request

from app.api.messages import PlanRequest
from app.searches import Options
from app.workspace import Workspace
from planner.cloth.garment import Garment
from planner.errors import FieldError, FoldError, GarmentError, SceneError
from planner.geometry.pose import Pose2
from planner.task.scene import Scene

SHORTEST_S = 0.01
"""The least time that a search is given, though it should have begun earlier (s)."""


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


class TimeLimit:
    """The time that a request gives a search, which runs from its arrival on."""

    def __init__(self, limit_s: float) -> None:
        """Start the clock."""
        self.limit_s = limit_s
        self._arrived_s = time.monotonic()

    @property
    def left_s(self) -> float:
        """What is left of it (s)."""
        return max(SHORTEST_S, self.limit_s - (time.monotonic() - self._arrived_s))


def asked_options(wanted: PlanRequest, limit: TimeLimit) -> Options:
    """Return the options of a request for a search that begins now."""
    placed = wanted.placement
    return Options(
        placement=Pose2(placed.x_m, placed.y_m, placed.yaw_rad) if placed else None,
        start_station=wanted.start_station,
        robot=wanted.robot,
        comfort_radius_m=wanted.comfort_radius_m,
        heuristic=wanted.heuristic,
        time_limit_s=limit.left_s,
        work_limit_s=wanted.work_limit_s,
        max_expanded=wanted.max_expanded,
    )


@contextmanager
def within_request() -> Iterator[None]:
    """Have errors of garment, folds and scene name the field as it is in the request."""
    try:
        yield
    except (FoldError, GarmentError) as error:
        raise error.within("garment") from None
    except SceneError as error:
        raise error.within("scene") from None
