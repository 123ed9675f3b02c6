"""A lower bound in closed form on how far a tool pose is from the arm's reach, compiled.

The bound relaxes every limit but two: the shoulder's lift keeps its own, and the links keep their lengths. The pan may
then turn the arm's plane through the wrist. In that plane (outward from the pan axis, upward) the elbow is on an arc of
radius `upper` round the lift axis, and the wrist within `fore` of the elbow. So a wrist at distance d from the arc is
out of reach by at least d - `fore`, and no shorter displacement brings it into reach.

Points are seen from the left arm's shoulder (m), parallel to the base.
"""

import math

import numpy as np
from numba import njit

from planner.geometry.pose import FloatArray
from planner.robots.aim import ToolPose, aim_at
from planner.robots.arm import ArmShape


@njit(cache=True, nogil=True)
def gap(shape: ArmShape, x: float, y: float, z: float) -> float:
    """Return the least distance by which a wrist is out of reach (m); 0 or less where the bound excludes nothing.

    The lift's limits must be less than half a turn apart.
    """
    lift = shape.lift
    outward = math.sqrt(x * x + y * y) - shape.offset
    is_above_lowest = z * lift.cos_high + outward * lift.sin_high >= 0.0
    is_below_highest = -z * lift.cos_low - outward * lift.sin_low >= 0.0
    if is_above_lowest and is_below_highest:
        return abs(math.sqrt(outward * outward + z * z) - shape.upper) - shape.fore
    raised = math.hypot(outward - shape.upper * lift.cos_low, z + shape.upper * lift.sin_low)
    lowered = math.hypot(outward - shape.upper * lift.cos_high, z + shape.upper * lift.sin_high)
    return min(raised, lowered) - shape.fore


@njit(cache=True, nogil=True)
def comfort_gap(shape: ArmShape, aim: ToolPose, comfort: float) -> float:
    """Return the largest gap of a tool pose and the four on the circle of radius `comfort` round it (m)."""
    worst = gap(shape, aim.x, aim.y, aim.z)
    if comfort > 0.0:
        for dx, dy in ((comfort, 0.0), (-comfort, 0.0), (0.0, comfort), (0.0, -comfort)):
            worst = max(worst, gap(shape, aim.x + dx, aim.y + dy, aim.z))
    return worst


@njit(cache=True, nogil=True)
def least_gaps(
    shape: ArmShape, ways: FloatArray, axes: FloatArray, back_offs: int, step: float, comfort: float
) -> FloatArray:
    """Return for each way a lower bound on how far its worst point is from the comfort radius (m), shape (n,).

    The best approach counts.

    Args:
        shape: the arm.
        ways: tool points at standoff 0, all to be reached in one approach for each way, shape (n, p, 3).
        axes: approach axes, shape (k, 3).
        back_offs: the number of standoffs; for each point the best of them counts.
        step: the distance between standoffs (m), by which the points move along x.
        comfort: the comfort radius (m).
    """
    gaps = np.empty(len(ways))
    for i in range(len(ways)):
        gaps[i] = math.inf
        for axis in axes:
            worst = 0.0
            for point in ways[i]:
                worst = max(worst, _least_gap(shape, point, axis, back_offs, step, comfort))
                if worst >= gaps[i]:
                    break
            gaps[i] = min(gaps[i], worst)
    return gaps


@njit(cache=True, nogil=True)
def _least_gap(
    shape: ArmShape, point: FloatArray, axis: FloatArray, back_offs: int, step: float, comfort: float
) -> float:
    """Return a lower bound on a point's gap (m) in one approach from the best standoff."""
    least = math.inf
    for back_off in range(back_offs):
        aim = aim_at(shape, point[0] + back_off * step, point[1], point[2], axis[0], axis[1], axis[2])
        if gap(shape, aim.x, aim.y, aim.z) < least:
            least = min(least, comfort_gap(shape, aim, comfort))
            if least <= 0.0:
                return 0.0
    return least
