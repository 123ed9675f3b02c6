"""Make and repair shapely geometries before they become regions."""

from collections.abc import Iterable
from itertools import combinations

import shapely
from shapely.geometry.base import BaseGeometry

from planner.geometry.segment import Segment
from planner.geometry.tolerance import GRID_M, LENGTH_M

_FAR_M = 100.0
"""Distance beyond which nothing lies (m)."""

_TOUCH_M = 10 * LENGTH_M
"""Length of the contact below which two parts near to each other only touch (m)."""


def polygonal(shape: BaseGeometry) -> BaseGeometry:
    """Return the polygons of a shape; the intersection of polygons that only touch also has lines and points."""
    if isinstance(shape, shapely.Polygon | shapely.MultiPolygon):
        return shape
    parts = shapely.get_parts(shape)
    return shapely.union_all(parts[shapely.get_dimensions(parts) == 2])


def united(shapes: Iterable[BaseGeometry]) -> BaseGeometry:
    """Return what at least one of the shapes covers, on the grid."""
    return polygonal(shapely.union_all(list(shapes), grid_size=GRID_M))


def without_cracks(shape: BaseGeometry) -> BaseGeometry:
    """Return the shape without cracks narrower than `LENGTH_M` between its parts, and without holes as narrow.

    Everything else stays in place. Growing and shrinking the whole shape would do the same, but then GEOS loses holes.
    """
    seams = [_seam(a, b) for a, b in combinations(shapely.get_parts(shape), 2) if shapely.dwithin(a, b, LENGTH_M)]
    joined = united([shape, *(seam for seam in seams if seam.area > _TOUCH_M * LENGTH_M)])
    rings = (ring for part in shapely.get_parts(joined) for ring in part.interiors)
    holes = (shapely.Polygon(ring) for ring in rings)
    narrow = [hole for hole in holes if 2.0 * hole.area <= LENGTH_M * hole.length]
    return united([joined, *narrow])


def _seam(one: BaseGeometry, other: BaseGeometry) -> BaseGeometry:
    """Return what is near to both of two parts: a strip along the crack between them."""
    return shapely.intersection(shapely.buffer(one, LENGTH_M / 2), shapely.buffer(other, LENGTH_M / 2))


def half_plane(line: Segment) -> BaseGeometry:
    """Return what lies to the left of the line through a segment, as far as anything may lie."""
    nx, ny = line.left
    (ax, ay), (bx, by) = line.at(-_FAR_M), line.at(line.length + _FAR_M)
    (cx, cy), (dx, dy) = (bx + _FAR_M * nx, by + _FAR_M * ny), (ax + _FAR_M * nx, ay + _FAR_M * ny)
    return shapely.polygons([(ax, ay), (bx, by), (cx, cy), (dx, dy)])
