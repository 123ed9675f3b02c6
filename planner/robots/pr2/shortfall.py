"""The shortfall of a place that is not within the left arm's comfort radius, and its cause.

Everything is seen from the arm's shoulder (m), parallel to the base. The base may stand in several places: the place is
given as it is seen from each.

Where all limits are kept, an unreachable pose has no solution to examine. So to find the joint that limits, the pan's
limits are dropped: along the arcs that are then left (see `planner.robots.pr2.kernel`) every joint but the elbow may be
outside its limits, and its slack says by how much. The arm's best try is the pan at which the least of the five slacks
is greatest, and the joint with that least slack is the limiting one.
"""

import math

import numpy as np

from planner.deadline import Deadline
from planner.geometry.pose import FloatArray, point3
from planner.geometry.reach_query import Cause, Shortfall
from planner.kernels import kernel
from planner.robots.displacements import DIRECTIONS, FURTHEST_M, SIDEWAYS, STRAIGHT, homewards
from planner.robots.pr2.aim import ToolPose, aim_at, is_within_length
from planner.robots.pr2.arm import ArmShape, sector
from planner.robots.pr2.joint_slack import slack_within
from planner.robots.pr2.kernel import FINEST, reachable_batch
from planner.robots.pr2.nearest_comfort import (
    PIECE_QUERIES,
    directions_from,
    is_hindered,
    nearest_comfort,
    widest_comfort,
)
from planner.robots.pr2.pan_arcs import MOST_ARCS, pan_arcs, pan_on
from planner.robots.pr2.requirements import Requirements, aims_gap

JOINT_NAMES = ("shoulder pan", "shoulder lift", "upper arm roll", "elbow", "wrist")
"""Names for people of the joints that have limits."""

SAMPLES = 64
"""Samples along an arc, both branches together."""

ELBOW = 3


@kernel
def joint_slacks(shape: ArmShape, aim: ToolPose, pan: float, branch: float) -> tuple[float, float, float, float, float]:
    """Return the slack of each of `JOINT_NAMES` at a pan, with cos(roll) of the sign of `branch`.

    A slack is the sine of the angle by which the joint lies within its limits. Where rounding has left no solution for
    elbow or roll the nearest is taken.
    """
    cos_pan, sin_pan = math.cos(pan), math.sin(pan)
    u, v, w = cos_pan * aim.x + sin_pan * aim.y - shape.offset, cos_pan * aim.y - sin_pan * aim.x, aim.z
    ahead, left = cos_pan * aim.ax + sin_pan * aim.ay, cos_pan * aim.ay - sin_pan * aim.ax
    bones_2 = shape.upper * shape.upper + shape.fore * shape.fore
    cos_elbow = (u * u + v * v + w * w - bones_2) / (2.0 * shape.upper * shape.fore)
    cos_elbow = min(max(cos_elbow, -1.0), 1.0)
    sin_elbow = -math.sqrt(1.0 - cos_elbow * cos_elbow)
    sin_roll = 0.0 if sin_elbow == 0.0 else min(max(v / (shape.fore * sin_elbow), -1.0), 1.0)
    cos_roll = math.copysign(math.sqrt(1.0 - sin_roll * sin_roll), branch)
    a, b = shape.upper + shape.fore * cos_elbow, -shape.fore * cos_roll * sin_elbow
    lift = math.atan2(b, a) - math.atan2(w, u)
    cos_lift, sin_lift = math.cos(lift), math.sin(lift)
    along = (u - shape.upper * cos_lift) * ahead + v * left + (w + shape.upper * sin_lift) * aim.az
    cos_wrist = min(max(along / shape.fore, -1.0), 1.0)
    return (
        slack_within(shape.pan, cos_pan, sin_pan),
        slack_within(shape.lift, cos_lift, sin_lift),
        slack_within(shape.roll, cos_roll, sin_roll),
        slack_within(shape.elbow, cos_elbow, sin_elbow),
        slack_within(shape.wrist, cos_wrist, -math.sqrt(1.0 - cos_wrist * cos_wrist)),
    )


@kernel
def _least_slack(shape: ArmShape, aim: ToolPose, arc: FloatArray, theta: float) -> float:
    """Return the least slack at an angle of the closed curve over an arc."""
    return min(joint_slacks(shape, aim, pan_on(arc, theta), math.copysign(1.0, math.sin(theta))))


@kernel
def _best_try(shape: ArmShape, aim: ToolPose, arcs: FloatArray, count: int) -> tuple[int, float]:
    """Return the arc, among the first `count`, and the angle of its curve at which the least slack is greatest."""
    step = math.tau / SAMPLES
    best, best_arc, best_theta = -math.inf, 0, 0.0
    for arc in range(count):
        for sample in range(SAMPLES):
            theta = (sample + 0.5) * step
            least = _least_slack(shape, aim, arcs[arc], theta)
            if least > best:
                best, best_arc, best_theta = least, arc, theta
    while step > FINEST:
        step *= 0.5
        for theta in (best_theta - step, best_theta + step):
            least = _least_slack(shape, aim, arcs[best_arc], theta)
            if least > best:
                best, best_theta = least, theta
    return best_arc, best_theta


@kernel
def _limiting(shape: ArmShape, unpanned: ArmShape, point: FloatArray, axis: FloatArray) -> int:
    """Return the index in `JOINT_NAMES` of the limiting joint; -1 beyond the arm's length.

    `unpanned` is the arm without limits to its pan.
    """
    aim = aim_at(shape, point[0], point[1], point[2], axis[0], axis[1], axis[2])
    if not is_within_length(shape, aim):
        return -1
    arcs = np.empty((MOST_ARCS, 2))
    count = pan_arcs(unpanned, aim, arcs)
    if count == 0:
        return ELBOW
    arc, theta = _best_try(shape, aim, arcs, count)
    slacks = joint_slacks(shape, aim, pan_on(arcs[arc], theta), math.copysign(1.0, math.sin(theta)))
    limiting = 0
    for joint in range(len(slacks)):
        if slacks[joint] < slacks[limiting]:
            limiting = joint
    return limiting


def limiting_joint(shape: ArmShape, point: FloatArray, axis: FloatArray) -> str | None:
    """Return the joint that most keeps the tool from a point along an axis; None beyond the arm's length.

    It is the elbow where no pan at all lets the elbow bend as required, and the joint nearest to a limit where the pose
    is reachable.

    Args:
        shape: the arm.
        point: the tool's position in the shoulder's frame (m), shape (3,).
        axis: the approach axis, shape (3,).
    """
    limiting = _limiting(shape, shape._replace(pan=sector(-math.pi, math.pi)), point, axis)
    return None if limiting < 0 else JOINT_NAMES[limiting]


_RING = np.array(STRAIGHT)
"""Directions from a point to the four on the comfort circle."""


def left_shortfall(
    shape: ArmShape, query: Requirements, points: FloatArray, at_most_m: float, deadline: Deadline
) -> tuple[Shortfall, int]:
    """Return the shortfall of a place that is not within the comfort radius from anywhere, and the queries made.

    Args:
        shape: the arm.
        query: the requirements on the place, at least one approach; the shortfall's `approach` is an index into them.
        points: the tool's position as seen from each place of the base, shape (n, 3).
        at_most_m: the longest displacement tried, if less than `FURTHEST_M`.
        deadline: ends the search, once it is long over, after some thousand queries, with a lower bound.
    """
    furthest = min(at_most_m, FURTHEST_M)
    lines, queries = directions_from(shape, query, points, DIRECTIONS), 0
    while True:
        short_by_m, seen_from, approach, direction, more = nearest_comfort(
            shape, query, points, DIRECTIONS, furthest, lines, PIECE_QUERIES
        )
        queries += more
        searched = float(lines.inner[0])
        if seen_from >= 0 or searched >= furthest or deadline.is_long_over:
            break
    comfort, widest_from, widest_approach, more = widest_comfort(shape, query, points)
    queries += more
    is_at_least = seen_from < 0
    if is_at_least:
        seen_from, approach, short_by_m = _nearest_by_length(shape, query, points, min(searched, furthest))
    point, axis = points[seen_from], query.axes[approach]
    towards = homewards(point) if is_at_least else DIRECTIONS[direction]
    joint, comfort_m = limiting_joint(shape, point, axis), None
    cause: Cause = "too_far" if is_at_least else _cause(point, point - shape.tool * axis, towards, short_by_m)
    if widest_from >= 0:
        cause, comfort_m = "comfort_only", comfort
        joint = _missed_on_ring(shape, points[widest_from], query.axes[widest_approach], query.comfort)
        queries += len(_RING)
    elif is_hindered(shape, query, points):
        cause, joint = "own_body", None
    return Shortfall(cause, joint, short_by_m, is_at_least, point3(towards), approach, seen_from, comfort_m), queries


def _missed_on_ring(shape: ArmShape, point: FloatArray, axis: FloatArray, comfort_m: float) -> str | None:
    """Return the joint that limits at an unreachable place of the comfort circle."""
    ring = point + comfort_m * _RING
    missed = ring[~reachable_batch(shape, ring, np.repeat(axis[None], len(ring), axis=0))]
    return limiting_joint(shape, missed[0] if len(missed) else point, axis)


def _cause(point: FloatArray, wrist: FloatArray, towards: FloatArray, short_by_m: float) -> Cause:
    """Return why a point is out of reach that a displacement brings into it.

    A point whose wrist is above the shoulder and must come down is too far, even where the tool hangs below.
    """
    further_m = np.linalg.norm(point + short_by_m * towards) - np.linalg.norm(point)
    is_too_high = towards[2] < 0.0 and wrist[2] > 0.0
    if is_too_high or further_m < -SIDEWAYS * short_by_m:
        return "too_far"
    return "too_near" if further_m > SIDEWAYS * short_by_m else "joint_limit"


def _nearest_by_length(
    shape: ArmShape, query: Requirements, points: FloatArray, searched: float
) -> tuple[int, int, float]:
    """Return from where and how an unreachable place is nearest by length, and a lower bound on its shortfall.

    The bound is the larger of what its wrist is beyond the arm (`planner.robots.pr2.arm_gap`) and `searched`, up to
    which all directions were tried (m).
    """
    approaches = range(len(query.axes))
    gaps = np.array([[aims_gap(shape, query, point, approach) for approach in approaches] for point in points])
    seen_from, approach = np.unravel_index(int(gaps.argmin()), gaps.shape)
    return int(seen_from), int(approach), max(float(gaps.min()), searched)
