"""Overlays of a plan's motions: the path of the base, and the paths of the hands."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from app.overlays.moment import Moment
from planner.geometry.pose import FloatArray, wrapped_angle
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from planner.task.plan import Plan, PlanStep
from planner.task.trajectory import Phase


def base_overlay(moment: Moment) -> dict[str, Any] | None:
    """Return the base's path over all primitives, as JSON, article frame; None without a plan."""
    if moment.plan is None or moment.frame is None:
        return None
    parts = [_base_points(moment.plan, number) for number in range(len(moment.plan.steps))]
    way = _without_stops(np.concatenate(parts))
    passed = _without_stops(np.concatenate(parts[: moment.frame.primitive + 1]))
    first = len(_without_stops(np.concatenate(parts[: moment.frame.primitive]))) if moment.frame.primitive else 1
    return {
        "way": moment.to_article(way).tolist(),
        "stands": [_stand(moment, number, step) for number, step in enumerate(moment.plan.steps)],
        "gone": _gone(passed, first, np.array([moment.base.x_m, moment.base.y_m])),
    }


def paths_overlay(moment: Moment) -> list[dict[str, Any]] | None:
    """Return the paths of the hands, as JSON; None without a plan.

    Each path is in the article frame as it lies when its primitive starts.
    """
    if moment.plan is None:
        return None
    found = []
    for number, step in enumerate(moment.plan.steps):
        if step.grips:
            grips = _grips(moment.plan, number)
            found.append({"primitive": number, "kind": step.kind, "fold": step.fold, "grips": grips})
    return found


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


def _stand(moment: Moment, number: int, step: PlanStep) -> dict[str, Any]:
    pose = step.base.pose
    x, y = moment.to_article(np.array([pose.x_m, pose.y_m]))
    yaw_rad = wrapped_angle(pose.yaw_rad - moment.placement.yaw_rad)
    return {"primitive": number, "point": [float(x), float(y)], "yaw_rad": yaw_rad}


def _grips(plan: Plan, number: int) -> list[dict[str, Any]]:
    assert plan.trajectory is not None, "a plan that is played is solved"
    step, arms = plan.steps[number], [track.arm for track in plan.trajectory.grippers]
    found = []
    for grip in step.grips:
        arm, place = arms.index(grip.arm), step.before.placement
        hands = [phase.hands[arm] for phase in _phases(plan, number)]
        points = [point for hand in hands if hand is not None and hand.is_closed for point in hand.points]
        ends = {
            name: None if point is None else _plane(place.to_inner(np.array(point)))
            for name, point in (("pick", grip.pick), ("apex", grip.apex), ("place", grip.place))
        }
        found.append({"arm": grip.arm, **ends, "points": place.to_inner(_bends(np.array(points))).tolist()})
    return found


def _plane(point: Sequence[float] | FloatArray) -> list[float]:
    return [float(point[0]), float(point[1])]


def _bends(path: FloatArray) -> FloatArray:
    """Return the corners of a path in space, and its ends, shape (n, 3), m."""
    kept = [path[0]]
    for point, following in pairwise(path[1:]):
        along, ahead = point - kept[-1], following - point
        is_straight = np.linalg.norm(np.cross(along, ahead)) <= LENGTH_M * (np.linalg.norm(ahead) + LENGTH_M)
        if not is_straight or np.dot(along, ahead) < 0.0:
            kept.append(point)
    return np.array([*kept, path[-1]]) if len(path) > 1 else path
