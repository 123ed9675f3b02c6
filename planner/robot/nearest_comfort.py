"""How far is a point from comfort? A question for people, asked once a plan has failed, compiled.

The comfortable places of an approach are no simple region: limits cut slivers and notches into them. Doubling
steps leap over those and would then call a far place the nearest. So the search goes outwards in shells of
`SHELL_M`, along all directions and approaches at once, and ends in the first shell that has a comfortable
place. Only there is each find settled by halving, and a line that is not comfortable where it would beat the
best so far is left at that. Where the wrist is beyond the arm's length, all shells that it cannot get back from
within are skipped: that makes far points, the most frequent ones, cheap.

Points are seen from the left arm's shoulder (m), parallel to the base.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from planner.geometry.pose import FloatArray
from planner.robot.arm import ArmShape
from planner.robot.back_offs import is_comfortable
from planner.robot.kernel import MOST_ARCS, Aim, aim_at

SHELL_M = 0.005
"""From one shell to the next."""

FINEST_M = 0.001
"""Halving ends here."""


class Line(NamedTuple):
    """A line along which a point is displaced in one approach.

    Attributes:
        start: the point itself, shape (3,).
        direction: a unit vector, shape (3,).
        axis: the approach axis, shape (3,).
    """

    start: FloatArray
    direction: FloatArray
    axis: FloatArray


@njit(cache=True, nogil=True)
def beyond_length(shape: ArmShape, aim: Aim) -> float:
    """How far the wrist is beyond the arm's length (m), negative within it.

    To displace it by less than that is no use.
    """
    outward = math.hypot(aim.x, aim.y) - shape.offset
    return math.hypot(outward, aim.z) - (shape.upper + shape.fore)


@njit(cache=True, nogil=True)
def _aim_along(shape: ArmShape, line: Line, distance: float) -> Aim:
    """The aim at a distance along a line."""
    start, direction, axis = line.start, line.direction, line.axis
    x, y = start[0] + distance * direction[0], start[1] + distance * direction[1]
    return aim_at(shape, x, y, start[2] + distance * direction[2], axis[0], axis[1], axis[2])


@njit(cache=True, nogil=True)
def nearest_comfort(
    shape: ArmShape, point: FloatArray, axes: FloatArray, directions: FloatArray, comfort: float, furthest: float
) -> tuple[float, int, int, int]:
    """The smallest displacement along one of the directions that brings the tool into comfort.

    Args:
        shape: the arm.
        point: the tool's place, shape (3,), itself not in comfort.
        axes: approach axes, shape (k, 3).
        directions: unit vectors, shape (m, 3).
        comfort: radius of the comfort circle (m).
        furthest: how far to look (m).

    Returns:
        The displacement (m), to `FINEST_M` and rather too long; the approach; the direction; queries made.
        Infinity, -1, -1 where there is none. Places narrower than `SHELL_M` may be overlooked.
    """
    arcs = np.empty((MOST_ARCS, 2))
    hint = np.array([0.5 * (shape.pan.low + shape.pan.high)])
    hopeless = np.zeros((len(axes), len(directions)))
    best, best_approach, best_direction, queries = math.inf, -1, -1, 0
    for shell in range(round(furthest / SHELL_M)):
        limit = (shell + 1) * SHELL_M
        for approach in range(len(axes)):
            for direction in range(len(directions)):
                near, far = shell * SHELL_M, limit
                if far <= max(near, hopeless[approach, direction]):
                    continue
                line = Line(point, directions[direction], axes[approach])
                aim = _aim_along(shape, line, far)
                beyond = beyond_length(shape, aim)
                if beyond > 0.0:
                    hopeless[approach, direction] = far + beyond
                    continue
                found, asked = is_comfortable(shape, aim, comfort, arcs, hint)
                queries += asked
                if not found:
                    continue
                while far - near > FINEST_M:
                    middle = 0.5 * (near + far)
                    found, asked = is_comfortable(shape, _aim_along(shape, line, middle), comfort, arcs, hint)
                    queries += asked
                    near, far = (near, middle) if found else (middle, far)
                best, best_approach, best_direction = far, approach, direction
                limit = far - FINEST_M
        if best_approach >= 0:
            break
    return best, best_approach, best_direction, queries


@njit(cache=True, nogil=True)
def widest_comfort(shape: ArmShape, point: FloatArray, axes: FloatArray, comfort: float) -> tuple[float, int, int]:
    """The largest circle round a point on which the tool still is in comfort, the point itself not being so.

    Args:
        shape: the arm.
        point: the tool's place, shape (3,).
        axes: approach axes, shape (k, 3).
        comfort: the radius that is too large (m).

    Returns:
        The radius (m), to `FINEST_M` and rather too small; the approach; queries made. 0, -1 where the
        point itself is out of reach.
    """
    arcs = np.empty((MOST_ARCS, 2))
    hint = np.array([0.5 * (shape.pan.low + shape.pan.high)])
    best, best_approach, queries = 0.0, -1, 0
    for approach in range(len(axes)):
        near, far = best + (FINEST_M if best_approach >= 0 else 0.0), comfort
        if near >= far:
            break
        axis = axes[approach]
        aim = aim_at(shape, point[0], point[1], point[2], axis[0], axis[1], axis[2])
        found, asked = is_comfortable(shape, aim, near, arcs, hint)
        queries += asked
        if not found:
            continue
        while far - near > FINEST_M:
            middle = 0.5 * (near + far)
            found, asked = is_comfortable(shape, aim, middle, arcs, hint)
            queries += asked
            near, far = (middle, far) if found else (near, middle)
        best, best_approach = near, approach
    return best, best_approach, queries
