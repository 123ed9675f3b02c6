"""The ring of an outline: its corners, with points between them where edges are curved."""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from app.drawing.curve import CURVE_TOLERANCE_M
from app.drawing.drawing import Corner
from planner.cloth.outline import POINTS_MAX
from planner.geometry.pose import Point2


@dataclass(frozen=True, slots=True)
class Ring:
    """The polygon that stands for an outline.

    Attributes:
        points: its points, in order (m).
        starts: the index of each corner of the outline among them, ascending from 0.
    """

    points: tuple[Point2, ...]
    starts: tuple[int, ...]

    def corner(self, point: int) -> int:
        """Return the corner at which the edge begins that a point of the ring is on, or is the start of."""
        return bisect_right(self.starts, point) - 1

    def is_corner(self, point: int) -> bool:
        """Return whether a point of the ring is a corner of the outline."""
        return self.starts[self.corner(point)] == point

    def walk(self, start: int, end: int) -> list[int]:
        """Return the points from one corner of the outline on to another, both included."""
        first, last, count = self.starts[start], self.starts[end], len(self.points)
        return [(first + step) % count for step in range((last - first) % count + 1)]

    def fraction(self, edge: int, along: float) -> float:
        """Return how far along the outline's edge a place is, from a piece of the ring and the fraction of that."""
        first = self.corner(edge)
        walk = self.walk(first, (first + 1) % len(self.starts))
        if len(walk) == 2:
            return along
        lengths = self._lengths(walk)
        piece = edge - self.starts[first]
        return float((lengths[:piece].sum() + along * lengths[piece]) / lengths.sum())

    def place(self, start: int, end: int, fraction: float) -> tuple[int, float]:
        """Return the piece of the ring, and how far along that, at a fraction of the way from corner to corner."""
        walk = self.walk(start, end)
        if len(walk) == 2:
            return walk[0], fraction
        lengths = self._lengths(walk)
        ends = np.cumsum(lengths)
        place = fraction * ends[-1]
        leg = min(int(np.searchsorted(ends, place)), len(lengths) - 1)
        along = float((place - ends[leg] + lengths[leg]) / lengths[leg]) if lengths[leg] > 0.0 else 0.0
        return walk[leg], min(max(along, 0.0), 1.0)

    def _lengths(self, walk: Sequence[int]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        points = np.array([self.points[index] for index in walk])
        return np.asarray(np.hypot(*np.diff(points, axis=0).T))


@lru_cache(maxsize=64)
def ring_of(outline: tuple[Corner, ...]) -> Ring:
    """Return the ring of an outline.

    Curves follow the tolerance as far as a garment may have as many points, and a coarser one from there.
    """
    tolerance_m = CURVE_TOLERANCE_M
    ring = _ring(outline, tolerance_m)
    is_curved = any(corner.curve is not None for corner in outline)
    while is_curved and len(ring.points) > POINTS_MAX and tolerance_m < 1.0:
        tolerance_m *= 2.0
        ring = _ring(outline, tolerance_m)
    return ring


def reordered(outline: Sequence[Corner], before: Sequence[Corner]) -> tuple[Corner, ...]:
    """Return corners in a new order, each edge as curved as it was between the same corners before."""
    curves = {
        pair: curve
        for here, following in zip(before, (*before[1:], *before[:1]), strict=True)
        if here.curve is not None
        for pair, curve in (((here.id, following.id), here.curve), ((following.id, here.id), here.curve.turned))
    }
    after = (*outline[1:], *outline[:1])
    return tuple(replace(a, curve=curves.get((a.id, b.id))) for a, b in zip(outline, after, strict=True))


def _ring(outline: Sequence[Corner], tolerance_m: float) -> Ring:
    points: list[Point2] = []
    starts: list[int] = []
    for index, corner in enumerate(outline):
        starts.append(len(points))
        points.append(corner.point)
        end = outline[(index + 1) % len(outline)].point
        if corner.curve is not None and math.dist(corner.point, end) > 0.0:
            points += corner.curve.points(corner.point, end, tolerance_m)
    return Ring(tuple(points), tuple(starts))
