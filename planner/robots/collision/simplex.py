"""The point nearest to the origin of up to three points' hull, compiled, and whether four points enclose the origin."""

import math
from typing import TypeAlias

from planner.geometry.pose import FloatArray
from planner.kernels import kernel

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
