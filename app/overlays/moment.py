"""The moment that overlays show: the poses of robot and cloth, and the folds done so far."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.document_state import DocumentState
from planner.cloth.cloth_state import ClothState
from planner.cloth.g_state import TableInGarment
from planner.errors import FoldingError, RequestError
from planner.geometry.pose import FloatArray, Pose2, wrapped_angle
from planner.geometry.tolerance import EDGE_RAD, LENGTH_M, TIME_S
from planner.motion.timeline import Sample
from planner.task.plan import Plan
from planner.task.reason import Reason
from planner.task.scene import Scene


class NoClothError(FoldingError):
    """There is no cloth for an overlay."""


@dataclass(frozen=True)
class Moment:
    """A moment of a plan, or of the garment as drawn.

    Attributes:
        robot: the name of the robot.
        scene: the scene.
        comfort_m: the comfort radius (m).
        base: the base in the table frame.
        station: the base's station; None while it drives.
        back_off_m: its standoff from the station (m).
        placement: the garment frame in the table frame.
        cloth: the stack as it lies there.
        done: the folds done, in the user's order.
        plan: the plan; None for the garment as drawn.
        frame: the sample of the plan; None for the garment as drawn.
        reason: the first reason with a position why there is no plan, or None.
    """

    robot: str
    scene: Scene
    comfort_m: float
    base: Pose2
    station: str | None
    back_off_m: float
    placement: Pose2
    cloth: ClothState
    done: tuple[int, ...] = ()
    plan: Plan | None = None
    frame: Sample | None = None
    reason: Reason | None = None

    @cached_property
    def table(self) -> TableInGarment:
        """The table top in the garment frame."""
        return TableInGarment.seen_from(self.placement, self.scene.table)

    @property
    def base_in_garment(self) -> Pose2:
        """The base in the garment frame."""
        return self.in_garment(self.base)

    def in_garment(self, pose: Pose2) -> Pose2:
        """Return a pose of the table frame in the garment frame."""
        x, y = self.placement.to_inner(np.array([pose.x_m, pose.y_m]))
        return Pose2(float(x), float(y), pose.yaw_rad - self.placement.yaw_rad)

    def to_garment(self, points: FloatArray) -> FloatArray:
        """Return points of the table frame, shape (..., 2) or (..., 3), in the garment frame."""
        return self.placement.to_inner(points)


def moment_of_plan(state: DocumentState, t_s: float) -> Moment:
    """Return the moment at a time in the plan shown (s), clamped to its duration; without a plan, the garment as drawn.

    Raises:
        NoClothError: nothing is drawn yet.
    """
    if state.shown is None:
        return moment_as_drawn(state, None, 0.0)
    plan, timeline = state.shown.plan, state.shown.timeline
    frame = timeline.at(t_s)
    if not plan.steps:
        return moment_as_drawn(state, None, 0.0)
    step = plan.steps[frame.primitive]
    is_over = frame.t_s >= step.end_s - TIME_S
    world = step.after if is_over else step.before
    station, back_off_m = _station(plan.scene, frame.base)
    return Moment(
        plan.task.robot,
        plan.scene,
        state.drawing.comfort_radius_m,
        frame.base,
        station,
        back_off_m,
        frame.placement,
        plan.sequence.cloth(world.done),
        tuple(sorted(world.folds_done)),
        plan,
        frame,
    )


def moment_as_drawn(state: DocumentState, station: str | None, back_off_m: float) -> Moment:
    """Return the moment of the garment as drawn, with the robot at a station, by default its start.

    Raises:
        NoClothError: nothing is drawn yet.
        RequestError: there is no such station, or the standoff is out of range.
    """
    drawing = state.drawing
    stations = dict(drawing.scene.stations)
    name = drawing.start_station if station is None and drawing.start_station in stations else station
    name = next(iter(stations)) if name is None else name
    if name not in stations:
        raise RequestError("station", f"expected one of {', '.join(stations)}; got {name[:80]!r}")
    if not 0.0 <= back_off_m <= drawing.scene.back_off_max_m:
        raise RequestError("back_off_m", f"{back_off_m} is not between 0 and {drawing.scene.back_off_max_m:g}")
    if not state.solution.cloths:
        raise NoClothError("There is no outline yet.")
    return Moment(
        drawing.robot,
        drawing.scene,
        drawing.comfort_radius_m,
        stations[name].ahead(-back_off_m),
        name,
        back_off_m,
        drawing.placement,
        state.solution.cloths[0],
        reason=_reason(state),
    )


def _station(scene: Scene, base: Pose2) -> tuple[str | None, float]:
    """Return the station of a base and the standoff from it (m); None and 0 while it drives."""
    for name, pose in scene.stations:
        back, aside = -pose.to_inner(np.array([base.x_m, base.y_m]))
        is_turned = abs(wrapped_angle(base.yaw_rad - pose.yaw_rad)) > EDGE_RAD
        if not is_turned and abs(aside) <= LENGTH_M and -LENGTH_M <= back <= scene.back_off_max_m + LENGTH_M:
            return name, max(float(back), 0.0)
    return None, 0.0


def _reason(state: DocumentState) -> Reason | None:
    """Return the first reason with a position why there is no plan for the drawing."""
    if state.answer is None or not state.is_answered:
        return None
    return next((reason for reason in state.answer.plan.reasons if reason.point is not None), None)
