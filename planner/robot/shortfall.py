"""Why is a place not in comfortable reach of the left arm, and by how much?

Everything is seen from its shoulder (m), parallel to the base. The base may stand in several places: the place is given
as it is seen from each.
"""

import math

import numpy as np

from planner.geometry.pose import FloatArray, Point3
from planner.geometry.shortfall import Cause, Shortfall
from planner.robot.arm import ArmShape
from planner.robot.kernel import reachable_batch
from planner.robot.limiting_joint import limiting_joint
from planner.robot.nearest_comfort import Wanted, aims_gap, is_hindered, nearest_comfort, widest_comfort

FURTHEST_M = 0.8
"""No displacement further than this is tried."""

SIDEWAYS = 0.1
"""A displacement that changes the distance to the shoulder by less than this part of it leads sideways."""

_STRAIGHT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
_SLANTING = tuple((x * math.sqrt(0.5), y * math.sqrt(0.5), 0.0) for x in (1.0, -1.0) for y in (1.0, -1.0))
DIRECTIONS = np.array((*_STRAIGHT, *_SLANTING, (0.0, 0.0, -1.0), (0.0, 0.0, 1.0)))
"""The directions in which a point is displaced: eight horizontal ones, straight down and straight up."""

_RING = np.array(_STRAIGHT)


def left_shortfall(shape: ArmShape, wanted: Wanted, points: FloatArray, at_most_m: float) -> tuple[Shortfall, int]:
    """The shortfall of a place that is in comfort from nowhere, and the queries made.

    Args:
        shape: the arm.
        wanted: what is asked of the place, at least one approach; the shortfall's `approach` is an index into them.
        points: the tool's place as seen from each place of the base, shape (n, 3).
        at_most_m: no displacement longer than this, or than `FURTHEST_M`, is tried.
    """
    furthest = min(at_most_m, FURTHEST_M)
    short_by_m, seen_from, approach, direction, queries = nearest_comfort(shape, wanted, points, DIRECTIONS, furthest)
    comfort, widest_from, widest_approach, more = widest_comfort(shape, wanted, points)
    queries += more
    is_at_least = seen_from < 0
    if is_at_least:
        seen_from, approach, short_by_m = _nearest_by_length(shape, wanted, points, furthest)
    point, axis = points[seen_from], wanted.axes[approach]
    towards = _homewards(point) if is_at_least else DIRECTIONS[direction]
    joint, comfort_m = limiting_joint(shape, point, axis), None
    cause: Cause = "too_far" if is_at_least else _cause(point, point - shape.tool * axis, towards, short_by_m)
    if widest_from >= 0:
        cause, comfort_m = "comfort_only", comfort
        joint = _missed_on_ring(shape, points[widest_from], wanted.axes[widest_approach], wanted.comfort)
        queries += len(_RING)
    elif is_hindered(shape, wanted, points):
        cause, joint = "own_body", None
    return Shortfall(cause, joint, short_by_m, is_at_least, _as_point(towards), approach, seen_from, comfort_m), queries


def _missed_on_ring(shape: ArmShape, point: FloatArray, axis: FloatArray, comfort_m: float) -> str | None:
    """The joint that limits at a place of the comfort circle that is out of reach."""
    ring = point + comfort_m * _RING
    missed = ring[~reachable_batch(shape, ring, np.repeat(axis[None], len(ring), axis=0))]
    return limiting_joint(shape, missed[0] if len(missed) else point, axis)


def _cause(point: FloatArray, wrist: FloatArray, towards: FloatArray, short_by_m: float) -> Cause:
    """Why a point is out of reach that a displacement brings into it.

    One whose wrist is above the shoulder and that must come down is too far, even where the tool hangs below.
    """
    further_m = np.linalg.norm(point + short_by_m * towards) - np.linalg.norm(point)
    is_too_high = towards[2] < 0.0 and wrist[2] > 0.0
    if is_too_high or further_m < -SIDEWAYS * short_by_m:
        return "too_far"
    return "too_near" if further_m > SIDEWAYS * short_by_m else "joint_limit"


def _nearest_by_length(shape: ArmShape, wanted: Wanted, points: FloatArray, furthest: float) -> tuple[int, int, float]:
    """Of a place that no displacement brings into comfort: from where and how it is nearest, and a bound.

    It is short by at least what its wrist is beyond the arm (`planner.robot.arm_gap`), and by at least `furthest` in
    the directions tried: the larger of the two is given.
    """
    approaches = range(len(wanted.axes))
    gaps = np.array([[aims_gap(shape, wanted, point, approach) for approach in approaches] for point in points])
    seen_from, approach = np.unravel_index(int(gaps.argmin()), gaps.shape)
    return int(seen_from), int(approach), max(float(gaps.min()), furthest)


def _homewards(point: FloatArray) -> FloatArray:
    """The unit direction to the shoulder; straight ahead from the shoulder itself."""
    distance = float(np.linalg.norm(point))
    return -point / distance if distance > 0.0 else DIRECTIONS[0]


def _as_point(direction: FloatArray) -> Point3:
    x, y, z = (float(component) for component in direction)
    return x, y, z
