"""Finds the arcs of circles that an outline's straight edges stand for, and makes them curves again.

A file's arc comes as points that are exactly on its circle. So points that are so near to each other that the edges
between them are as good as the arc, and all of them on one circle, are no polygon that somebody drew; a Bézier curve's
are on none.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from app.drawing.curve import Curve
from app.drawing.drawing import Corner, Crease, Drawing, End
from app.drawing.ring import ring_of
from app.drawing.solve import solve
from planner.geometry.pose import FloatArray, Point2

RISE_MAX_M = 0.6e-3
"""Largest rise of an arc over an edge that stands for a part of it (m): files are read to half a millimetre."""

_EXACT_M = 1e-6
"""Largest distance from the circle of a point that is on it (m)."""

_TRIPLES_MIN = 3
"""Least number of neighbouring triples of points on one circle: five points, where three lie on some circle always."""

_ANGLE_MAX_RAD = math.radians(180.5)
"""Largest angle of an arc that becomes one curve (rad); a longer one becomes several."""


@dataclass(frozen=True, slots=True)
class _Run:
    """Points of a ring on one circle, from one index on to another.

    Attributes:
        first: the index of the first point.
        count: the number of edges.
        angle_rad: the angle of the arc, positive to the left (rad).
    """

    first: int
    count: int
    angle_rad: float

    def parts(self) -> Iterator["_Run"]:
        """Yield arcs of half a circle at most; a whole circle becomes its four quarters."""
        is_whole = abs(self.angle_rad) > 2.0 * math.pi - 1e-6
        number = 4 if is_whole else max(math.ceil(abs(self.angle_rad) / _ANGLE_MAX_RAD), 1)
        ends = [round(part * self.count / number) for part in range(number + 1)]
        for start, end in pairwise(ends):
            share = (end - start) / self.count
            yield _Run(self.first + start, end - start, share * self.angle_rad)


def with_arcs(drawing: Drawing) -> Drawing:
    """Return a drawing with arcs for the straight edges that stand for one; unchanged if a fold would be lost."""
    points = np.array(drawing.points)
    runs = [part for run in _runs(points) for part in run.parts()] if len(points) > _TRIPLES_MIN + 1 else []
    if not runs:
        return drawing
    curves = {run.first % len(points): run for run in runs}
    inner = {(run.first + step) % len(points) for run in runs for step in range(1, run.count)}
    kept = [index for index in range(len(points)) if index not in inner]
    outline = tuple(
        Corner(f"v{number}", drawing.points[index], _curve(curves[index]) if index in curves else None)
        for number, index in enumerate(kept)
    )
    ring = np.array(ring_of(outline).points)
    folds = tuple(_on_ring(fold, points, ring) for fold in drawing.folds)
    curved = replace(drawing, outline=outline, folds=folds)
    return curved if len(solve(curved).problems) <= len(solve(drawing).problems) else drawing


def _curve(run: _Run) -> Curve:
    return Curve(0.0, -math.tan(run.angle_rad / 4.0) / 2.0)


def _runs(points: FloatArray) -> list[_Run]:
    """Return the longest runs of points on one circle each, which share no edge."""
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    centers, bends = _circles(before, points, after)
    radii = np.hypot(*(points - centers).T)
    rises = np.hypot(*(after - points).T) ** 2 / (8.0 * radii)
    is_fine = (bends != 0.0) & (rises <= RISE_MAX_M) & (np.roll(rises, 1) <= RISE_MAX_M)
    apart = np.hypot(*(np.roll(centers, -1, axis=0) - centers).T)
    agrees = is_fine & np.roll(is_fine, -1) & (np.sign(bends) == np.sign(np.roll(bends, -1))) & (apart <= 1e-3 * radii)
    count = len(points)
    if agrees.all():
        whole = _Run(0, count, math.copysign(2.0 * math.pi, float(bends[0])))
        return [whole] if _is_round(points, centers[0], radii[0]) else []
    start = int(np.argmin(agrees)) + 1  # the first triple of a run
    found: list[_Run] = []
    index = 0
    while index < count:
        length = 1
        while index + length < count and agrees[(start + index + length - 1) % count]:
            length += 1
        first = start + index - 1
        indices = np.arange(first, first + length + 2) % count
        if length >= _TRIPLES_MIN and _is_arc(points[indices]):
            found.append(_Run(first % count, length + 1, _angle(points[indices], bends[(start + index) % count])))
        index += length
    return found


def _circles(a: FloatArray, b: FloatArray, c: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the centres of the circles through triples of points, and their turn: positive to the left, 0 for none."""
    to_b, to_c = b - a, c - a
    double = 2.0 * (to_b[:, 0] * to_c[:, 1] - to_b[:, 1] * to_c[:, 0])
    safe = np.where(np.abs(double) > np.finfo(float).tiny, double, np.inf)
    b2, c2 = (to_b**2).sum(axis=1), (to_c**2).sum(axis=1)
    x, y = (to_c[:, 1] * b2 - to_b[:, 1] * c2) / safe, (to_b[:, 0] * c2 - to_c[:, 0] * b2) / safe
    return a + np.column_stack([x, y]), np.where(np.isfinite(safe), double, 0.0)


def _is_arc(points: FloatArray) -> bool:
    """Return whether all points are on the circle through the first, a middle and the last but one."""
    a, b, c = points[[0], :], points[[len(points) // 2], :], points[[-2], :]
    centers, bends = _circles(a, b, c)
    return bool(bends[0]) and _is_round(points, centers[0], float(np.hypot(*(points[0] - centers[0]))))


def _is_round(points: FloatArray, center: FloatArray, radius: float) -> bool:
    return bool(np.abs(np.hypot(*(points - center).T) - radius).max() <= _EXACT_M)


def _angle(points: FloatArray, bend: float) -> float:
    """Return the angle of the arc along which points lie, signed as its turn (rad)."""
    edges = np.hypot(*np.diff(points, axis=0).T)
    center = _circles(points[[0], :], points[[len(points) // 2], :], points[[-2], :])[0][0]
    radius = math.hypot(*(points[0] - center))
    return math.copysign(2.0 * float(np.arcsin(np.minimum(edges / (2.0 * radius), 1.0)).sum()), bend)


def _on_ring(fold: Crease, before: FloatArray, ring: FloatArray) -> Crease:
    """Return a fold whose ends were on the outline with them on the new one."""
    ends = [
        End(_nearest(end.point, ring)) if _off(end.point, before) <= _EXACT_M else end for end in (fold.start, fold.end)
    ]
    return replace(fold, start=ends[0], end=ends[1])


def _off(point: Point2, ring: FloatArray) -> float:
    return math.dist(point, _nearest(point, ring))


def _nearest(point: Point2, ring: Sequence[Point2] | FloatArray) -> Point2:
    """Return the point of a ring's edges that is nearest to a point (m)."""
    starts = np.asarray(ring)
    edges = np.roll(starts, -1, axis=0) - starts
    offset = np.array(point) - starts
    lengths2 = np.maximum((edges**2).sum(axis=1), np.finfo(float).tiny)
    shares = np.clip((offset * edges).sum(axis=1) / lengths2, 0.0, 1.0)
    places = starts + shares[:, None] * edges
    x, y = places[int(np.hypot(*(np.array(point) - places).T).argmin())].tolist()
    return (x, y)
