"""A directed segment: a fold line, a table edge."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from planner.geometry.pose import FloatArray, Point2
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M


@dataclass(frozen=True)
class Segment:
    """A directed segment of positive length.

    Attributes:
        start: first end (m).
        end: second end (m).
    """

    start: Point2
    end: Point2

    def __post_init__(self) -> None:
        """Refuse a segment without a direction; raises `ValueError`."""
        if self.start == self.end:
            raise ValueError(f"a segment needs two different ends, both are {self.start}")

    @cached_property
    def length(self) -> float:
        """The length (m)."""
        return math.dist(self.start, self.end)

    @cached_property
    def direction(self) -> Point2:
        """The unit vector from start to end."""
        length = self.length
        return ((self.end[0] - self.start[0]) / length, (self.end[1] - self.start[1]) / length)

    @cached_property
    def left(self) -> Point2:
        """The unit normal to the left of the direction."""
        ux, uy = self.direction
        return (-uy, ux)

    def left_distances(self, points: FloatArray) -> FloatArray:
        """Return signed distances of points, shape (n, 2), from the whole line, positive on its left (m)."""
        return np.asarray((points - self._origin) @ self._normal)

    def positions(self, points: FloatArray) -> FloatArray:
        """Return where points, shape (n, 2), project onto the line, from the start along the direction (m)."""
        return np.asarray((points - self._origin) @ self._tangent)

    def at(self, position_m: float) -> Point2:
        """Return the point of the line at a distance from the start (m)."""
        ux, uy = self.direction
        return (self.start[0] + position_m * ux, self.start[1] + position_m * uy)

    def beside(self, distance_m: float) -> "Segment":
        """Return the segment moved to its left by a distance (m)."""
        (nx, ny), (ax, ay), (bx, by) = self.left, self.start, self.end
        return Segment((ax + distance_m * nx, ay + distance_m * ny), (bx + distance_m * nx, by + distance_m * ny))

    def distances(self, points: FloatArray) -> FloatArray:
        """Return the distances of points, shape (n, 2), from the segment itself (m)."""
        across, along = self.left_distances(points), self.positions(points)
        return np.hypot(across, along - np.minimum(np.maximum(along, 0.0), self.length))

    def meeting_point(self, other: "Segment") -> Point2 | None:
        """Return a point that two segments share, ends included to the tolerance; None if they are apart."""
        (px, py), (qx, qy) = self.start, other.start
        rx, ry = self.end[0] - px, self.end[1] - py
        sx, sy = other.end[0] - qx, other.end[1] - qy
        cross = rx * sy - ry * sx
        if abs(cross) <= ANGLE_RAD * self.length * other.length:
            return self._shared_end(other)
        t = ((qx - px) * sy - (qy - py) * sx) / cross
        u = ((qx - px) * ry - (qy - py) * rx) / cross
        return (px + t * rx, py + t * ry) if 0.0 <= t <= 1.0 and 0.0 <= u <= 1.0 else self._shared_end(other)

    def _shared_end(self, other: "Segment") -> Point2 | None:
        """Return an end of one segment that lies on the other; None if there is none."""
        for one, point in ((self, other.start), (self, other.end), (other, self.start), (other, self.end)):
            if one.distances(np.array([point]))[0] <= LENGTH_M:
                return point
        return None

    @cached_property
    def _origin(self) -> FloatArray:
        return np.array(self.start)

    @cached_property
    def _tangent(self) -> FloatArray:
        return np.array(self.direction)

    @cached_property
    def _normal(self) -> FloatArray:
        return np.array(self.left)

    @property
    def reversed(self) -> "Segment":
        """The segment in the opposite direction."""
        return Segment(self.end, self.start)
