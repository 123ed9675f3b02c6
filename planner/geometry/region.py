"""Regions of the plane: the one place where shapely is spoken.

A `Region` is a polygon or several, possibly none. It is a value: every operation gives a new one. Results
of a cut or a reflection are put back onto the micrometre grid, because reflecting leaves coordinates that
differ in their last digits and such differences breed slivers; slivers are dropped where they arise.
"""

import math
from collections.abc import Iterable, Sequence
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.segment import Segment
from planner.geometry.tolerance import AREA_M2, GRID_M, LENGTH_M

_FAR_M = 100.0


class Region:
    """A part of the plane, closed, made of zero or more polygons.

    Attributes:
        shape: the shapely geometry behind it; for this room only.
    """

    def __init__(self, shape: BaseGeometry) -> None:
        self.shape = shape

    @staticmethod
    def polygon(points: Iterable[Sequence[float]]) -> "Region":
        """The region within a ring of points (m), in either orientation, the first not repeated."""
        return Region(shapely.Polygon([tuple(p) for p in points]))

    @staticmethod
    def empty() -> "Region":
        """The region that has no points."""
        return Region(shapely.Polygon())

    @staticmethod
    def union(regions: Iterable["Region"]) -> "Region":
        """What at least one of the regions covers; hairline gaps between them are closed."""
        shapes = [r.shape for r in regions]
        if len(shapes) == 1:
            return Region(shapes[0])
        whole = shapely.union_all(shapes, grid_size=GRID_M)
        if len(shapely.get_parts(whole)) != 1 or shapely.get_num_interior_rings(whole):
            whole = shapely.union_all(shapes, grid_size=LENGTH_M)
        return Region(whole)

    # numbers

    @cached_property
    def area(self) -> float:
        """The area (m^2)."""
        return float(shapely.area(self.shape))

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
        """How far a point is from the boundary (m)."""
        return float(shapely.distance(self.shape.boundary, shapely.Point(point)))

    def distance_to(self, segment: Segment) -> float:
        """How far a segment is from the region (m); 0 if they meet."""
        return float(shapely.distance(self.shape, shapely.LineString([segment.start, segment.end])))

    # truths

    @property
    def is_sliver(self) -> bool:
        """Whether it is too small to count as cloth."""
        return self.area < AREA_M2

    def contains(self, point: Point2, margin_m: float = 0.0) -> bool:
        """Whether a point lies inside and further than a margin from the boundary."""
        return bool(shapely.contains_xy(self.shape, *point)) and (
            margin_m <= 0.0 or self.boundary_distance(point) > margin_m
        )

    def contains_segment(self, segment: Segment) -> bool:
        """Whether a segment runs inside or along the boundary, to the tolerance."""
        line = shapely.LineString([segment.start, segment.end])
        return bool(line.difference(self.shape.buffer(LENGTH_M)).length <= LENGTH_M)

    # points

    @cached_property
    def rings(self) -> tuple[FloatArray, ...]:
        """Each part's outer corners, counter-clockwise, shape (n, 2), m; straight runs have none."""
        outer = shapely.get_exterior_ring(shapely.get_parts(self.shape))
        return tuple(corners(np.asarray(shapely.get_coordinates(ring))[:-1]) for ring in outer)

    @cached_property
    def ring(self) -> FloatArray:
        """The outer ring of the largest part, as in `rings`."""
        largest = int(np.argmax(shapely.area(shapely.get_parts(self.shape))))
        return self.rings[largest]

    def inward_bisector(self, point: Point2) -> Point2 | None:
        """The unit vector that halves the directions leading from a boundary point into the region.

        None for a point off the outer boundary.
        """
        for ring in self.rings:
            for before, corner, after in zip(np.roll(ring, 1, axis=0), ring, np.roll(ring, -1, axis=0), strict=True):
                side = Segment(_point(corner), _point(after))
                if np.hypot(*(corner - point)) <= LENGTH_M:
                    return _halving(Segment(_point(before), _point(corner)), side)
                if np.hypot(*(after - point)) > LENGTH_M and side.distances(np.array([point]))[0] <= LENGTH_M:
                    return side.left
        return None

    @cached_property
    def hull(self) -> FloatArray:
        """The corners of the convex hull, counter-clockwise, shape (n, 2), m."""
        return corners(np.asarray(shapely.get_coordinates(shapely.convex_hull(self.shape)))[:-1])

    @cached_property
    def inner_point(self) -> Point2:
        """Some point well inside."""
        point = shapely.point_on_surface(self.shape)
        return (float(point.x), float(point.y))

    def nearest_boundary_points(self, points: FloatArray) -> FloatArray:
        """For each point, shape (n, 2), the nearest point of the boundary, shape (n, 2), m."""
        boundary = self.shape.boundary
        lines = shapely.shortest_line(shapely.points(points), boundary)
        return np.asarray(shapely.get_coordinates(lines)).reshape(-1, 2, 2)[:, 1]

    def overlaps_with(self, segment: Segment) -> tuple[tuple[Point2, Point2], ...]:
        """The stretches of a segment within the region, boundary included to the tolerance, by their ends."""
        line = shapely.LineString([segment.start, segment.end])
        inside = shapely.intersection(line, self.shape.buffer(LENGTH_M))
        parts = [shapely.get_coordinates(p) for p in shapely.get_parts(inside)]
        return tuple((_point(p[0]), _point(p[-1])) for p in parts if len(p))

    @cached_property
    def triangles(self) -> FloatArray:
        """The region cut into triangles, each counter-clockwise, shape (n, 3, 2), m."""
        meshes = shapely.constrained_delaunay_triangles(self.shape)
        rings = shapely.get_coordinates(shapely.orient_polygons(meshes)).reshape(-1, 4, 2)
        return np.asarray(rings[:, :3])

    # new regions

    @cached_property
    def pieces(self) -> tuple["Region", ...]:
        """Its connected parts, slivers left out."""
        parts = [Region(p) for p in shapely.get_parts(self.shape) if shapely.get_dimensions(p) == 2]
        return tuple(p for p in parts if not p.is_sliver)

    def moved(self, isometry: Isometry) -> "Region":
        """The region carried by an isometry and put back onto the grid."""
        shape = shapely.transform(self.shape, isometry.apply)
        return Region(shapely.set_precision(shape, GRID_M))

    def left_of(self, line: Segment) -> "Region":
        """The part to the left of the whole line through a segment."""
        return Region(shapely.intersection(self.shape, _half_plane(line), grid_size=GRID_M))

    def intersection(self, other: "Region") -> "Region":
        """What both cover."""
        return Region(shapely.intersection(self.shape, other.shape, grid_size=GRID_M))

    def difference(self, other: "Region") -> "Region":
        """What this one covers and the other does not."""
        return Region(shapely.difference(self.shape, other.shape, grid_size=GRID_M))


def _point(row: FloatArray) -> Point2:
    return (float(row[0]), float(row[1]))


def _halving(arriving: Segment, leaving: Segment) -> Point2:
    """The inward bisector at the corner between two edges of a counter-clockwise ring."""
    (ax, ay), (bx, by) = arriving.direction, leaving.direction
    turn = math.atan2(ax * by - ay * bx, ax * bx + ay * by)
    heading = math.atan2(by, bx) + (math.pi - turn) / 2
    return (math.cos(heading), math.sin(heading))


def _half_plane(line: Segment) -> BaseGeometry:
    nx, ny = line.left
    (ax, ay), (bx, by) = line.at(-_FAR_M), line.at(line.length + _FAR_M)
    return shapely.Polygon(
        [(ax, ay), (bx, by), (bx + _FAR_M * nx, by + _FAR_M * ny), (ax + _FAR_M * nx, ay + _FAR_M * ny)]
    )


def corners(ring: FloatArray) -> FloatArray:
    """The true corners of a closed ring, shape (n, 2), counter-clockwise: straight runs lose their points.

    A point is on a straight run when leaving it out moves the boundary by less than the tolerance.
    """
    if len(ring) < 4:
        return _counter_clockwise(ring)
    closed = np.vstack([ring, ring[:1]])
    slim = np.asarray(shapely.get_coordinates(shapely.simplify(shapely.LineString(closed), LENGTH_M)))
    slim = slim[:-1]
    if len(slim) > 3 and _is_on_line(slim[0], slim[-1], slim[1]):
        slim = slim[1:]
    return _counter_clockwise(slim if len(slim) >= 3 else ring)


def _is_on_line(point: FloatArray, a: FloatArray, b: FloatArray) -> bool:
    if np.allclose(a, b, atol=LENGTH_M):
        return False
    return bool(abs(Segment(tuple(a), tuple(b)).left_distances(point[None])[0]) <= LENGTH_M)


def _counter_clockwise(ring: FloatArray) -> FloatArray:
    x, y = ring.T
    doubled = np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))
    return ring if doubled >= 0.0 else ring[::-1]
