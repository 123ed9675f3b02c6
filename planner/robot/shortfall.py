"""Why is a point not in comfortable reach of the left arm, and by how much?

Everything is seen from its shoulder (m), parallel to the base.
"""

import math

import numpy as np

from planner.geometry.pose import FloatArray, Point3
from planner.geometry.shortfall import Cause, Shortfall
from planner.robot.arm import ArmShape
from planner.robot.kernel import aim_at, reachable_batch
from planner.robot.limiting_joint import limiting_joint
from planner.robot.nearest_comfort import beyond_length, nearest_comfort, widest_comfort

FURTHEST_M = 0.8
"""No displacement further than this is tried."""

SIDEWAYS = 0.1
"""A displacement that changes the distance to the shoulder by less than this part of it leads sideways."""

_STRAIGHT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
_SLANTING = tuple((x * math.sqrt(0.5), y * math.sqrt(0.5), 0.0) for x in (1.0, -1.0) for y in (1.0, -1.0))
DIRECTIONS = np.array((*_STRAIGHT, *_SLANTING, (0.0, 0.0, -1.0), (0.0, 0.0, 1.0)))
"""The directions in which a point is displaced: eight horizontal ones, straight down and straight up."""

_RING = np.array(_STRAIGHT)


def left_shortfall(shape: ArmShape, point: FloatArray, axes: FloatArray, comfort_m: float) -> tuple[Shortfall, int]:
    """The shortfall of a point that is not in comfort, and the queries made.

    Args:
        shape: the arm.
        point: the tool's place, shape (3,).
        axes: approach axes, shape (k, 3), at least one; the shortfall's `approach` is an index into them.
        comfort_m: the comfort radius.
    """
    radius_m, approach, queries = widest_comfort(shape, point, axes, comfort_m)
    if approach >= 0:
        shortfall, more = _of_comfort(shape, point, axes, comfort_m, radius_m, approach)
        return shortfall, queries + more
    short_by_m, approach, direction, more = nearest_comfort(shape, point, axes, DIRECTIONS, comfort_m, FURTHEST_M)
    queries += more
    if approach < 0:
        return _far_away(shape, point, axes), queries
    towards = DIRECTIONS[direction]
    cause = _cause(point, point - shape.tool * axes[approach], towards, short_by_m)
    joint = limiting_joint(shape, point, axes[approach])
    return Shortfall(cause, joint, short_by_m, _as_point(towards), approach), queries


def _of_comfort(
    shape: ArmShape, point: FloatArray, axes: FloatArray, comfort_m: float, radius_m: float, approach: int
) -> tuple[Shortfall, int]:
    """The shortfall where only a part of the comfort circle is out of reach, and the queries made."""
    axis = axes[approach]
    *_, direction, queries = nearest_comfort(
        shape, point, axes[approach : approach + 1], DIRECTIONS, comfort_m, FURTHEST_M
    )
    towards = DIRECTIONS[direction] if direction >= 0 else _homewards(point)
    ring = point + comfort_m * _RING
    missed = ring[~reachable_batch(shape, ring, np.repeat(axis[None], len(ring), axis=0))]
    joint = limiting_joint(shape, missed[0] if len(missed) else point, axis)
    shortfall = Shortfall("comfort_only", joint, comfort_m - radius_m, _as_point(towards), approach)
    return shortfall, queries + len(ring)


def _cause(point: FloatArray, wrist: FloatArray, towards: FloatArray, short_by_m: float) -> Cause:
    """Why a point is out of reach that a displacement brings into it.

    One whose wrist is above the shoulder and that must come down is too far, even where the tool hangs below.
    """
    further_m = np.linalg.norm(point + short_by_m * towards) - np.linalg.norm(point)
    is_too_high = towards[2] < 0.0 and wrist[2] > 0.0
    if is_too_high or further_m < -SIDEWAYS * short_by_m:
        return "too_far"
    return "too_near" if further_m > SIDEWAYS * short_by_m else "joint_limit"


def _far_away(shape: ArmShape, point: FloatArray, axes: FloatArray) -> Shortfall:
    """The shortfall of a point that no displacement brings into comfort.

    It is short by at least the distance by which the wrist is beyond the arm's length, and by at least
    `FURTHEST_M` in the directions tried: the larger of the two is given.
    """
    beyond_m = [float(beyond_length(shape, aim_at(shape, *point, *axis))) for axis in axes]
    approach = int(np.argmin(beyond_m))
    short_by_m = max(beyond_m[approach], FURTHEST_M)
    joint = limiting_joint(shape, point, axes[approach])
    return Shortfall("too_far", joint, short_by_m, _as_point(_homewards(point)), approach)


def _homewards(point: FloatArray) -> FloatArray:
    """The unit direction to the shoulder; straight ahead from the shoulder itself."""
    distance = float(np.linalg.norm(point))
    return -point / distance if distance > 0.0 else DIRECTIONS[0]


def _as_point(direction: FloatArray) -> Point3:
    x, y, z = (float(component) for component in direction)
    return x, y, z
