"""Straight edges for an outline seen: corners, a line through the points of each edge, and exact mirror symmetry."""

import math
from dataclasses import dataclass

import cv2
import numpy as np

from app.rehearsal.vision.outline_edges import OutlineEdges
from planner.geometry.pose import FloatArray
from planner.geometry.region import Region

TOLERANCES = (0.03, 0.024, 0.019, 0.015, 0.012, 0.0095, 0.0075)
"""Tolerances for the first choice of corners, as shares of the figure's length; the coarsest that fits is taken."""

_GOOD_SHARE = 0.93
_NEAR = (0.006, 0.006)
_TRIMMED = 0.12
_SHORTEST = 0.03


@dataclass(frozen=True, slots=True, eq=False)
class Straightened:
    """An outline with straight edges.

    Attributes:
        corners: its corners, counter-clockwise, shape (n, 2), m.
        within_m: how near to it points count as on it (m).
        share: the share of the points seen that are so near.
    """

    corners: FloatArray
    within_m: float
    share: float


def straighten(contour: FloatArray) -> Straightened:
    """Return the figure with the fewest straight edges that fits an outline seen, points in order, shape (n, 2), m."""
    ring = contour if _area(contour) > 0 else contour[::-1]
    length = size_m(Region.polygon(ring))
    within_m = near_m(length)
    best: Straightened | None = None
    for share in TOLERANCES:
        corners = _lined_up(ring, _corners(ring, share * length), length)
        if corners is None:
            continue
        distances, _ = OutlineEdges.of(Region.polygon(corners)).distances(ring)
        fits = Straightened(corners, within_m, float((np.abs(distances) <= within_m).mean()))
        if best is None or fits.share > best.share + 0.01:
            best = fits
        if best.share >= _GOOD_SHARE:
            break
    return Straightened(ring[_corners(ring, 0.01 * length)], within_m, 0.0) if best is None else best


def size_m(figure: Region) -> float:
    """Return the size that tolerances are shares of: a figure's length, or less where it is narrow (m).

    A hundredth of a tie's length is a fifth of its narrow end: within that, corners could go unnoticed.
    """
    return min(figure.length, math.sqrt(2.0 * figure.area))


def near_m(length: float) -> float:
    """Return how near to the outline of a figure of some size a point counts as on it (m)."""
    return _NEAR[0] + _NEAR[1] * length


def _corners(ring: FloatArray, tolerance_m: float) -> FloatArray:
    """Return the indices of the corners of a ring that leaves none of its points further off (Douglas-Peucker)."""
    kept = cv2.approxPolyDP(np.asarray(ring, np.float32)[:, None], tolerance_m, True)[:, 0]
    gaps = ((ring[:, None] - kept[None].astype(np.float64)) ** 2).sum(axis=2)
    return np.unique(gaps.argmin(axis=0))


def _lined_up(ring: FloatArray, indices: FloatArray, length: float) -> FloatArray | None:
    """Return the corners at which lines through the edges' own points meet; None where that is no simple figure."""
    count = len(indices)
    if count < 3:
        return None
    lines = [_line(ring, int(indices[k]), int(indices[(k + 1) % count])) for k in range(count)]
    corners = []
    for k in range(count):
        (p, u), (q, v) = lines[k - 1], lines[k]
        at = ring[int(indices[k])]
        turn = float(u[0] * v[1] - u[1] * v[0])
        met = p + u * float((q - p)[0] * v[1] - (q - p)[1] * v[0]) / turn if abs(turn) > 0.12 else at
        corners.append(met if np.hypot(*(met - at)) < 0.04 * length else at)
    found = _without_short(np.array(corners), _SHORTEST * length)
    return found if len(found) >= 3 and Region.polygon(found).shape.is_valid else None


def _line(ring: FloatArray, first: int, last: int) -> tuple[FloatArray, FloatArray]:
    """Return a point and the direction of the line through the middle part of an edge's points."""
    count = (last - first) % len(ring)
    trim = max(1, round(_TRIMMED * count))
    indices = (first + np.arange(trim, count - trim + 1)) % len(ring)
    if len(indices) < 4:
        a, b = ring[first], ring[last]
        return a, (b - a) / max(float(np.hypot(*(b - a))), 1e-9)
    vx, vy, x, y = cv2.fitLine(np.asarray(ring[indices], np.float32), cv2.DIST_HUBER, 0, 1e-4, 1e-4).ravel().tolist()
    return np.array([x, y]), np.array([vx, vy])


def _without_short(corners: FloatArray, shortest_m: float) -> FloatArray:
    """Return corners with the ends of each short edge made one, the shortest first."""
    while len(corners) > 4:
        lengths = np.hypot(*(np.roll(corners, -1, axis=0) - corners).T)
        k = int(lengths.argmin())
        if lengths[k] >= shortest_m:
            break
        after = (k + 1) % len(corners)
        corners[k] = (corners[k] + corners[after]) / 2.0
        corners = np.delete(corners, after, axis=0)
    return corners


def _area(ring: FloatArray) -> float:
    x, y = ring.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2.0


ANGLES = 90
"""Angles at which a mirror line is looked for."""

_MEAN_OFF = 0.012
"""The largest mean distance of the mirrored outline from the outline, as a share of its length."""

_PAIR_OFF = 0.05
"""The largest distance of a mirrored corner from its partner, as a share of the length."""


@dataclass(frozen=True, slots=True, eq=False)
class Mirror:
    """A line of symmetry.

    Attributes:
        point: a point of it, shape (2,), m.
        angle_rad: its direction.
        off_m: how far the mirrored outline is from the outline, in the mean (m).
    """

    point: FloatArray
    angle_rad: float
    off_m: float

    def mirrored(self, points: FloatArray) -> FloatArray:
        """Return the mirror images of points, shape (n, 2), m."""
        normal = np.array([-math.sin(self.angle_rad), math.cos(self.angle_rad)])
        return np.asarray(points - 2.0 * ((points - self.point) @ normal)[:, None] * normal)


def find_mirror(corners: FloatArray) -> Mirror | None:
    """Return the best line of symmetry of a figure, its corners counter-clockwise (m); None where none holds."""
    region = Region.polygon(corners)
    edges = OutlineEdges.of(region)
    points = edges.spaced(120)
    middle = points.mean(axis=0)
    best = min(
        (_off(Mirror(middle, math.pi * k / ANGLES, 0.0), edges, points) for k in range(ANGLES)), key=lambda m: m.off_m
    )
    step_rad, step_m = math.pi / ANGLES / 2.0, 0.004 * region.length
    for _ in range(7):
        normal = np.array([-math.sin(best.angle_rad), math.cos(best.angle_rad)])
        tries = [
            _off(Mirror(best.point + a * step_m * normal, best.angle_rad + b * step_rad, 0.0), edges, points)
            for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1))
        ]
        nearer = min(tries, key=lambda m: m.off_m)
        if nearer.off_m < best.off_m:
            best = nearer
        else:
            step_rad, step_m = step_rad / 2.0, step_m / 2.0
    return best if best.off_m <= _MEAN_OFF * region.length else None


def symmetric(corners: FloatArray, mirror: Mirror) -> FloatArray | None:
    """Return corners moved so that the figure mirrors itself; None where they do not pair up."""
    most_m = _PAIR_OFF * size_m(Region.polygon(corners))
    images = mirror.mirrored(corners)
    gaps = np.sqrt(((images[:, None] - corners) ** 2).sum(axis=2))
    partner = gaps.argmin(axis=1)
    is_paired = (partner[partner] == np.arange(len(corners))).all()
    if not is_paired or gaps.min(axis=1).max() > most_m:
        return None
    made = (corners + mirror.mirrored(corners[partner])) / 2.0
    return made if Region.polygon(made).shape.is_valid else None


def _off(mirror: Mirror, edges: OutlineEdges, points: FloatArray) -> Mirror:
    distances, _ = edges.distances(mirror.mirrored(points))
    return Mirror(mirror.point, mirror.angle_rad, float(np.abs(distances).mean()))
