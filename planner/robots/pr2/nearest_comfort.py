"""The distance of a point from the comfort radius: computed for explanations, after planning has failed. Compiled.

The places within the comfort radius of an approach form no simple region: limits cut slivers into it. Doubling steps
leap over those and would then call a far place the nearest. So the search goes outwards in thin shells, along all
directions and approaches and from all places of the base at once, and ends in the first shell that has a place within
the comfort radius. Only there is each find refined by bisection, and a line is skipped if it is not within the radius
where it would beat the best so far. A lower bound (`planner.robots.pr2.arm_gap`) makes this cheap: shells within it are
skipped, line by line, and so are cells in which the body is known to leave the arm no room.

From dozens of places of the base, in dozens of approaches, a search can take half a second. So it is handed out in
pieces, and the caller looks at the time between them.

Points are seen from the left arm's shoulder (m), parallel to the base.
"""

import math
from typing import NamedTuple

import numpy as np

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.pr2.aim import ToolPose, aim_at
from planner.robots.pr2.arm import ArmShape
from planner.robots.pr2.arm_gap import comfort_gap
from planner.robots.pr2.closed_comfort import is_comfortable
from planner.robots.pr2.posture_room import blocked_for
from planner.robots.pr2.requirements import (
    Requirements,
    Scratch,
    aim_of,
    aims_gap,
    meets_query,
    rooms_tested,
    scratch_for,
)

SHELL_M, WIDENING = 0.002, 0.03
"""Thickness of a shell (m), or as a fraction of its distance where that is more."""

FINEST_M = 0.001
"""Precision at which the bisection ends (m)."""

PIECE_QUERIES = 60_000
"""Queries in a piece of the search: a tenth of a second."""

ROOM_QUERIES = 100
"""The queries that take as long as a test of whether the body leaves the arm room in a cell."""

MANY_QUERIES = 1 << 62
"""More queries than any search makes."""


class DirectionSearch(NamedTuple):
    """The progress of a search along its lines: from each place, in each approach, along each direction.

    Attributes:
        hopeless: displacements up to which a line has nothing to offer (m), shape (n, k, m).
        nearest: lower bounds on the displacement of each place in each approach (m), shape (n, k).
        inner: the displacement up to which all has been searched (m), shape (1,).
    """

    hopeless: FloatArray
    nearest: FloatArray
    inner: FloatArray


@kernel
def _aim_along(shape: ArmShape, axis: FloatArray, point: FloatArray, far: float, towards: FloatArray) -> ToolPose:
    """Return the tool pose that brings the tool to a point displaced along a direction."""
    x, y, z = point[0] + far * towards[0], point[1] + far * towards[1], point[2] + far * towards[2]
    return aim_at(shape, x, y, z, axis[0], axis[1], axis[2])


@kernel
def directions_from(
    shape: ArmShape, query: Requirements, points: FloatArray, directions: FloatArray
) -> DirectionSearch:
    """Return the lines of a search that has not begun; see `nearest_comfort` for the arguments."""
    hopeless = np.empty((len(points), len(query.axes), len(directions)))
    for place in range(len(points)):
        for approach in range(len(query.axes)):
            hopeless[place, approach] = aims_gap(shape, query, points[place], approach)
    return DirectionSearch(hopeless, hopeless[:, :, 0].copy(), np.zeros(1))


@kernel
def nearest_comfort(
    shape: ArmShape,
    query: Requirements,
    points: FloatArray,
    directions: FloatArray,
    furthest: float,
    lines: DirectionSearch,
    most: int,
) -> tuple[float, int, int, int, int]:
    """Return the smallest displacement along one of the directions that brings the tool within the comfort radius.

    Args:
        shape: the arm.
        query: the requirements on the place.
        points: one place of the tool as seen from several places of the base, shape (n, 3); within the comfort radius
            from none.
        directions: unit vectors, shape (m, 3).
        furthest: the furthest displacement searched (m); the last shell is searched whole.
        lines: how far the search has come; kept up to date.
        most: the work after which the search is interrupted, at the end of a shell, in queries.

    Returns:
        The displacement (m), rounded up to `FINEST_M`; the point; the approach; the direction; queries made. Infinity,
        -1, -1, -1 where there is none, or none yet. Places narrower than a shell may be overlooked.
    """
    scratch, comfort, hopeless, nearest = scratch_for(shape), query.comfort, lines.hopeless, lines.nearest
    best, best_place, best_approach, best_direction, queries = math.inf, -1, -1, -1, 0
    inner, tested = lines.inner[0], rooms_tested(query)
    while inner < furthest and best_place < 0 and queries + ROOM_QUERIES * (rooms_tested(query) - tested) < most:
        limit = outer = inner + max(SHELL_M, WIDENING * inner)
        for place in range(len(points)):
            for approach in range(len(query.axes)):
                if nearest[place, approach] >= limit:
                    continue
                start, axis = points[place], query.axes[approach]
                for direction in range(len(directions)):
                    near, far, towards = inner, limit, directions[direction]
                    if far <= max(near, hopeless[place, approach, direction]):
                        continue
                    aim = _aim_along(shape, axis, start, far, towards)
                    short = max(
                        comfort_gap(shape, aim, comfort),
                        blocked_for(query.room, query.labels[approach], aim, towards),
                    )
                    if short > 0.0:
                        hopeless[place, approach, direction] = far + short
                        continue
                    found, made = meets_query(shape, query, aim, approach, comfort, scratch)
                    queries += made
                    if not found:
                        continue
                    far, made = _nearest_on(shape, query, approach, start, towards, near, far, scratch)
                    queries += made
                    best, best_place, best_approach, best_direction = far, place, approach, direction
                    limit = far - FINEST_M
        inner = outer
    lines.inner[0] = inner
    return best, best_place, best_approach, best_direction, queries


@kernel
def _nearest_on(
    shape: ArmShape,
    query: Requirements,
    approach: int,
    start: FloatArray,
    towards: FloatArray,
    near: float,
    far: float,
    scratch: Scratch,
) -> tuple[float, int]:
    """Return the least displacement along a direction that meets the requirements, by bisection; queries made."""
    queries = 0
    while far - near > FINEST_M:
        middle = 0.5 * (near + far)
        aim = _aim_along(shape, query.axes[approach], start, middle, towards)
        found, made = meets_query(shape, query, aim, approach, query.comfort, scratch)
        queries += made
        near, far = (near, middle) if found else (middle, far)
    return far, queries


@kernel
def widest_comfort(shape: ArmShape, query: Requirements, points: FloatArray) -> tuple[float, int, int, int]:
    """Return the largest circle round a point on which the tool is still within reach.

    The point itself is not within the comfort radius wanted.

    Args:
        shape: the arm.
        query: the requirements on the place, with a comfort radius that is too large.
        points: one place of the tool as seen from several places of the base, shape (n, 3).

    Returns:
        The radius (m), rounded down to `FINEST_M`; the point; the approach; queries made. 0, -1, -1 where the place
        itself is out of reach.
    """
    scratch = scratch_for(shape)
    best, best_place, best_approach, queries = 0.0, -1, -1, 0
    for place in range(len(points)):
        for approach in range(len(query.axes)):
            near, far = best + (FINEST_M if best_place >= 0 else 0.0), query.comfort
            if near >= far:
                break
            aim = aim_of(shape, query, points[place], approach)
            if comfort_gap(shape, aim, 0.0) > 0.0:
                continue
            found, made = meets_query(shape, query, aim, approach, near, scratch)
            queries += made
            if not found:
                continue
            while far - near > FINEST_M:
                middle = 0.5 * (near + far)
                found, made = meets_query(shape, query, aim, approach, middle, scratch)
                queries += made
                near, far = (middle, far) if found else (near, middle)
            best, best_place, best_approach = near, place, approach
    return best, best_place, best_approach, queries


@kernel
def is_hindered(shape: ArmShape, query: Requirements, points: FloatArray) -> bool:
    """Return whether only the body prevents a place that the joints put within the comfort radius."""
    scratch = scratch_for(shape)
    for point in points:
        for approach in range(len(query.axes)):
            if aims_gap(shape, query, point, approach) <= 0.0:
                aim = aim_of(shape, query, point, approach)
                if is_comfortable(shape, aim, query.comfort, scratch.arcs, scratch.hint)[0]:
                    return True
    return False
