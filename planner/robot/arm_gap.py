"""At least how far is an aim from what the arm can take? A lower bound in closed form, compiled.

Let go of every limit but two: the shoulder's lift keeps its own, and the bones keep their lengths. The pan may then
turn the arm's plane through the wrist, and in that plane, (outward from the pan axis, upward), the elbow is somewhere
on an arc of radius `upper` round the lift axis, and the wrist within `fore` of the elbow. So a wrist at distance d from
the arc is out of reach by d - `fore` at least, and no displacement shorter than that is any use.

Points are seen from the left arm's shoulder (m), parallel to the base.
"""

import math

import numpy as np
from numba import njit

from planner.geometry.pose import FloatArray
from planner.robot.aim import ToolPose, aim_at
from planner.robot.arm import ArmShape


@njit(cache=True, nogil=True)
def gap(shape: ArmShape, x: float, y: float, z: float) -> float:
    """How far a wrist is out of reach at least (m); 0 or less where nothing speaks against it so far.

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
    """The same for an aim and four on the circle of radius `comfort` round it: the worst of them decides."""
    worst = gap(shape, aim.x, aim.y, aim.z)
    if comfort > 0.0:
        for dx, dy in ((comfort, 0.0), (-comfort, 0.0), (0.0, comfort), (0.0, -comfort)):
            worst = max(worst, gap(shape, aim.x + dx, aim.y + dy, aim.z))
    return worst


@njit(cache=True, nogil=True)
def least_gaps(
    shape: ArmShape, ways: FloatArray, axes: FloatArray, back_offs: int, step: float, comfort: float
) -> FloatArray:
    """For each way how far its worst point is out of comfort at least in the best approach (m), shape (n,).

    Args:
        shape: the arm.
        ways: tool points at back-off 0, those of a way to be had in one approach, shape (n, p, 3).
        axes: approach axes, shape (k, 3).
        back_offs: how many there are; for each point the best of them counts.
        step: from one back-off to the next (m): the points move along x by it.
        comfort: radius of the comfort circle (m).
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
    """How far a point is out of comfort at least in an approach from the best back-off (m)."""
    least = math.inf
    for back_off in range(back_offs):
        aim = aim_at(shape, point[0] + back_off * step, point[1], point[2], axis[0], axis[1], axis[2])
        if gap(shape, aim.x, aim.y, aim.z) < least:
            least = min(least, comfort_gap(shape, aim, comfort))
            if least <= 0.0:
                return 0.0
    return least
