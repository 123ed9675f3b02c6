"""Planes between convex parts, against coal's distances."""

from itertools import product

import coal
import numpy as np
import pytest

from planner.geometry.pose import FloatArray
from planner.robots.collision.plane import room_at_plane
from planner.robots.collision.rounded_hull import RoundedHull, rounded_hull

TO_M = 1e-6


def some_hull(rng: np.random.Generator) -> RoundedHull:
    return rounded_hull(rng.normal(size=(12, 3)) * rng.uniform(0.02, 0.3, 3), 0.0)


def table_top() -> RoundedHull:
    return rounded_hull(np.array([*product((-0.4, 0.4), (-0.7, 0.7), (0.0, 0.04))]), 0.0)


def turned(rng: np.random.Generator, *, is_upright: bool) -> FloatArray:
    if is_upright:
        return np.eye(3)
    found, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return np.asarray(found * round(float(np.linalg.det(found))))


@pytest.mark.parametrize("is_upright", [False, True])
def test_a_plane_is_found_just_where_parts_are_further_apart_than_a_gap(is_upright: bool) -> None:
    rng, told = np.random.default_rng(30), []
    for _ in range(300):
        hulls = some_hull(rng), table_top() if is_upright else some_hull(rng)
        counts = [len(hull.corners) for hull in hulls]
        spans = np.array([(0, counts[0]), (counts[0], sum(counts))])
        poses = np.zeros((2, 5, 3))
        for number, pose in enumerate(poses):
            pose[:3] = turned(rng, is_upright=is_upright)
            pose[3:] = rng.normal(size=3) * 0.2 if number == 0 else 0.0
        gap = float(rng.uniform(0.0, 0.02))
        corners, way = np.vstack([hull.corners for hull in hulls]), (0.0, 0.0, 0.0)
        room, nearly = (room_at_plane(corners, spans, poses, 0, 1, gap, way, wanted) for wanted in (0.0, np.inf))
        posed = [(hull.convex(), coal.Transform3s(pose[:3], pose[3])) for hull, pose in zip(hulls, poses, strict=True)]
        apart_m = coal.distance(*posed[0], *posed[1], coal.DistanceRequest(), coal.DistanceResult()) - gap
        if abs(apart_m) > TO_M:
            assert 0.0 < room <= apart_m + TO_M if apart_m > 0.0 else room < 0.0
            assert nearly == pytest.approx(max(apart_m, 0.0) or -1.0, abs=TO_M)
            told.append(apart_m > 0.0)
    assert 50 < sum(told) < len(told) - 50
