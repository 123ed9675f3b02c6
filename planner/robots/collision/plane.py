"""Search for a separating plane between two convex parts, compiled.

Let p and q be the points at which the parts come nearest along a direction d. If p is beyond q, a separating plane is
found. The differences p - q are points of the Minkowski difference of the parts, and the parts are apart if it does not
contain the origin. So the next direction is from the origin to the nearest point of the simplex of such differences, of
which only the nearest face is kept (Gilbert, Johnson and Keerthi, 1988). Once four of them enclose the origin, the
parts have a point in common and there is no plane.
"""

import math

import numpy as np

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.collision.part_poses import MIDDLE, PLACE, Index
from planner.robots.collision.simplex import Vector, are_round_origin, nearest_face

_DIRECTIONS = 32
"""Directions tried for a pair."""

_NEARER = 1e-9
"""The least share by which the square of the distance to the origin must fall from one direction to the next."""


@kernel
def _furthest(corners: FloatArray, first: int, last: int, x: float, y: float, z: float) -> int:
    """Return the corner furthest along a direction given in the corners' frame."""
    best, found = -math.inf, first
    for i in range(first, last):
        along = corners[i, 0] * x + corners[i, 1] * y + corners[i, 2] * z
        if along > best:
            best, found = along, i
    return found


@kernel
def _turned(poses: FloatArray, part: int, row: int, corners: FloatArray, corner: int) -> float:
    """Return one coordinate of a corner after a part's rotation."""
    turned: float = (
        poses[part, row, 0] * corners[corner, 0]
        + poses[part, row, 1] * corners[corner, 1]
        + poses[part, row, 2] * corners[corner, 2]
    )
    return turned


@kernel
def _nearest_along(
    corners: FloatArray, spans: Index, r: FloatArray, a: int, b: int, gap: float, x: float, y: float, z: float
) -> Vector:
    """Return the way from part b, with a gap (m), to part a, at their nearest points along a unit direction (m)."""
    ax = -(r[a, 0, 0] * x + r[a, 1, 0] * y + r[a, 2, 0] * z)
    ay = -(r[a, 0, 1] * x + r[a, 1, 1] * y + r[a, 2, 1] * z)
    az = -(r[a, 0, 2] * x + r[a, 1, 2] * y + r[a, 2, 2] * z)
    p = _furthest(corners, spans[a, 0], spans[a, 1], ax, ay, az)
    bx = r[b, 0, 0] * x + r[b, 1, 0] * y + r[b, 2, 0] * z
    by = r[b, 0, 1] * x + r[b, 1, 1] * y + r[b, 2, 1] * z
    bz = r[b, 0, 2] * x + r[b, 1, 2] * y + r[b, 2, 2] * z
    q = _furthest(corners, spans[b, 0], spans[b, 1], bx, by, bz)
    tx, ty, tz = r[a, PLACE, 0] - r[b, PLACE, 0], r[a, PLACE, 1] - r[b, PLACE, 1], r[a, PLACE, 2] - r[b, PLACE, 2]
    return (
        tx + _turned(r, a, 0, corners, p) - _turned(r, b, 0, corners, q) - gap * x,
        ty + _turned(r, a, 1, corners, p) - _turned(r, b, 1, corners, q) - gap * y,
        tz + _turned(r, a, 2, corners, p) - _turned(r, b, 2, corners, q) - gap * z,
    )


@kernel
def room_at_plane(corners: FloatArray, spans: Index, r: FloatArray, a: int, b: int, gap: float, way: Vector) -> float:
    """Return by how much more than a gap parts b and a are apart at a separating plane (m); -1 if there is none.

    The search starts along `way`.

    Args:
        corners: the corners of all hulls, each in its part's frame (m), shape (c, 3).
        spans: the number of each part's first corner, and of the one after its last, shape (p, 2).
        r: the parts' poses, shape (p, 5, 3), see `planner.robots.collision.part_poses`.
        a: the first part.
        b: the second part.
        gap: the distance that their hulls should keep (m).
        way: the rough direction from b to a (m); zero if nothing is known.
    """
    dx, dy, dz = way
    if dx == 0.0 and dy == 0.0 and dz == 0.0:
        dx, dy, dz = (
            r[a, MIDDLE, 0] - r[b, MIDDLE, 0],
            r[a, MIDDLE, 1] - r[b, MIDDLE, 1],
            r[a, MIDDLE, 2] - r[b, MIDDLE, 2],
        )
    points, count, least = np.empty((4, 3)), 0, math.inf
    for _ in range(_DIRECTIONS):
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        if length == 0.0:
            break
        dx, dy, dz = dx / length, dy / length, dz / length
        wx, wy, wz = _nearest_along(corners, spans, r, a, b, gap, dx, dy, dz)
        along: float = wx * dx + wy * dy + wz * dz
        if along > 0.0:
            return along
        points[count, 0], points[count, 1], points[count, 2] = wx, wy, wz
        count += 1
        if count == 4 and are_round_origin(points):
            break
        count, (dx, dy, dz) = nearest_face(points, count)
        squared = dx * dx + dy * dy + dz * dz
        if squared >= (1.0 - _NEARER) * least:
            break
        least = squared
    return -1.0
