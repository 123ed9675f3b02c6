"""Plane geometry for the checker, with shapely alone: silhouettes, cuts along a segment, vertices to hold."""

import math
from collections.abc import Iterable
from itertools import combinations

import numpy as np
import shapely
from shapely import LineString, MultiPoint, Point, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import split

NEAR_M = 1e-4
"""The checker's own tolerance of position (m): coarser than the planner's, finer than a thread."""

SLIVER_M2 = 1e-5

Place = tuple[float, float]
Line = tuple[Place, Place]


def unit(line: Line) -> Place:
    (ax, ay), (bx, by) = line
    length = math.hypot(bx - ax, by - ay)
    return (bx - ax) / length, (by - ay) / length


def left_normal(line: Line) -> Place:
    ux, uy = unit(line)
    return -uy, ux


def distance_left(line: Line, point: Place) -> float:
    """Return the signed distance of a point from the whole line, positive on its left (m)."""
    nx, ny = left_normal(line)
    return (point[0] - line[0][0]) * nx + (point[1] - line[0][1]) * ny


def mirror(line: Line, point: Place) -> Place:
    nx, ny = left_normal(line)
    twice = 2 * distance_left(line, point)
    return point[0] - twice * nx, point[1] - twice * ny


def mirrored(line: Line, shape: BaseGeometry) -> BaseGeometry:
    flipped = shapely.transform(shape, lambda rows: np.array([mirror(line, tuple(row)) for row in rows]))
    # Coordinates on the micrometre, but not bound to a grid: a narrow buffer of a bound shape may lose all of it.
    return shapely.set_precision(shapely.set_precision(shapely.make_valid(flipped), 1e-6), 0)


def polygons(shape: BaseGeometry) -> list[Polygon]:
    """Return the polygons of a shape that are large enough to be cloth."""
    parts = [part for part in shapely.get_parts(shape) if part.geom_type == "Polygon"]
    return [part for part in parts if part.area >= SLIVER_M2]


def together(shapes: Iterable[BaseGeometry]) -> BaseGeometry:
    """Return the union of shapes, with hairline cracks between them closed."""
    whole = shapely.union_all(list(shapes))
    with np.errstate(divide="ignore", invalid="ignore"):  # GEOS divides by zero at a crack's tip, and copes with it
        return whole.buffer(2e-6, join_style="mitre").buffer(-2e-6, join_style="mitre")


def without_hairs(shape: BaseGeometry) -> BaseGeometry:
    """Return a shape without the hairline spurs that a difference leaves along common edges."""
    return shape.buffer(-5e-6, join_style="mitre").buffer(5e-6, join_style="mitre")


def cut_along(shape: BaseGeometry, line: Line) -> BaseGeometry:
    """Return the part joined to the left side of a segment with ends on the boundary; fails if it separates nothing."""
    (ux, uy), (nx, ny) = unit(line), left_normal(line)
    (ax, ay), (bx, by) = line
    over = 2e-5
    knife = LineString([(ax - over * ux, ay - over * uy), (bx + over * ux, by + over * uy)])
    beside = LineString(line)
    sides = [shapely.transform(beside, lambda p, s=s: p + s * NEAR_M * np.array([nx, ny])) for s in (1, -1)]
    moving = []
    for polygon in polygons(shape):
        for piece in split(polygon, knife).geoms:
            on_left, on_right = (piece.intersection(side).length > 10 * NEAR_M for side in sides)
            assert not (on_left and on_right), "the fold line does not part the cloth"
            if on_left:
                moving.append(piece)
    assert moving, "nothing lies to the left of the fold line"
    return together(moving)


def corners(shape: BaseGeometry) -> list[tuple[Place, Place, Place]]:
    """Yield each true outer corner with its neighbours."""
    found = []
    for polygon in polygons(shape):
        ring = [tuple(p) for p in polygon.exterior.coords[:-1]]
        slim = list(ring)
        is_shrinking = True
        while is_shrinking and len(slim) > 3:
            is_shrinking = False
            for i, point in enumerate(slim):
                before, after = slim[i - 1], slim[(i + 1) % len(slim)]
                if LineString([before, after]).distance(Point(point)) <= 1e-5:
                    del slim[i]
                    is_shrinking = True
                    break
        found += [(slim[i - 1], p, slim[(i + 1) % len(slim)]) for i, p in enumerate(slim)]
    return found


def must_hold(shape: BaseGeometry, up: Place, baselines: list[Line], support_angle_rad: float) -> list[Place]:
    """Return the vertices on the hull and off the baseline with no cloth above, within the support angle."""
    around = corners(shapely.convex_hull(shape))
    whole = [shapely.get_coordinates(shape)[0]] if not around else [point for _, point, _ in around]
    hull = MultiPoint([corner[1] for corner in around if not is_hardly_a_corner(*corner)] or whole)
    heading = math.atan2(up[1], up[0])
    needed = []
    for before, point, after in corners(shape):
        spot = Point(point)
        is_held_already = any(LineString(line).distance(spot) <= NEAR_M for line in baselines)
        if hull.distance(spot) > 1.5e-5 or is_held_already:
            continue
        radius = min(5e-5, math.dist(before, point) / 2, math.dist(point, after) / 2)
        fan = np.linspace(heading - support_angle_rad, heading + support_angle_rad, 41)
        arc = LineString([(point[0] + radius * math.cos(a), point[1] + radius * math.sin(a)) for a in fan])
        if shape.distance(arc) > 2e-9:
            needed.append(point)
    return needed


def is_hardly_a_corner(before: Place, point: Place, after: Place) -> bool:
    """Return whether a hull runs straight on, within 2.5 mm and 5 degrees: the outline is known no better."""
    (ax, ay), (bx, by) = np.subtract(point, before), np.subtract(after, point)
    turn = math.atan2(ax * by - ay * bx, ax * bx + ay * by)
    return abs(turn) < math.radians(5.0) and LineString([before, after]).distance(Point(point)) < 2.5e-3


def bisector(shape: BaseGeometry, point: Place) -> Place:
    """Return the unit vector through the middle of the directions that lead from a boundary point into a shape."""
    angles = np.arange(0.0, math.tau, math.tau / 720)
    spots = np.array(point) + 1e-3 * np.column_stack([np.cos(angles), np.sin(angles)])
    inside = shapely.contains_xy(shape, spots)
    x, y = np.cos(angles[inside]).sum(), np.sin(angles[inside]).sum()
    return x / math.hypot(x, y), y / math.hypot(x, y)


def reach_of(grips: list[Place], vertices: list[Place]) -> list[float]:
    """Return each vertex's distance to the grip nearest to it, largest first (m)."""
    return sorted((min(math.dist(v, g) for g in grips) for v in vertices), reverse=True)


def best_cover(
    shape: BaseGeometry, vertices: list[Place], radius_m: float, arms: int, still: Line | None = None
) -> list[float] | None:
    """Return the distances of the best cover with the fewest grips, by trying all; None if the arms do not suffice.

    Nothing is lifted by a hand on the line that stays where it is.
    """
    spots = candidates(shape, vertices, still)
    for count in range(1, arms + 1):
        ranks = [reach_of(list(grips), vertices) for grips in combinations(spots, count)]
        good = [rank for rank in ranks if rank[0] <= radius_m + 1e-5]
        if good:
            return min(good)
    return None


def nearest_cover(shape: BaseGeometry, vertices: list[Place], arms: int, still: Line | None = None) -> list[float]:
    """Return the distances of the nearest cover by any number of grips, by trying all."""
    spots = candidates(shape, vertices, still)
    counts = range(1, min(arms, len(spots)) + 1)
    return min(reach_of(list(grips), vertices) for count in counts for grips in combinations(spots, count))


def candidates(shape: BaseGeometry, vertices: list[Place], still: Line | None) -> list[Place]:
    """Return the places that may be gripped."""
    found = list(vertices)
    for count in (2, 3):
        for some in combinations(vertices, count):
            centre = shapely.minimum_bounding_circle(MultiPoint(some)).centroid
            foot = shapely.shortest_line(centre, shape.boundary).coords[1]
            if still is None or LineString(still).distance(Point(foot)) > 1e-5:
                found.append(tuple(foot))
    return found
