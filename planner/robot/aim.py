"""An aim: where the wrist must be and which way the tool points; and what rules one out at no cost.

Everything is seen from the left arm's shoulder (m), parallel to the base, as in `planner.robot.kernel`.
"""

import math
from typing import NamedTuple

from numba import njit

from planner.robot.arm import ArmShape


class ToolPose(NamedTuple):
    """Where the wrist's centre must be (m) and the unit vector along which the tool points."""

    x: float
    y: float
    z: float
    ax: float
    ay: float
    az: float


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def aim_at(shape: ArmShape, x: float, y: float, z: float, ax: float, ay: float, az: float) -> ToolPose:
    """The aim that brings the tool to (x, y, z) along the axis (ax, ay, az)."""
    return ToolPose(x - shape.tool * ax, y - shape.tool * ay, z - shape.tool * az, ax, ay, az)


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def beside(aim: ToolPose, radius: float, number: int) -> ToolPose:
    """The aim itself (0), or one beside it on a circle: ahead, back, left or right (1 to 4)."""
    dx = radius if number == 1 else -radius if number == 2 else 0.0
    dy = radius if number == 3 else -radius if number == 4 else 0.0
    return ToolPose(aim.x + dx, aim.y + dy, aim.z, aim.ax, aim.ay, aim.az)


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def is_within_length(shape: ArmShape, aim: ToolPose) -> bool:
    """Whether the wrist is no further from the lift axis than the arm is long; limits aside."""
    outward = math.hypot(aim.x, aim.y) - shape.offset
    length = shape.upper + shape.fore
    return outward * outward + aim.z * aim.z <= length * length


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def is_within_height(shape: ArmShape, aim: ToolPose) -> bool:
    """Whether the wrist is no higher than the forearm could stick up from the highest elbow, and no lower; roughly."""
    highest = shape.fore - shape.upper * shape.lift.sin_low
    lowest = -shape.fore - shape.upper * shape.lift.sin_high
    return lowest <= aim.z <= highest
