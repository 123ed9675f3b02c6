"""The curves of a drawing, and their flattening to points.

A curve is flattened only when the length of the drawing's unit is known, so that the tolerance can be in metres.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from svg.path import Arc, Close, CubicBezier, Line, QuadraticBezier

from app.files.import_errors import broken
from planner.geometry.pose import FloatArray

POINTS_MAX = 50_000
"""Largest number of points of a flattened curve."""

_NUMBER_MAX = 1e12
"""The largest coordinate of a line, in whatever unit: a survey's are a hundred thousand times smaller."""

Segment: TypeAlias = Line | Close | QuadraticBezier | CubicBezier | Arc
"""A segment of a path; an arc has radii, and ends elsewhere than it starts."""


class Curve(Protocol):
    """A connected line in a drawing."""

    @property
    def piece(self) -> str | None:
        """The name of the pattern piece that it belongs to; None if the file has none."""
        ...

    @property
    def block(self) -> int | None:
        """The number of the block of a pattern in which its piece is alone; None if the file has no such blocks."""
        ...

    @property
    def extent(self) -> FloatArray:
        """Points whose convex hull holds the line except bulges of arcs, its ends first and last, shape (n, 2)."""
        ...

    @property
    def is_bent(self) -> bool:
        """Whether the line is more than straight segments, so that flattening changes it."""
        ...

    def flattened(self, tolerance: float) -> FloatArray:
        """Return points on the line, ends included, with at most this deviation (units), shape (n, 2)."""
        ...


@dataclass(frozen=True, eq=False)
class SvgCurve:
    """A subpath of an SVG path.

    Attributes:
        segments: its segments, each starting at the end of the previous one.
        matrix: the transform from its coordinates to the drawing's, shape (3, 3).
        piece: the name of the pattern piece that it belongs to, or None.
        block: the number of the block of a pattern in which that piece is alone, or None.
    """

    segments: tuple[Segment, ...]
    matrix: FloatArray
    piece: str | None = None
    block: int | None = None

    @property
    def extent(self) -> FloatArray:
        """The ends and control points of its segments, and the middles of its arcs."""
        with np.errstate(all="ignore"):  # the caller refuses values that are not finite
            return self._placed(np.concatenate([_controls(segment) for segment in self.segments]))

    @property
    def is_bent(self) -> bool:
        """Whether any of its segments is curved."""
        return any(_bend(segment) > 0.0 for segment in self.segments)

    def flattened(self, tolerance: float) -> FloatArray:
        """Return points on the line, evenly spaced within each segment."""
        stretch = float(np.linalg.norm(self.matrix[:2, :2], 2)) or 1.0
        with np.errstate(all="ignore"):
            counts = [_count(segment, tolerance / stretch) for segment in self.segments]
            if not sum(counts) <= POINTS_MAX:
                raise broken(f"a curve in it needs more than {POINTS_MAX} points")
            pieces = [_points(segment, int(count)) for segment, count in zip(self.segments, counts, strict=True)]
            start = np.array([self.segments[0].start])
            return finite(self._placed(np.concatenate([start, *pieces])))

    def _placed(self, points: FloatArray) -> FloatArray:
        plane = np.column_stack([points.real, points.imag, np.ones(len(points))])
        return np.asarray((plane @ self.matrix.T)[:, :2])


@dataclass(frozen=True, eq=False)
class DrawnCurve:
    """A curve that can flatten itself, as in a DXF file.

    Attributes:
        extent: its ends and control points, shape (n, 2).
        cut: returns points on it for a tolerance, shape (n, 2).
        is_bent: whether it is more than straight segments.
        piece: the name of the pattern piece that it belongs to, or None.
        block: the number of the block of a pattern in which that piece is alone, or None.
    """

    extent: FloatArray
    cut: Callable[[float], FloatArray]
    is_bent: bool
    piece: str | None = None
    block: int | None = None

    @staticmethod
    def through(points: FloatArray, *, is_bent: bool = False, piece: str | None = None) -> "DrawnCurve":
        """Return the line through points, shape (n, 2), for every tolerance."""
        return DrawnCurve(points, lambda _: points, is_bent, piece)

    def flattened(self, tolerance: float) -> FloatArray:
        """Return points on the line."""
        return finite(self.cut(tolerance))


def finite(points: FloatArray) -> FloatArray:
    """Return points; raise `ImportedFileError` if a number is NaN or too large to compute with."""
    if not np.all(np.abs(points) <= _NUMBER_MAX):
        raise broken(f"a curve in it cannot be followed: a coordinate of {np.abs(points).max():.3g} is too large")
    return points


def _controls(segment: Segment) -> FloatArray:
    """Return the control points of a segment, or three points of an arc, as complex numbers."""
    match segment:
        case Arc():
            between = [segment.point(0.5)]
        case QuadraticBezier():
            between = [segment.control]
        case CubicBezier():
            between = [segment.control1, segment.control2]
        case _:
            between = []
    return np.array([segment.start, *between, segment.end])


def _count(segment: Segment, tolerance: float) -> float:
    """Return the number of pieces into which to cut a segment.

    A piece of a curve with second derivative c, over a stretch s of the parameter, deviates from its chord by at most
    c s^2 / 8.
    """
    return max(float(np.ceil(np.sqrt(_bend(segment) / (8.0 * tolerance)))), 1.0)


def _points(segment: Segment, count: int) -> FloatArray:
    """Return points on a segment, as complex numbers, without the first."""
    points = [segment.point(number / count) for number in range(1, count)]
    return np.array([*points, segment.end])


def _bend(segment: Segment) -> float:
    """Return the largest second derivative with respect to the parameter, which runs from 0 to 1."""
    if isinstance(segment, Arc):
        radius = segment.radius_scale * max(segment.radius.real, segment.radius.imag)
        return float(radius * math.radians(segment.delta) ** 2)
    controls = _controls(segment)
    degree = len(controls) - 1
    return 0.0 if degree == 1 else float(degree * (degree - 1) * np.abs(np.diff(controls, 2)).max())
