"""Outlines without the noise of tracing."""

import math
import random

import numpy as np
import pytest

from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray
from planner.geometry.region import Region
from planner.geometry.traced import TRACED_M, traced
from tests.builders import noisy, star


def shape(ring: FloatArray) -> FloatArray:
    return ring[traced(ring)]


@pytest.mark.parametrize("count", [60, 100, 200, 400])
@pytest.mark.parametrize("seed", range(5))
def test_edges_a_millimetre_beside_their_place_leave_the_corners_of_a_rectangle(count: int, seed: int) -> None:
    corners = np.array([(0.0, 0.0), (0.4, 0.0), (0.4, 0.3), (0.0, 0.3)])
    found = shape(noisy(corners, count, 0.001, random.Random(seed)))
    gaps = np.hypot(*(found[:, None] - corners).transpose(2, 0, 1))
    assert gaps.min(axis=1).max() <= 2.0 * TRACED_M, "every vertex kept is at a corner"
    assert gaps.min(axis=0).max() <= 2.0 * TRACED_M, "every corner has a vertex"


@pytest.mark.parametrize("count", [60, 61, 100, 400])
def test_a_curve_is_left_as_it_is_drawn(count: int) -> None:
    angles = np.linspace(0.0, math.pi, count)
    assert traced(0.2 * np.column_stack([np.cos(angles), np.sin(angles)])).all()


def test_a_strip_of_two_millimetres_keeps_its_corners() -> None:
    assert traced(np.array([(0.0, 0.0), (0.5, 0.0), (0.5, 0.002), (0.0, 0.002)])).all()


def test_no_vertex_is_further_from_the_shape_than_is_told() -> None:
    rng = random.Random(1)
    for _ in range(20):
        ring = noisy(np.array(star(rng, 8)), 200, 0.001, rng)
        kept = shape(ring)
        starts = np.roll(kept, 1, axis=0)
        share = ((ring[:, None] - starts) * (kept - starts)).sum(axis=2) / ((kept - starts) ** 2).sum(axis=1)
        feet = starts + np.clip(share, 0.0, 1.0)[:, :, None] * (kept - starts)
        assert np.hypot(*(feet - ring[:, None]).transpose(2, 0, 1)).min(axis=1).max() <= TRACED_M + 1e-9


def test_neither_the_first_vertex_nor_the_orientation_nor_a_mirror_nor_a_turn_decides() -> None:
    rng = random.Random(2)
    for _ in range(20):
        ring = noisy(np.array(star(rng, 7)), 120, 0.001, rng)
        kept, first = traced(ring), rng.randrange(120)
        assert np.array_equal(traced(np.roll(ring, first, axis=0)), np.roll(kept, first))
        assert np.array_equal(traced(ring[::-1]), kept[::-1])
        assert np.array_equal(traced(ring * np.array([-1.0, 1.0])), kept)
        assert np.array_equal(traced(Isometry.rotation(rng.uniform(-3.0, 3.0)).apply(ring)), kept)


def test_a_regular_zigzag_keeps_its_symmetry() -> None:
    top = [(0.01 * i, 0.3 + 0.0004 * (i % 2)) for i in range(41)]
    ring = np.array([(0.4, 0.0), *top[::-1], (0.0, 0.0)])
    assert shape(ring).tolist() == [[0.4, 0.0], [0.4, 0.3], [0.0, 0.3], [0.0, 0.0]]


def test_vertices_that_are_fixed_stay() -> None:
    ring = np.array([(0.0, 0.0), (0.2, 0.0001), (0.4, 0.0), (0.4, 0.3), (0.0, 0.3)])
    fixed = np.array([False, True, False, False, False])
    assert traced(ring).tolist() == [True, False, True, True, True]
    assert traced(ring, fixed).all()


def test_hands_come_from_outside_an_edge_whatever_its_noise() -> None:
    ring = noisy(np.array([(0.0, 0.0), (0.4, 0.0), (0.4, 0.3), (0.0, 0.3)]), 200, 0.001, random.Random(3))
    region, middle = Region.polygon(ring), ring[np.hypot(*(ring - np.array([0.2, 0.3])).T).argmin()]
    bisector = region.inward_bisector((float(middle[0]), float(middle[1])))
    assert bisector is not None and abs(math.atan2(bisector[0], -bisector[1])) < math.radians(1.0)
