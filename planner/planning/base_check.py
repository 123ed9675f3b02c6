"""Check that the base of a plan drives as its kind of base can."""

import math
from itertools import pairwise

from planner.errors import RequestError
from planner.geometry.pose import Pose2, wrapped_angle
from planner.geometry.tolerance import LENGTH_M
from planner.planning.problem import Problem
from planner.task.trajectory import Segment


def require_drive(problem: Problem, segment: Segment, times_s: list[float]) -> None:
    """Require that the base drives as it can in a segment of a trajectory.

    A differential base drives straight ahead or back, or turns where it stands; a fixed one does neither.

    Args:
        problem: the problem of the plan.
        segment: a segment of its trajectory.
        times_s: rising times, the segment's ends included (s).

    Raises:
        RequestError: says what the base would have to do, and when.
    """
    poses = [segment.base_at(t_s) for t_s in times_s]
    for (t_s, here), (_, there) in pairwise(zip(times_s, poses, strict=True)):
        told = _why_not(problem, here, there)
        if told is not None:
            raise RequestError("trajectory", f"at {t_s:.2f} s the base {told}")


def _why_not(problem: Problem, here: Pose2, there: Pose2) -> str | None:
    """Return what is wrong with a stretch of the base's way; None if nothing is."""
    kind = problem.robot.card.base_kind
    x, y = there.x_m - here.x_m, there.y_m - here.y_m
    driven_m, turned_rad = math.hypot(x, y), abs(wrapped_angle(there.yaw_rad - here.yaw_rad))
    aside_m = abs(x * math.sin(here.yaw_rad) - y * math.cos(here.yaw_rad))
    moves, turns = driven_m > LENGTH_M, turned_rad > LENGTH_M
    if kind == "fixed" and (moves or turns):
        return "moves, and it is fixed"
    if kind == "differential" and aside_m > LENGTH_M:
        return f"drives {aside_m:.3f} m sideways, which a differential base cannot"
    return None
