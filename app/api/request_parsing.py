"""Convert the fields of a request into the planner's values; errors name the fields as in the request."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Protocol

from app.api.messages import BaseField, PlacementsRequest, PlanRequest, StartField
from app.store.garment_repository import GarmentRepository
from planner.cloth.garment import Garment
from planner.errors import FoldError, GarmentError, RequestError, SceneError
from planner.geometry.pose import Pose2
from planner.planning.robot_task import task_for
from planner.robots.known_robots import require_name
from planner.task.scene import Scene
from planner.task.task import Task, TaskOptions
from planner.task.world_state import BaseStop, WorldState

SHORTEST_S = 0.01
"""The least time that a search is given, even when its deadline is nearer (s)."""


class HasGarments(Protocol):
    """Something in which garments can be looked up by name."""

    @property
    def garments(self) -> GarmentRepository:
        """The garments."""


def requested_garment(within: HasGarments, garment: str | Garment) -> Garment:
    """Return the garment of a request's field `garment`, by name or in full; raises `UnknownGarmentError`."""
    return within.garments.garment(garment) if isinstance(garment, str) else garment


class TimeLimit:
    """The time limit of a request; it runs from the request's arrival."""

    def __init__(self, limit_s: float) -> None:
        """Start the clock."""
        self.limit_s = limit_s
        self._arrived_s = time.monotonic()

    @property
    def left_s(self) -> float:
        """The time that is left (s)."""
        return max(SHORTEST_S, self.limit_s - (time.monotonic() - self._arrived_s))


def requested_task(within: HasGarments, wanted: PlanRequest, limit: TimeLimit) -> Task:
    """Return the task of a plan request, for a search that begins now; raises an error for the first wrong field."""
    require_name(wanted.robot)
    options = TaskOptions(
        placement=wanted.placement,
        robot=wanted.robot,
        comfort_radius_m=wanted.comfort_radius_m,
        heuristic=wanted.heuristic,
        time_limit_s=limit.left_s,
        work_limit_s=wanted.work_limit_s,
        max_expanded=wanted.max_expanded,
    )
    if wanted.start_station is not None:
        options["start_station"] = wanted.start_station
    task = task_for(requested_garment(within, wanted.garment), wanted.scene, **options)
    return task if wanted.start is None else replace(task, start=requested_start(task, wanted.start))


def requested_places(within: HasGarments, wanted: PlacementsRequest, limit: TimeLimit) -> Task:
    """Return the task whose garment a request wants to have planned wherever it can lie."""
    garment = requested_garment(within, wanted.garment)
    return Task.of(garment, time_limit_s=limit.left_s, work_limit_s=wanted.work_limit_s)


def requested_start(task: Task, wanted: StartField) -> WorldState:
    """Return the state from which a request plans; fields left out have the task's defaults."""
    return WorldState(
        wanted.folds_done,
        wanted.placement or task.start.placement,
        task.start.base if wanted.base is None else _requested_base(task.scene, wanted.base),
        wanted.held,
        wanted.dragged_m,
    )


def _requested_base(scene: Scene, wanted: BaseField) -> BaseStop:
    """Return the base's place: at a station, or at a given pose."""
    x_m, y_m, yaw_rad = wanted.x_m, wanted.y_m, wanted.yaw_rad
    if wanted.station is None:
        if x_m is None or y_m is None or yaw_rad is None:
            raise RequestError("start.base", "needs a station, or x_m, y_m and yaw_rad")
        return BaseStop.at(None, Pose2(x_m, y_m, yaw_rad))
    stations = dict(scene.stations)
    if wanted.station not in stations:
        raise RequestError("start.base.station", f"expected one of {', '.join(stations)}; got {wanted.station[:80]!r}")
    if wanted.back_off_m > scene.back_off_max_m:
        message = f"{wanted.back_off_m} is more than {scene.back_off_max_m:g}, the furthest that the base may back off"
        raise RequestError("start.base.back_off_m", message)
    return BaseStop.at(wanted.station, stations[wanted.station], wanted.back_off_m)


@contextmanager
def within_request() -> Iterator[None]:
    """Rename the fields in errors of garment, folds and scene to those of the request."""
    try:
        yield
    except (FoldError, GarmentError) as error:
        raise error.within("garment") from None
    except SceneError as error:
        raise error.within("scene") from None
