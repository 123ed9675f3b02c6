"""The distance of a point from the comfort radius: computed for explanations, after planning has failed. Compiled.

The places within the comfort radius of an approach form no simple region: limits cut slivers into it. Doubling steps
leap over those and would then call a far place the nearest. So the search goes outwards in thin shells, along all
directions and approaches and from all places of the base at once, and ends in the first shell that has a place within
the comfort radius. Only there is each find refined by bisection, and a line is skipped if it is not within the radius
where it would beat the best so far. A lower bound (`planner.robots.arm_gap`) makes this cheap: shells within it are
skipped, line by line.

Points are seen from the left arm's shoulder (m), parallel to the base.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.robots.aim import ToolPose, aim_at
from planner.robots.arm import ArmShape
from planner.robots.arm_gap import comfort_gap
from planner.robots.closed_comfort import is_comfortable
from planner.robots.pan_arcs import MOST_ARCS
from planner.robots.posture_room import Room, has_room_about

SHELL_M, WIDENING = 0.002, 0.03
"""Thickness of a shell (m), or as a fraction of its distance where that is more."""

FINEST_M = 0.001
"""Precision at which the bisection ends (m)."""


class Wanted(NamedTuple):
    """The requirements on a place.

    Attributes:
        axes: the approach axes allowed, shape (k, 3).
        labels: the labels of the axes in the room's memory, shape (k,).
        comfort: the comfort radius (m).
        room: the obstacles to the arm's postures.
    """

    axes: FloatArray
    labels: NDArray[np.int64]
    comfort: float
    room: Room


class Scratch(NamedTuple):
    """Scratch space.

    Attributes:
        arcs: shape (MOST_ARCS, 2).
        hint: the pan that served last (rad), and its branch, shape (2,).
    """

    arcs: FloatArray
    hint: FloatArray


@njit(cache=True, nogil=True)
def _scratch(shape: ArmShape) -> Scratch:
    return Scratch(np.empty((MOST_ARCS, 2)), np.array([0.5 * (shape.pan.low + shape.pan.high), 1.0]))


@njit(cache=True, nogil=True)
def _aim(shape: ArmShape, wanted: Wanted, point: FloatArray, approach: int) -> ToolPose:
    """Return the tool pose that brings the tool to a point in an approach."""
    axis = wanted.axes[approach]
    return aim_at(shape, point[0], point[1], point[2], axis[0], axis[1], axis[2])


@njit(cache=True, nogil=True)
def aims_gap(shape: ArmShape, wanted: Wanted, point: FloatArray, approach: int) -> float:
    """Return a lower bound on how far a tool point is from the comfort radius (m), see `comfort_gap`."""
    return comfort_gap(shape, _aim(shape, wanted, point, approach), wanted.comfort)


@njit(cache=True, nogil=True)
def _is_wanted(
    shape: ArmShape, wanted: Wanted, point: FloatArray, approach: int, comfort: float, scratch: Scratch
) -> tuple[bool, int]:
    """Return whether a tool point meets the requirements in an approach, with a comfort radius; queries made."""
    aim = _aim(shape, wanted, point, approach)
    found, queries = is_comfortable(shape, aim, comfort, scratch.arcs, scratch.hint)
    return found and has_room_about(shape, wanted.room, wanted.labels[approach], aim, scratch.arcs), queries


@njit(cache=True, nogil=True)
def nearest_comfort(
    shape: ArmShape, wanted: Wanted, points: FloatArray, directions: FloatArray, furthest: float
) -> tuple[float, int, int, int, int]:
    """Return the smallest displacement along one of the directions that brings the tool within the comfort radius.

    Args:
        shape: the arm.
        wanted: the requirements on the place.
        points: one place of the tool as seen from several places of the base, shape (n, 3); within the comfort radius
            from none.
        directions: unit vectors, shape (m, 3).
        furthest: the furthest displacement searched (m); the last shell is searched whole.

    Returns:
        The displacement (m), rounded up to `FINEST_M`; the point; the approach; the direction; queries made. Infinity,
        -1, -1, -1 where there is none. Places narrower than a shell may be overlooked.
    """
    scratch, comfort, axes = _scratch(shape), wanted.comfort, wanted.axes
    hopeless = np.empty((len(points), len(axes), len(directions)))
    for place in range(len(points)):
        for approach in range(len(axes)):
            hopeless[place, approach] = aims_gap(shape, wanted, points[place], approach)
    nearest = hopeless[:, :, 0].copy()
    best, best_place, best_approach, best_direction, queries = math.inf, -1, -1, -1, 0
    inner = 0.0
    while inner < furthest and best_place < 0:
        limit = outer = inner + max(SHELL_M, WIDENING * inner)
        for place in range(len(points)):
            for approach in range(len(axes)):
                if nearest[place, approach] >= limit:
                    continue
                for direction in range(len(directions)):
                    near, far = inner, limit
                    if far <= max(near, hopeless[place, approach, direction]):
                        continue
                    start, towards = points[place], directions[direction]
                    short = aims_gap(shape, wanted, start + far * towards, approach)
                    if short > 0.0:
                        hopeless[place, approach, direction] = far + short
                        continue
                    found, asked = _is_wanted(shape, wanted, start + far * towards, approach, comfort, scratch)
                    queries += asked
                    if not found:
                        continue
                    while far - near > FINEST_M:
                        middle = 0.5 * (near + far)
                        found, asked = _is_wanted(shape, wanted, start + middle * towards, approach, comfort, scratch)
                        queries += asked
                        near, far = (near, middle) if found else (middle, far)
                    best, best_place, best_approach, best_direction = far, place, approach, direction
                    limit = far - FINEST_M
        inner = outer
    return best, best_place, best_approach, best_direction, queries


@njit(cache=True, nogil=True)
def least_worst(
    shape: ArmShape, wanted: Wanted, places: FloatArray, directions: FloatArray, furthest: float
) -> tuple[float, int, int]:
    """Return the worst of several places that are all to be reached in one approach, in the best approach for it.

    Args:
        shape: the arm.
        wanted: the requirements on each place.
        places: places of the tool, each as seen from several places of the base, shape (p, n, 3).
        directions: unit vectors, shape (m, 3).
        furthest: displacements as long as this no longer matter (m).

    Returns:
        How far the worst place must be displaced (m), its index, and the approach; 0, -1 and the approach where all are
        within the comfort radius; infinity, -1 and the approach that is nearest by length where none is better than
        `furthest`.
    """
    scratch = _scratch(shape)
    gaps = np.full((len(wanted.axes), len(places)), math.inf)
    for approach in range(len(wanted.axes)):
        for place in range(len(places)):
            for point in places[place]:
                short = aims_gap(shape, wanted, point, approach)
                gaps[approach, place] = min(gaps[approach, place], max(short, 0.0))
    bounds = np.array([row.max() for row in gaps])
    order = np.argsort(bounds)
    best, best_place, best_approach = math.inf, -1, int(order[0])
    for approach in order:
        limit = min(best, furthest)
        if bounds[approach] >= limit:
            break
        only = slice(approach, approach + 1)
        alone = Wanted(wanted.axes[only], wanted.labels[only], wanted.comfort, wanted.room)
        worst, worst_place = 0.0, -1
        for place in np.argsort(-gaps[approach]):
            if not _is_had(shape, alone, places[place], scratch):
                short = nearest_comfort(shape, alone, places[place], directions, limit)[0]
                if short > worst:
                    worst, worst_place = short, place
                if worst >= limit:
                    break
        if worst < limit:
            best, best_place, best_approach = worst, worst_place, approach
        if best <= 0.0:
            break
    return best, best_place, best_approach


@njit(cache=True, nogil=True)
def _is_had(shape: ArmShape, wanted: Wanted, points: FloatArray, scratch: Scratch) -> bool:
    """Return whether a place is within the comfort radius in the first approach, from some place of the base."""
    for point in points:
        if aims_gap(shape, wanted, point, 0) <= 0.0 and _is_wanted(shape, wanted, point, 0, wanted.comfort, scratch)[0]:
            return True
    return False


@njit(cache=True, nogil=True)
def widest_comfort(shape: ArmShape, wanted: Wanted, points: FloatArray) -> tuple[float, int, int, int]:
    """Return the largest circle round a point on which the tool is still within reach.

    The point itself is not within the comfort radius wanted.

    Args:
        shape: the arm.
        wanted: the requirements on the place, with a comfort radius that is too large.
        points: one place of the tool as seen from several places of the base, shape (n, 3).

    Returns:
        The radius (m), rounded down to `FINEST_M`; the point; the approach; queries made. 0, -1, -1 where the place
        itself is out of reach.
    """
    scratch = _scratch(shape)
    bare = Wanted(wanted.axes, wanted.labels, 0.0, wanted.room)
    best, best_place, best_approach, queries = 0.0, -1, -1, 0
    for place in range(len(points)):
        for approach in range(len(wanted.axes)):
            near, far = best + (FINEST_M if best_place >= 0 else 0.0), wanted.comfort
            if near >= far:
                break
            point = points[place]
            if aims_gap(shape, bare, point, approach) > 0.0:
                continue
            found, asked = _is_wanted(shape, wanted, point, approach, near, scratch)
            queries += asked
            if not found:
                continue
            while far - near > FINEST_M:
                middle = 0.5 * (near + far)
                found, asked = _is_wanted(shape, wanted, point, approach, middle, scratch)
                queries += asked
                near, far = (middle, far) if found else (near, middle)
            best, best_place, best_approach = near, place, approach
    return best, best_place, best_approach, queries


@njit(cache=True, nogil=True)
def is_hindered(shape: ArmShape, wanted: Wanted, points: FloatArray) -> bool:
    """Return whether only the body prevents a place that the joints put within the comfort radius."""
    scratch = _scratch(shape)
    for point in points:
        for approach in range(len(wanted.axes)):
            if aims_gap(shape, wanted, point, approach) <= 0.0:
                aim = _aim(shape, wanted, point, approach)
                if is_comfortable(shape, aim, wanted.comfort, scratch.arcs, scratch.hint)[0]:
                    return True
    return False
