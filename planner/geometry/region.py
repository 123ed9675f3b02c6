"""Regions of the plane: polygons as values, computed by shapely.

A `Region` is one polygon or several, or none. It is a value: every operation returns a new region. Reflected regions
are snapped to the micrometre grid, because reflecting leaves coordinates that differ in their last digits, and such
differences produce slivers. Cuts leave everything in place, so they are made on a finer grid: the two sides of a cut
add up to the whole and share their border to the last digit.
"""

from collections.abc import Iterable, Sequence
from functools import cached_property
from itertools import combinations

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.geometry.isometry import Isometry
from planner.geometry.pose import BoolArray, FloatArray, Point2, point2
from planner.geometry.ring import corners, counter_clockwise, feet, hull_of, inward_bisector
from planner.geometry.segment import Segment
from planner.geometry.tolerance import AREA_M2, CUT_GRID_M, GRID_M, LENGTH_M
from planner.geometry.traced import TRACED_M, traced

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


_EVENED_M = 5e-4
"""The largest deviation of an evened boundary, so that its curves have few corners (m)."""

_AT_ONCE = 256
"""Points for which distances to all edges are computed together, which limits the memory."""


class Region:
    """A part of the plane, closed, made of zero or more polygons.

    Attributes:
        shape: the shapely geometry; for this package only.
    """

    def __init__(self, shape: BaseGeometry) -> None:
        """Take the polygons of a shape; where two regions only touch there is no cloth."""
        self.shape = polygonal(shape)

    @staticmethod
    def polygon(points: FloatArray | Sequence[Sequence[float]]) -> "Region":
        """Return the region within a ring of points (m), in either orientation, the first not repeated."""
        return Region(shapely.polygons(np.asarray(points)[:, :2]))

    @staticmethod
    def from_bytes(content: bytes) -> "Region":
        """Return the region that `to_bytes` wrote."""
        return Region(shapely.from_wkb(content))

    def to_bytes(self) -> bytes:
        """Return all vertices to the last digit as well-known binary, equal for equal vertices in equal order."""
        return bytes(shapely.to_wkb(self.shape))

    @staticmethod
    def empty() -> "Region":
        """Return the region that has no points."""
        return Region(shapely.Polygon())

    @staticmethod
    def union(regions: Iterable["Region"]) -> "Region":
        """Return what at least one of the regions covers, with hairline gaps between them closed."""
        shapes = [r.shape for r in regions]
        if len(shapes) == 1:
            return Region(shapes[0])
        whole = united(shapes)
        if len(shapely.get_parts(whole)) != 1 or shapely.get_num_interior_rings(whole):
            whole = without_cracks(whole)
        return Region(whole)

    @staticmethod
    def rejoined(pieces: Iterable["Region"]) -> "Region":
        """Return the union of pieces that were cut from one region.

        The pieces fit to the last digit, so no gaps are closed.
        """
        return Region(shapely.union_all([p.shape for p in pieces], grid_size=CUT_GRID_M))

    # numbers

    @cached_property
    def area(self) -> float:
        """The area (m^2)."""
        return float(shapely.area(self.shape))

    @cached_property
    def outline_length(self) -> float:
        """The length of all boundaries, holes included (m)."""
        return float(shapely.length(self.shape))

    @cached_property
    def length(self) -> float:
        """The longer side of the smallest enclosing rectangle (m)."""
        ring = shapely.get_coordinates(shapely.minimum_rotated_rectangle(self.shape))
        return float(np.max(np.hypot(*np.diff(ring, axis=0).T))) if len(ring) > 1 else 0.0

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """The smallest and largest coordinates: x, y, x, y (m)."""
        x0, y0, x1, y1 = shapely.bounds(self.shape)
        return (float(x0), float(y0), float(x1), float(y1))

    @cached_property
    def coordinates(self) -> FloatArray:
        """All vertices of all rings, shape (n, 2), m; closing points repeated."""
        return np.asarray(shapely.get_coordinates(self.shape))

    def boundary_distance(self, point: Point2) -> float:
        """Return the distance of a point from the boundary (m)."""
        return float(shapely.distance(self.shape.boundary, shapely.points(point)))

    def distance_to(self, segment: Segment) -> float:
        """Return the distance of a segment from the region (m); 0 if they meet."""
        return float(shapely.distance(self.shape, shapely.LineString([segment.start, segment.end])))

    @staticmethod
    def gaps(regions: Sequence["Region"], point: Point2) -> FloatArray:
        """Return the distance of a point from each of some regions, shape (n,), m; 0 inside."""
        return np.asarray(shapely.distance([region.shape for region in regions], shapely.points(point)), dtype=float)

    # truths

    @property
    def is_sliver(self) -> bool:
        """Whether it is too small to count as cloth."""
        return self.area < AREA_M2

    def distances_to(self, points: FloatArray) -> FloatArray:
        """Return the distance of each point, shape (n, 2), from the region, shape (n,), m; 0 inside."""
        return np.asarray(shapely.distance(self.shape, shapely.points(points)))

    def contains(self, point: Point2, margin_m: float = 0.0) -> bool:
        """Return whether a point lies inside and further than a margin from the boundary."""
        return bool(shapely.contains_xy(self.shape, *point)) and (
            margin_m <= 0.0 or self.boundary_distance(point) > margin_m
        )

    def contains_segment(self, segment: Segment) -> bool:
        """Return whether a segment runs inside or along the boundary, to the tolerance."""
        outside = shapely.difference(shapely.LineString([segment.start, segment.end]), self.shape)
        if shapely.length(outside) > LENGTH_M:  # mostly not: to grow the region takes five times as long
            outside = shapely.difference(outside, shapely.buffer(self.shape, LENGTH_M))
        return bool(shapely.length(outside) <= LENGTH_M)

    def runs_inside(self, segment: Segment) -> bool:
        """Return whether a part of a segment lies inside, further from the boundary than the tolerance."""
        line = shapely.LineString([segment.start, segment.end])
        edges = shapely.linestrings(np.stack(self._edges, axis=1))
        near = edges[shapely.dwithin(edges, line, 2 * LENGTH_M)]
        # Edge by edge: of a shape on the grid (see `moved`), GEOS 3.14 fills one grown border of few corners in seven.
        inner = shapely.difference(line, shapely.union_all(shapely.buffer(near, 2 * LENGTH_M)))
        return bool(shapely.intersection(inner, self.shape).length > LENGTH_M)

    # points

    @cached_property
    def rings(self) -> tuple[FloatArray, ...]:
        """Each part's outer corners, counter-clockwise, shape (n, 2), m, without points on straight stretches."""
        outer = shapely.get_exterior_ring(shapely.get_parts(self.shape))
        return tuple(corners(np.asarray(shapely.get_coordinates(ring))[:-1]) for ring in outer)

    @cached_property
    def ring(self) -> FloatArray:
        """The outer ring of the largest part, as in `rings`."""
        return self.rings[self._largest]

    @cached_property
    def whole_ring(self) -> FloatArray:
        """The outer ring of the largest part with all its points, those on straight stretches too."""
        outer = shapely.get_exterior_ring(shapely.get_parts(self.shape)[self._largest])
        return counter_clockwise(np.asarray(shapely.get_coordinates(outer))[:-1])

    @cached_property
    def _largest(self) -> int:
        return int(np.argmax(shapely.area(shapely.get_parts(self.shape))))

    def inward_bisector(self, point: Point2) -> Point2 | None:
        """Return the unit vector that bisects the directions leading from a boundary point into the region.

        Directions are those of the boundary without the noise of tracing. None for a point off the outer boundary.
        """
        for ring, shape in zip(self.rings, self.shapes, strict=True):
            if inward_bisector(ring, point) is not None:
                return inward_bisector(shape, point, LENGTH_M if len(shape) == len(ring) else TRACED_M + LENGTH_M)
        return None

    @cached_property
    def shapes(self) -> tuple[FloatArray, ...]:
        """The corners of `rings` that make their shape, see `traced`."""
        return tuple(ring[traced(ring)] for ring in self.rings)

    @property
    def main_shape(self) -> FloatArray:
        """The corners of the largest part that make its shape."""
        return self.shapes[self._largest]

    @cached_property
    def hull(self) -> FloatArray:
        """The corners of the convex hull, counter-clockwise, shape (n, 2), m."""
        return hull_of(self.coordinates)

    @cached_property
    def inner_point(self) -> Point2:
        """A point well inside."""
        point = shapely.point_on_surface(self.shape)
        return (float(point.x), float(point.y))

    def nearest_boundary_points(self, points: FloatArray) -> FloatArray:
        """Return for each point, shape (n, 2), the nearest point of the boundary, shape (n, 2), m."""
        boundary = self.shape.boundary
        lines = shapely.shortest_line(shapely.points(points), boundary)
        return np.asarray(shapely.get_coordinates(lines)).reshape(-1, 2, 2)[:, 1]

    def all_nearest_boundary_points(self, points: FloatArray) -> FloatArray:
        """Return the boundary points nearest to each of some points, shape (n, 2), m, including all equally near ones.

        Returns:
            Shape (m, 2), m >= n: the nearest boundary points for each point in turn; a corner once for each of its
                edges.
        """
        found = [np.empty((0, 2))]
        for start in range(0, len(points), _AT_ONCE):
            places = feet(points[start : start + _AT_ONCE], *self._edges)
            gaps = np.hypot(*(places - points[start : start + _AT_ONCE, None]).transpose(2, 0, 1))
            found.append(places[gaps <= gaps.min(axis=1, keepdims=True) + LENGTH_M])
        return np.vstack(found)

    @cached_property
    def _edges(self) -> tuple[FloatArray, FloatArray]:
        """The start and the end of each edge of the boundary, shapes (n, 2), m."""
        rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(shapely.get_parts(self.shape))]
        return np.vstack([ring[:-1] for ring in rings]), np.vstack([ring[1:] for ring in rings])

    def overlaps_with(self, segment: Segment) -> tuple[tuple[Point2, Point2], ...]:
        """Return the parts of a segment within the region, boundary included to the tolerance, by their ends."""
        line = shapely.LineString([segment.start, segment.end])
        inside = shapely.intersection(line, self.shape.buffer(LENGTH_M))
        parts = [shapely.get_coordinates(p) for p in shapely.get_parts(inside)]
        return tuple((point2(p[0]), point2(p[-1])) for p in parts if len(p))

    def touches(self, segments: FloatArray) -> BoolArray:
        """Return which segments, shape (n, 2, 2), have a point of the region, to the tolerance; shape (n,)."""
        return np.asarray(shapely.dwithin(shapely.linestrings(segments), self.shape, LENGTH_M))

    @cached_property
    def triangles(self) -> FloatArray:
        """The region cut into triangles, each counter-clockwise, shape (n, 3, 2), m."""
        meshes = shapely.constrained_delaunay_triangles(self.shape)
        rings = shapely.get_coordinates(shapely.orient_polygons(meshes)).reshape(-1, 4, 2)
        return np.asarray(rings[:, :3])

    # new regions

    @property
    def parts(self) -> tuple["Region", ...]:
        """The connected parts."""
        if isinstance(self.shape, shapely.Polygon):  # not kept: a region that has itself would never be freed at once
            return () if self.shape.is_empty else (self,)
        return self._parts

    @cached_property
    def _parts(self) -> tuple["Region", ...]:
        return tuple(Region(p) for p in shapely.get_parts(self.shape))

    @property
    def pieces(self) -> tuple["Region", ...]:
        """The connected parts without slivers."""
        return tuple(p for p in self.parts if not p.is_sliver)

    @property
    def slivers(self) -> tuple["Region", ...]:
        """The connected parts that are too small to count as cloth."""
        return tuple(p for p in self.parts if p.is_sliver)

    def moved(self, isometry: Isometry) -> "Region":
        """Return the region carried by an isometry and snapped to the grid."""
        shape = shapely.transform(self.shape, isometry.apply)
        return Region(shapely.set_precision(shape, GRID_M))

    def evened(self, notch_m: float, fringe_m: float) -> "Region":
        """Return the region for drawing: notches narrower than `notch_m` filled, then fringes under `fringe_m` removed.

        What is wider keeps its place, but corners that point inwards are rounded.
        """
        filled = self.shape.buffer(notch_m / 2.0).buffer(-notch_m / 2.0)
        smooth = filled.buffer(-fringe_m / 2.0).buffer(fringe_m / 2.0)
        return Region(shapely.set_precision(smooth.simplify(_EVENED_M), GRID_M))

    def parted_by(self, line: Segment) -> tuple["Region", "Region"]:
        """Return the parts to the left and to the right of the line through a segment; no area is lost."""
        half = half_plane(line)
        left = shapely.intersection(self.shape, half, grid_size=CUT_GRID_M)
        return Region(left), Region(shapely.difference(self.shape, half, grid_size=CUT_GRID_M))

    def intersection(self, other: "Region") -> "Region":
        """Return what both regions cover."""
        return Region(shapely.intersection(self.shape, other.shape, grid_size=GRID_M))

    def difference(self, other: "Region") -> "Region":
        """Return what this region covers and the other does not."""
        return Region(shapely.difference(self.shape, other.shape, grid_size=GRID_M))


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
