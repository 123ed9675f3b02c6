"""Cover a region with convex polygons."""

import shapely

from planner.geometry.pose import FloatArray
from planner.geometry.region import Region
from planner.geometry.tolerance import AREA_M2

_SIMPLER_M = 0.01
"""The largest outward simplification of an outline that would give too many triangles (m)."""

_TRIANGLES_MAX = 24
"""Triangles of a part above which its outline is simplified."""


def convex_pieces(region: Region) -> tuple[FloatArray, ...]:
    """Return convex polygons, counter-clockwise, shape (n, 2), that cover a region and little or nothing more."""
    return tuple(piece for part in region.pieces for piece in _pieces_of(part))


def _pieces_of(part: Region) -> tuple[FloatArray, ...]:
    hull = Region.polygon(part.hull)
    if hull.area - part.area <= AREA_M2:
        return (part.hull,)
    if len(part.triangles) > _TRIANGLES_MAX:
        grown = part.shape.buffer(_SIMPLER_M).simplify(0.8 * _SIMPLER_M)
        part = Region(shapely.intersection(grown, hull.shape))
    return tuple(part.triangles)
