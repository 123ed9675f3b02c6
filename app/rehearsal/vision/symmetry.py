"""Find the line in which a figure mirrors itself, and make it do so exactly."""

import math
from dataclasses import dataclass

import numpy as np

from app.rehearsal.vision.outline_edges import OutlineEdges
from app.rehearsal.vision.straighten import size_m
from planner.geometry.pose import FloatArray
from planner.geometry.region import Region

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
