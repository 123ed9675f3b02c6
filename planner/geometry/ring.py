"""Rings of points: a polygon's boundary without the closing point."""

import math

import numpy as np
import shapely

from planner.geometry.pose import FloatArray, Point2, point2
from planner.geometry.segment import Segment
from planner.geometry.tolerance import GRID_M, LENGTH_M


def corners(ring: FloatArray) -> FloatArray:
    """Return the true corners of a ring, shape (n, 2), counter-clockwise, without the points on straight stretches.

    A point is on a straight stretch when leaving it out moves the boundary by less than the tolerance.
    """
    if len(ring) < 4:
        return counter_clockwise(ring)
    closed = np.concatenate([ring, ring[:1]])
    slim = np.asarray(shapely.get_coordinates(shapely.simplify(shapely.linestrings(closed), LENGTH_M)))[:-1]
    if len(slim) > 3 and _is_on_line(slim[0], slim[-1], slim[1]):
        slim = slim[1:]
    return counter_clockwise(slim if len(slim) >= 3 else ring)


def counter_clockwise(ring: FloatArray) -> FloatArray:
    """Return the ring with its inside to its left."""
    (x, y), (x_after, y_after) = ring.T, after(ring).T
    return ring if np.dot(x, y_after) >= np.dot(y, x_after) else ring[::-1]


def after(ring: FloatArray) -> FloatArray:
    """Return for each point the next one, shape (n, 2)."""
    return np.concatenate([ring[1:], ring[:1]])


def before(ring: FloatArray) -> FloatArray:
    """Return for each point the previous one, shape (n, 2)."""
    return np.concatenate([ring[-1:], ring[:-1]])


def inward_bisector(ring: FloatArray, point: Point2, within_m: float = LENGTH_M) -> Point2 | None:
    """Return the unit vector that bisects the directions leading from a point on a ring of corners into it.

    A point within a distance (m) of a corner is at the corner, one within that of a side on the side; None for a point
    off the ring.
    """
    at, ends = np.array(point), after(ring)
    from_corners_m = np.hypot(*(ring - at).T)
    from_sides_m = np.hypot(*(feet(at[None], ring, ends)[0] - at).T)
    number, side_number = int(from_corners_m.argmin()), int(from_sides_m.argmin())
    if from_corners_m[number] <= within_m:
        here = point2(ring[number])
        return _halving(Segment(point2(ring[number - 1]), here), Segment(here, point2(ends[number])))
    if from_sides_m[side_number] <= within_m:
        return Segment(point2(ring[side_number]), point2(ends[side_number])).left
    return None


def feet(points: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Return the nearest point of each edge to each point, shapes (n, 2) and (m, 2) -> (n, m, 2), m."""
    along = ends - starts
    share = ((points[:, None] - starts) * along).sum(axis=2) / np.maximum((along**2).sum(axis=1), GRID_M**2)
    return np.asarray(starts + np.clip(share, 0.0, 1.0)[:, :, None] * along)


def _is_on_line(point: FloatArray, a: FloatArray, b: FloatArray) -> bool:
    (x, y), (ax, ay), (bx, by) = point.tolist(), a.tolist(), b.tolist()
    length = math.hypot(bx - ax, by - ay)
    return length > LENGTH_M and abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) <= LENGTH_M * length


def _halving(arriving: Segment, leaving: Segment) -> Point2:
    """Return the inward bisector at the corner between two edges of a counter-clockwise ring."""
    (ax, ay), (bx, by) = arriving.direction, leaving.direction
    turn = math.atan2(ax * by - ay * bx, ax * bx + ay * by)
    heading = math.atan2(by, bx) + (math.pi - turn) / 2
    return (math.cos(heading), math.sin(heading))


def hull_of(points: FloatArray) -> FloatArray:
    """Return the corners of the convex hull of points, counter-clockwise, shape (n, 2), m."""
    return corners(np.asarray(shapely.get_coordinates(shapely.convex_hull(shapely.multipoints(points))))[:-1])
