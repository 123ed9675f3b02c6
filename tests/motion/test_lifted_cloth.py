"""Lifted cloth is bent where it leaves the table, hangs through between hands, and keeps its threads' lengths."""

import numpy as np
import pytest

from planner.geometry.pose import FloatArray
from planner.geometry.segment import Segment
from planner.motion.lifted_cloth import LiftedCloth

WIDTH_M, DEPTH_M = 0.6, 0.3
LINE = Segment((0.0, 0.0), (WIDTH_M, 0.0))
HELD = np.array([[WIDTH_M, DEPTH_M], [0.0, DEPTH_M]])
ON_TABLE_M = 1.0
"""A distance from the table's edges at which these do not matter (m)."""


def lifted(sweep: float, room_m: float = ON_TABLE_M) -> LiftedCloth:
    return LiftedCloth.of(LINE, DEPTH_M, sweep, HELD, room_m)


def thread(cloth: LiftedCloth, place: float, gap_m: float = 0.0, count: int = 2000) -> FloatArray:
    """Return points of a thread across the fold line, from there on: left of the line and up, shape (n, 2), m."""
    distances = np.linspace(0.0, DEPTH_M, count)
    flat = np.minimum(distances, cloth.baseline_m)
    planned = np.column_stack([cloth.side * flat, distances - flat])
    return planned + cloth.offsets(np.full(count, place), distances, np.full(count, gap_m))


def length_m(points: FloatArray) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


@pytest.mark.parametrize("sweep", [0.2, 0.5, 0.9, 1.3, 1.8])
def test_threads_keep_their_lengths_and_end_where_the_hands_are(sweep: float) -> None:
    cloth = lifted(sweep)
    taut, slack = thread(cloth, 0.0), thread(cloth, WIDTH_M / 2)
    assert length_m(taut) == pytest.approx(DEPTH_M, rel=1e-4)
    assert length_m(slack) == pytest.approx(DEPTH_M, rel=0.01)
    height_m = DEPTH_M - cloth.baseline_m
    np.testing.assert_allclose(taut[-1], [cloth.side * cloth.baseline_m, height_m], atol=1e-6)
    assert 0.5 * height_m < slack[-1, 1] < height_m


def test_nothing_has_a_corner_or_is_in_the_table() -> None:
    points = thread(lifted(0.5), WIDTH_M / 3)
    steps = np.diff(points, axis=0)
    turns = np.abs(np.diff(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))))
    assert turns.max() < 0.03
    assert points[:, 1].min() >= 0.0


def test_cloth_is_laid_down_as_the_mirror_image_of_how_it_was_lifted() -> None:
    up, down = thread(lifted(0.6), 0.2), thread(lifted(1.4), 0.2)
    np.testing.assert_allclose(down, up * np.array([-1.0, 1.0]), atol=1e-9)


@pytest.mark.parametrize("sweep", [0.6, 1.4])
def test_upper_layers_are_inside_the_bend(sweep: float) -> None:
    cloth = lifted(sweep)
    lower, upper = thread(cloth, 0.0), thread(cloth, 0.0, gap_m=0.005)
    assert upper[0, 1] - lower[0, 1] == pytest.approx(0.005)
    assert cloth.side * (lower[-1, 0] - upper[-1, 0]) == pytest.approx(0.005, rel=0.01)


@pytest.mark.parametrize(("sweep", "room_m"), [(1.0, ON_TABLE_M), (0.5, 0.0), (0.001, ON_TABLE_M)])
def test_a_crease_cloth_beyond_the_edge_and_cloth_hardly_lifted_are_drawn_as_planned(
    sweep: float, room_m: float
) -> None:
    cloth = lifted(sweep, room_m)
    assert cloth.leaves_at_m == cloth.baseline_m
    np.testing.assert_allclose(
        cloth.offsets(np.full(9, 0.3), np.linspace(0.0, DEPTH_M, 9), np.zeros(9)), 0.0, atol=1e-12
    )


def test_cut_cloth_follows_its_shape_to_some_millimetres() -> None:
    cloth = lifted(0.5)
    low = cloth.leaves_at_m
    corners = np.array([[0.0, low], [WIDTH_M, low], [WIDTH_M, DEPTH_M], [0.0, DEPTH_M]])
    triangles, sources = cloth.cut(corners[[[0, 1, 2], [0, 2, 3]]], LINE)
    assert set(sources.tolist()) == {0, 1}
    middles = (triangles + np.roll(triangles, 1, axis=1)) / 2.0

    def placed(points: FloatArray) -> FloatArray:
        flat = np.minimum(points[..., 1], cloth.baseline_m)
        moved = cloth.offsets(points[..., 0].ravel(), points[..., 1].ravel(), np.zeros(points[..., 0].size))
        return np.stack([flat, points[..., 1] - flat], axis=-1) + moved.reshape(points.shape)

    chords = (placed(triangles) + placed(np.roll(triangles, 1, axis=1))) / 2.0
    assert np.abs(placed(middles) - chords).max() < 3e-3
