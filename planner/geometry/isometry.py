"""Isometries of the plane, with which folding moves pieces of cloth."""

import math
from dataclasses import dataclass

import numpy as np

from planner.geometry.pose import FloatArray, Point2
from planner.geometry.segment import Segment


@dataclass(frozen=True, slots=True)
class Isometry:
    """A rotation or reflection followed by a translation: p -> (a p.x + b p.y + x, c p.x + d p.y + y).

    Attributes:
        a, b, c, d: rows of the orthogonal matrix.
        x: translation along x (m).
        y: translation along y (m).
    """

    a: float = 1.0
    b: float = 0.0
    c: float = 0.0
    d: float = 1.0
    x: float = 0.0
    y: float = 0.0

    @staticmethod
    def reflection(line: Segment) -> "Isometry":
        """Return the reflection over the line through a segment."""
        ux, uy = line.direction
        a, b = ux * ux - uy * uy, 2.0 * ux * uy
        sx, sy = line.start
        return Isometry(a, b, b, -a, sx - (a * sx + b * sy), sy - (b * sx - a * sy))

    @staticmethod
    def rotation(angle_rad: float, x: float = 0.0, y: float = 0.0) -> "Isometry":
        """Return a rotation about the origin followed by a translation (m)."""
        cos, sin = math.cos(angle_rad), math.sin(angle_rad)
        return Isometry(cos, -sin, sin, cos, x, y)

    @property
    def is_mirrored(self) -> bool:
        """Whether the plane ends face down."""
        return self.a * self.d - self.b * self.c < 0.0

    @property
    def matrix(self) -> FloatArray:
        """The matrix with the translation as third column, shape (2, 3), m."""
        return np.array([[self.a, self.b, self.x], [self.c, self.d, self.y]])

    def apply(self, points: FloatArray) -> FloatArray:
        """Return the images of points, shape (..., 2), m."""
        matrix = np.array([[self.a, self.b], [self.c, self.d]])
        return np.asarray(points @ matrix.T + np.array([self.x, self.y]))

    def apply_point(self, point: Point2) -> Point2:
        """Return the image of one point (m)."""
        px, py = point
        return (self.a * px + self.b * py + self.x, self.c * px + self.d * py + self.y)

    def after(self, first: "Isometry") -> "Isometry":
        """Return the isometry that applies `first` and then this one."""
        x, y = self.apply_point((first.x, first.y))
        return Isometry(
            self.a * first.a + self.b * first.c,
            self.a * first.b + self.b * first.d,
            self.c * first.a + self.d * first.c,
            self.c * first.b + self.d * first.d,
            x,
            y,
        )

    @property
    def inverse(self) -> "Isometry":
        """The isometry that undoes this one."""
        a, b, c, d = self.a, self.c, self.b, self.d
        return Isometry(a, b, c, d, -(a * self.x + b * self.y), -(c * self.x + d * self.y))
