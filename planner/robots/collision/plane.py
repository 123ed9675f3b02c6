"""Search for a separating plane between two convex parts, compiled.

Let p and q be the points at which the parts come nearest along a direction d. If p is beyond q, a separating plane is
found. The differences p - q are points of the Minkowski difference of the parts, and the parts are apart if it does not
contain the origin. So the next direction is from the origin to the nearest point of the simplex of such differences, of
which only the nearest face is kept (Gilbert, Johnson and Keerthi, 1988). Once four of them enclose the origin, the
parts have a point in common and there is no plane.
"""

import math
from typing import TypeAlias

import numpy as np

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.collision.part_poses import MIDDLE, PLACE, Index

Vector: TypeAlias = tuple[float, float, float]

_FLAT_M3 = 1e-12
"""Six times the volume of a tetrahedron below which rounding decides what is inside (m3)."""

_SLIM = 1e-12
"""The squared sine of a triangle's angle below which its points count as being on one line."""


@kernel
def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def _volume(a: Vector, b: Vector, c: Vector) -> float:
    """Return six times the signed volume of the tetrahedron of the origin and three points (m3)."""
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])


@kernel
def _row(points: FloatArray, number: int) -> Vector:
    return points[number, 0], points[number, 1], points[number, 2]


@kernel
def are_round_origin(points: FloatArray) -> bool:
    """Return whether the origin is inside the tetrahedron of four points, shape (4, 3)."""
    a, b, c, d = _row(points, 0), _row(points, 1), _row(points, 2), _row(points, 3)
    abc, acd, adb, bdc = _volume(a, b, c), _volume(a, c, d), _volume(a, d, b), _volume(b, d, c)
    return min(abc, acd, adb, bdc) > _FLAT_M3 or max(abc, acd, adb, bdc) < -_FLAT_M3


@kernel
def _on_line(a: Vector, b: Vector) -> tuple[bool, Vector]:
    """Return whether the point of a line nearest to the origin is between two of its points, and that point."""
    e = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
    square = _dot(e, e)
    along = -_dot(a, e) / square if square > 0.0 else 0.0
    return 0.0 < along < 1.0, (a[0] + along * e[0], a[1] + along * e[1], a[2] + along * e[2])


@kernel
def _in_plane(a: Vector, b: Vector, c: Vector) -> tuple[bool, Vector]:
    """Return whether the point of a plane nearest to the origin is between three of its points, and that point."""
    e, f = (b[0] - a[0], b[1] - a[1], b[2] - a[2]), (c[0] - a[0], c[1] - a[1], c[2] - a[2])
    ee, ff, ef, ae, af = _dot(e, e), _dot(f, f), _dot(e, f), -_dot(a, e), -_dot(a, f)
    square = ee * ff - ef * ef
    if square <= _SLIM * ee * ff:
        return False, a
    s, t = (ae * ff - af * ef) / square, (af * ee - ae * ef) / square
    found = (a[0] + s * e[0] + t * f[0], a[1] + s * e[1] + t * f[1], a[2] + s * e[2] + t * f[2])
    return s > 0.0 and t > 0.0 and s + t < 1.0, found


@kernel
def nearest_face(points: FloatArray, count: int) -> tuple[int, Vector]:
    """Keep the points of the face nearest to the origin; return how many, and the point of it that is nearest.

    Args:
        points: the points (m), shape (4, 3); those kept come first.
        count: how many there are.
    """
    best, least, nearest = 0, math.inf, (0.0, 0.0, 0.0)
    for i in range(count):
        a = _row(points, i)
        if _dot(a, a) < least:
            best, least, nearest = 1 << i, _dot(a, a), a
        for j in range(i):
            b = _row(points, j)
            is_between, found = _on_line(a, b)
            if is_between and _dot(found, found) < least:
                best, least, nearest = 1 << i | 1 << j, _dot(found, found), found
            for k in range(j):
                is_between, found = _in_plane(a, b, _row(points, k))
                if is_between and _dot(found, found) < least:
                    best, least, nearest = 1 << i | 1 << j | 1 << k, _dot(found, found), found
    kept = 0
    for number in range(count):
        if (best >> number) & 1:
            for axis in range(3):
                points[kept, axis] = points[number, axis]
            kept += 1
    return kept, nearest


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
def room_at_plane(
    corners: FloatArray, spans: Index, r: FloatArray, a: int, b: int, gap: float, way: Vector, wanted: float
) -> float:
    """Return by how much more than a gap parts b and a are apart at a separating plane (m); -1 if there is none.

    The search starts along `way`, and ends once they are apart by as much as is wanted, or no plane is better.

    Args:
        corners: the corners of all hulls, each in its part's frame (m), shape (c, 3).
        spans: the number of each part's first corner, and of the one after its last, shape (p, 2).
        r: the parts' poses, shape (p, 5, 3), see `planner.robots.collision.part_poses`.
        a: the first part.
        b: the second part.
        gap: the distance that their hulls should keep (m).
        way: the rough direction from b to a (m); zero if nothing is known.
        wanted: by how much more (m), at least 0.
    """
    dx, dy, dz = way
    if dx == 0.0 and dy == 0.0 and dz == 0.0:
        dx, dy, dz = (
            r[a, MIDDLE, 0] - r[b, MIDDLE, 0],
            r[a, MIDDLE, 1] - r[b, MIDDLE, 1],
            r[a, MIDDLE, 2] - r[b, MIDDLE, 2],
        )
    points, count, least, best = np.empty((4, 3)), 0, math.inf, -1.0
    for _ in range(_DIRECTIONS):
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        if length == 0.0:
            break
        dx, dy, dz = dx / length, dy / length, dz / length
        wx, wy, wz = _nearest_along(corners, spans, r, a, b, gap, dx, dy, dz)
        along: float = wx * dx + wy * dy + wz * dz
        best = max(best, along) if along > 0.0 else best
        if best > wanted:
            return best
        points[count, 0], points[count, 1], points[count, 2] = wx, wy, wz
        count += 1
        if count == 4 and are_round_origin(points):
            break
        count, (dx, dy, dz) = nearest_face(points, count)
        squared = dx * dx + dy * dy + dz * dz
        if squared >= (1.0 - _NEARER) * least:
            break
        least = squared
    return best
