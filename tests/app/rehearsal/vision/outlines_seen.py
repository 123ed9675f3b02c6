"""Points of outlines as a camera might have seen them."""

import numpy as np

from app.rehearsal.vision.outline_edges import OutlineEdges
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region


def seen(region: Region, placement: Pose2, seed: int = 0, noise_m: float = 0.0015) -> FloatArray:
    """Points of a region's outline on the table, each off by some noise, shape (600, 2), m."""
    points = placement.to_outer(OutlineEdges.of(region).spaced(600))
    return points + np.random.default_rng(seed).normal(0.0, noise_m, points.shape)


def behind_an_arm(points: FloatArray, share: float = 0.15) -> FloatArray:
    """The same with some of them hidden, and the straight edges of what hides them instead."""
    hidden = int(share * len(points))
    away = points[0] + 1.5 * (points[0] - points.mean(axis=0))
    edges = [np.linspace(end, away, hidden // 3) for end in (points[0], points[hidden])]
    return np.concatenate([points[hidden:], *edges])


def most_off(region: Region, one: Pose2, other: Pose2) -> float:
    """How far two placements carry a corner of a region apart, at most (m)."""
    return float(np.hypot(*(one.to_outer(region.hull) - other.to_outer(region.hull)).T).max())
