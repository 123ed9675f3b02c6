"""Overlays of a plan's motions: the path of the base, and the paths of the hands."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from pydantic import BaseModel

from app.overlays.moment import Moment
from planner.geometry.pose import FloatArray, Point2, Point3, Pose2, wrapped_angle
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from planner.task.plan import Plan, PlanStep
from planner.task.trajectory import Phase


class StandAnswer(BaseModel):
    """The base's pose after a primitive (m, rad)."""

    primitive: int
    point: Point2
    yaw_rad: float


class BaseWayAnswer(BaseModel):
    """The base's path, and how many of its points have been passed (m)."""

    way: list[Point2]
    stands: list[StandAnswer]
    gone: int


class PathGripAnswer(BaseModel):
    """The path of one hand, seen from above and in space, with the height over the table (m)."""

    arm: str
    pick: Point2
    apex: Point2 | None
    place: Point2
    points: list[Point3]


class PathsAnswer(BaseModel):
    """The hands' paths of a primitive, in the garment frame as the garment lies when the primitive begins."""

    primitive: int
    kind: str
    fold: int | None
    grips: list[PathGripAnswer]


def base_overlay(moment: Moment) -> BaseWayAnswer | None:
    """Return the base's path over all steps, garment frame; None without a plan."""
    if moment.plan is None or moment.frame is None:
        return None
    parts = [_base_points(moment.plan, number) for number in range(len(moment.plan.steps))]
    way = _without_stops(np.concatenate(parts))
    passed = _without_stops(np.concatenate(parts[: moment.frame.primitive + 1]))
    first = len(_without_stops(np.concatenate(parts[: moment.frame.primitive]))) if moment.frame.primitive else 1
    return BaseWayAnswer(
        way=moment.to_garment(way).tolist(),
        stands=[_stand(moment, number, step) for number, step in enumerate(moment.plan.steps)],
        gone=_gone(passed, first, np.array([moment.base.x_m, moment.base.y_m])),
    )


def paths_overlay(moment: Moment) -> list[PathsAnswer] | None:
    """Return the paths of the hands in each step that has grips; None without a plan."""
    plan = moment.plan
    if plan is None:
        return None
    return [
        PathsAnswer(primitive=number, kind=step.kind, fold=step.fold, grips=_grips(plan, number))
        for number, step in enumerate(plan.steps)
        if step.grips
    ]


def _base_points(plan: Plan, number: int) -> FloatArray:
    """Return the base's positions at the start and the end of each phase of a step, table frame, shape (n, 2), m."""
    return np.array([(pose.x_m, pose.y_m) for phase in _phases(plan, number) for pose in phase.base])


def _phases(plan: Plan, number: int) -> list[Phase]:
    """Return the phases of a step."""
    return [] if plan.trajectory is None else [segment.phase for segment in plan.trajectory.of_step(number)]


def _without_stops(points: FloatArray) -> FloatArray:
    """Return the points of a path without consecutive duplicates."""
    moved = np.hypot(*np.diff(points, axis=0).T) > LENGTH_M
    return np.asarray(points[np.concatenate([[True], moved])])


def _gone(passed: FloatArray, first: int, base: FloatArray) -> int:
    """Return the number of points that a base on the path has passed, at least `first`."""
    best, gone = np.inf, first
    for number in range(first, len(passed)):
        (ax, ay), (bx, by) = passed[number - 1], passed[number]
        distance = float(Segment((ax, ay), (bx, by)).distances(base[None])[0])
        if distance < best - LENGTH_M:
            best, gone = distance, number
    return gone


def _stand(moment: Moment, number: int, step: PlanStep) -> StandAnswer:
    pose = step.base.pose
    x, y = moment.to_garment(np.array([pose.x_m, pose.y_m]))
    yaw_rad = wrapped_angle(pose.yaw_rad - moment.placement.yaw_rad)
    return StandAnswer(primitive=number, point=(float(x), float(y)), yaw_rad=yaw_rad)


def _grips(plan: Plan, number: int) -> list[PathGripAnswer]:
    assert plan.trajectory is not None, "a plan that is played is solved"
    step, arms = plan.steps[number], [track.arm for track in plan.trajectory.grippers]
    found = []
    for grip in step.grips:
        arm, place = arms.index(grip.arm), step.before.placement
        hands = [phase.hands[arm] for phase in _phases(plan, number)]
        points = [point for hand in hands if hand is not None and hand.is_closed for point in hand.points]
        found.append(
            PathGripAnswer(
                arm=grip.arm,
                pick=_plane(place, grip.pick),
                apex=None if grip.apex is None else _plane(place, grip.apex),
                place=_plane(place, grip.place),
                points=place.to_inner(_bends(np.array(points))).tolist(),
            )
        )
    return found


def _plane(placement: Pose2, point: Sequence[float]) -> Point2:
    """Return a point of the table frame in the garment frame, seen from above."""
    x, y, *_ = placement.to_inner(np.array(point)).tolist()
    return x, y


def _bends(path: FloatArray) -> FloatArray:
    """Return the corners of a path in space, and its ends, shape (n, 3), m."""
    kept = [path[0]]
    for point, following in pairwise(path[1:]):
        along, ahead = point - kept[-1], following - point
        is_straight = np.linalg.norm(np.cross(along, ahead)) <= LENGTH_M * (np.linalg.norm(ahead) + LENGTH_M)
        if not is_straight or np.dot(along, ahead) < 0.0:
            kept.append(point)
    return np.array([*kept, path[-1]]) if len(path) > 1 else path
