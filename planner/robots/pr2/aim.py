"""Tool poses, given by the wrist's position and the approach axis, with cheap tests that rule them out.

Everything is seen from the left arm's shoulder (m), parallel to the base, as in `planner.robots.pr2.kernel`.
"""

import math
from typing import NamedTuple

from planner.kernels import fast_kernel
from planner.robots.pr2.arm import ArmShape


class ToolPose(NamedTuple):
    """A tool pose: the position of the wrist's centre (m) and the unit vector along which the tool points."""

    x: float
    y: float
    z: float
    ax: float
    ay: float
    az: float


@fast_kernel
def aim_at(shape: ArmShape, x: float, y: float, z: float, ax: float, ay: float, az: float) -> ToolPose:
    """Return the tool pose that brings the tool to (x, y, z) along the axis (ax, ay, az)."""
    return ToolPose(x - shape.tool * ax, y - shape.tool * ay, z - shape.tool * az, ax, ay, az)


@fast_kernel
def beside(aim: ToolPose, radius: float, number: int) -> ToolPose:
    """Return the tool pose itself (0), or one beside it on a circle: ahead, back, left or right (1 to 4)."""
    dx = radius if number == 1 else -radius if number == 2 else 0.0
    dy = radius if number == 3 else -radius if number == 4 else 0.0
    return ToolPose(aim.x + dx, aim.y + dy, aim.z, aim.ax, aim.ay, aim.az)


@fast_kernel
def is_within_length(shape: ArmShape, aim: ToolPose) -> bool:
    """Return whether the wrist is no further from the lift axis than the arm is long, ignoring joint limits."""
    outward = math.hypot(aim.x, aim.y) - shape.offset
    length = shape.upper + shape.fore
    return outward * outward + aim.z * aim.z <= length * length


@fast_kernel
def is_within_height(shape: ArmShape, aim: ToolPose) -> bool:
    """Return whether the wrist's height is within what elbow and forearm allow; an approximate test."""
    highest = shape.fore - shape.upper * shape.lift.sin_low
    lowest = -shape.fore - shape.upper * shape.lift.sin_high
    return lowest <= aim.z <= highest
