"""The shortfall of a place that is not within the left arm's comfort radius, and its cause.

Everything is seen from the arm's shoulder (m), parallel to the base. The base may stand in several places: the place is
given as it is seen from each.
"""

import numpy as np

from planner.deadline import Deadline
from planner.geometry.pose import FloatArray, point3
from planner.geometry.reach_query import Cause, Shortfall
from planner.robots.displacements import DIRECTIONS, FURTHEST_M, STRAIGHT, cause_of, homewards
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.kernel import limiting_joint, reachable_batch
from planner.robots.pr2.nearest_comfort import (
    PIECE_QUERIES,
    directions_from,
    is_hindered,
    nearest_comfort,
    widest_comfort,
)
from planner.robots.pr2.requirements import Requirements, aims_gap

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
    is_too_high = towards[2] < 0.0 and wrist[2] > 0.0
    return "too_far" if is_too_high else cause_of(point, towards, short_by_m)


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
