"""A lower bound in closed form on how far a tool pose is from the arm's reach, compiled.

The bound keeps the links' lengths and the limits of the shoulder's pan and lift, and relaxes all others. At one pan the
elbow is on an arc of radius `upper` round the lift axis, in the plane of that pan, and the wrist within `fore` of the
elbow. Since the elbow is always ahead of the pan axis in this plane, it is nearest to the wrist at the pan that is
nearest to the wrist's bearing: that bearing itself, or one of the pan's limits. So a wrist at distance d from the arc
there is out of reach by at least d - `fore`, and no shorter displacement brings it into reach. Nor does any shorter
than n - d bring it into reach where n is the wrist's distance from the lift axis with the elbow bent as far as it goes,
and d its distance from that axis at the pan at which it is furthest.

Points are seen from the left arm's shoulder (m), parallel to the base.
"""

import math

import numpy as np

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.pr2.aim import ToolPose, aim_at
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.joint_slack import slack_within


@kernel
def gap(shape: ArmShape, x: float, y: float, z: float) -> float:
    """Return the least distance by which a wrist is out of reach (m); 0 or less where the bound excludes nothing.

    The lift's limits must be less than half a turn apart and the elbow ahead of the pan axis between them.
    """
    pan, distance = shape.pan, math.sqrt(x * x + y * y)
    ahead_at_low, ahead_at_high = pan.cos_low * x + pan.sin_low * y, pan.cos_high * x + pan.sin_high * y
    if slack_within(pan, x, y) >= 0.0:
        from_elbow = _from_elbow(shape, distance - shape.offset, 0.0, z)
    else:
        at_low = _from_elbow(shape, ahead_at_low - shape.offset, pan.cos_low * y - pan.sin_low * x, z)
        at_high = _from_elbow(shape, ahead_at_high - shape.offset, pan.cos_high * y - pan.sin_high * x, z)
        from_elbow = min(at_low, at_high)
    least_ahead = -distance if slack_within(pan, -x, -y) >= 0.0 else min(ahead_at_low, ahead_at_high)
    from_lift_2 = distance * distance + z * z + shape.offset * (shape.offset - 2.0 * least_ahead)
    bent_2 = shape.upper * shape.upper + shape.fore * shape.fore + 2.0 * shape.upper * shape.fore * shape.elbow.cos_low
    return max(from_elbow - shape.fore, math.sqrt(bent_2) - math.sqrt(from_lift_2))


@kernel
def _from_elbow(shape: ArmShape, outward: float, across: float, z: float) -> float:
    """Return the distance of a wrist from the elbow's arc at one pan (m).

    The wrist is seen from the lift axis: outward in the plane of the pan, across that plane, and upward.
    """
    lift = shape.lift
    is_above_lowest = z * lift.cos_high + outward * lift.sin_high >= 0.0
    is_below_highest = -z * lift.cos_low - outward * lift.sin_low >= 0.0
    if is_above_lowest and is_below_highest:
        return math.hypot(math.sqrt(outward * outward + z * z) - shape.upper, across)
    raised = math.hypot(outward - shape.upper * lift.cos_low, z + shape.upper * lift.sin_low)
    lowered = math.hypot(outward - shape.upper * lift.cos_high, z + shape.upper * lift.sin_high)
    return math.hypot(min(raised, lowered), across)


@kernel
def comfort_gap(shape: ArmShape, aim: ToolPose, comfort: float) -> float:
    """Return the largest gap of a tool pose and the four on the circle of radius `comfort` round it (m)."""
    worst = gap(shape, aim.x, aim.y, aim.z)
    if comfort > 0.0:
        for dx, dy in ((comfort, 0.0), (-comfort, 0.0), (0.0, comfort), (0.0, -comfort)):
            worst = max(worst, gap(shape, aim.x + dx, aim.y + dy, aim.z))
    return worst


@kernel
def least_gaps(
    shape: ArmShape, ways: FloatArray, axes: FloatArray, standoffs: int, step: float, comfort: float
) -> FloatArray:
    """Return for each way a lower bound on how far its worst point is from the comfort radius (m), shape (n,).

    The best approach counts.

    Args:
        shape: the arm.
        ways: tool points at standoff 0, all to be reached in one approach for each way, shape (n, p, 3).
        axes: approach axes, shape (k, 3).
        standoffs: the number of standoffs; for each point the best of them counts.
        step: the distance between standoffs (m), by which the points move along x.
        comfort: the comfort radius (m).
    """
    gaps = np.empty(len(ways))
    for i in range(len(ways)):
        gaps[i] = math.inf
        for axis in axes:
            worst = 0.0
            for point in ways[i]:
                worst = max(worst, _least_gap(shape, point, axis, standoffs, step, comfort))
                if worst >= gaps[i]:
                    break
            gaps[i] = min(gaps[i], worst)
    return gaps


@kernel
def _least_gap(
    shape: ArmShape, point: FloatArray, axis: FloatArray, standoffs: int, step: float, comfort: float
) -> float:
    """Return a lower bound on a point's gap (m) in one approach from the best standoff."""
    least = math.inf
    for standoff in range(standoffs):
        aim = aim_at(shape, point[0] + standoff * step, point[1], point[2], axis[0], axis[1], axis[2])
        if gap(shape, aim.x, aim.y, aim.z) < least:
            least = min(least, comfort_gap(shape, aim, comfort))
            if least <= 0.0:
                return 0.0
    return least
