"""The pans at which a tool pose is feasible, found exactly: a few arcs, and the closed curve over each.

With c = cos(pan - bearing of the wrist) the elbow's limits are linear in c, and |sin roll| <= 1 is quadratic: together
they leave c one or two intervals, and pan, within its own limits, a few arcs. The limits of the other joints are tested
along an arc (see `planner.robots.pr2.kernel`, also for why an angle parametrises it).
"""

import math

from planner.geometry.pose import FloatArray
from planner.kernels import fast_kernel
from planner.robots.pr2.aim import ToolPose
from planner.robots.pr2.arm import ArmShape, Sector

MOST_ARCS = 8
"""Room for arcs in an array; further arcs are left out."""


@fast_kernel
def pan_arcs(shape: ArmShape, aim: ToolPose, arcs: FloatArray) -> int:
    """Find the pans within limits for which elbow and roll have a solution, the elbow within limits.

    Args:
        shape: the arm.
        aim: the tool pose.
        arcs: shape (MOST_ARCS, 2), overwritten with the middle and half width of each arc (rad).

    Returns:
        The number of arcs.
    """
    distance = max(math.hypot(aim.x, aim.y), 1e-9)
    reach_2 = distance * distance + aim.z * aim.z + shape.offset * shape.offset
    swing = 2.0 * shape.offset * distance
    bones_2 = shape.upper * shape.upper + shape.fore * shape.fore
    bones = 2.0 * shape.upper * shape.fore
    # cos(elbow) = level - slope * c with c = cos(pan - bearing): linear in c.
    level, slope = (reach_2 - bones_2) / bones, swing / bones
    lowest = max((level - shape.elbow.cos_high) / slope, -1.0)
    highest = min((level - shape.elbow.cos_low) / slope, 1.0)
    if lowest > highest:
        return 0
    # |sin(roll)| <= 1 is p c^2 + 2 q c + r >= 0, and p > 0: c lies outside of the roots.
    fore_2, distance_2 = shape.fore * shape.fore, distance * distance
    p = distance_2 - fore_2 * slope * slope
    q = fore_2 * level * slope
    r = fore_2 * (1.0 - level * level) - distance_2
    bearing = math.atan2(aim.y, aim.x)
    if q * q <= p * r:
        return _add_band(shape.pan, bearing, lowest, highest, arcs, 0)
    root = math.sqrt(q * q - p * r)
    count = _add_band(shape.pan, bearing, max(lowest, (root - q) / p), highest, arcs, 0)
    return _add_band(shape.pan, bearing, lowest, min(highest, (-root - q) / p), arcs, count)


@fast_kernel
def _add_band(limits: Sector, bearing: float, lowest: float, highest: float, arcs: FloatArray, count: int) -> int:
    """Add the arcs where cos(pan - bearing) is from lowest to highest; return the new count."""
    if lowest > highest:
        return count
    near, far = math.acos(highest), math.acos(lowest)
    if near == 0.0:
        return _add_arc(limits, bearing - far, bearing + far, arcs, count)
    count = _add_arc(limits, bearing + near, bearing + far, arcs, count)
    return _add_arc(limits, bearing - far, bearing - near, arcs, count)


@fast_kernel
def _add_arc(limits: Sector, start: float, end: float, arcs: FloatArray, count: int) -> int:
    """Add the part of an arc within the limits, whole turns allowed; return the new count."""
    for turn in (-math.tau, 0.0, math.tau):
        low, high = max(start + turn, limits.low), min(end + turn, limits.high)
        if low <= high and count < MOST_ARCS:
            arcs[count, 0], arcs[count, 1] = 0.5 * (low + high), 0.5 * (high - low)
            count += 1
    return count


@fast_kernel
def pan_on(arc: FloatArray, theta: float) -> float:
    """Return the pan at an angle of the closed curve over an arc (middle, half width)."""
    pan: float = arc[0] - arc[1] * math.cos(theta)
    return pan
