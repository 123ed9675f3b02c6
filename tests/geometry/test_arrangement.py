"""Rings from lines as people draw them."""

import numpy as np
import pytest

from planner.geometry.arrangement import are_alike, are_tangled, clipped, enclosing_rings, reflected, united_ring
from planner.geometry.pose import FloatArray
from planner.geometry.ring import after
from planner.geometry.segment import Segment

GAP_M = 1.5e-3
A, B, C, D = (0.0, 0.0), (0.6, 0.0), (0.6, 0.4), (0.0, 0.4)


def lines(*ends: tuple[tuple[float, float], ...]) -> list[FloatArray]:
    return [np.array(line) for line in ends]


def moved(points: FloatArray, x: float, y: float) -> FloatArray:
    return np.asarray(points + np.array([x, y]))


def area(ring: FloatArray) -> float:
    (x, y), (x_after, y_after) = ring.T, after(ring).T
    return abs(float(np.dot(x, y_after) - np.dot(y, x_after))) / 2.0


BOX = lines((A, B), (B, C), (C, D), (D, A))


@pytest.mark.parametrize(
    "more",
    [
        [],
        lines((A, B)),
        lines((B, A), (C, B), (D, C)),
        lines(((0.1, 0.0), (0.5, 0.0))),
        lines(((-0.1, 0.0), (0.5, 0.0))),
        lines((A, C)),
        lines((A, C), (B, D)),
        lines(((0.3, 0.0), (0.3, 0.4))),
        lines(((0.3, -0.05), (0.3, 0.45))),
        lines(((0.3, 0.1), (0.3, 0.3))),
        lines(((0.2, 0.0002), (0.5, 0.0003))),
        lines(((0.0005, 0.0), (0.6, 0.0004))),
        lines((A, B, C)),
    ],
    ids=range(13),
)
def test_what_is_drawn_twice_or_across_changes_nothing(more: list[FloatArray]) -> None:
    (ring,) = enclosing_rings(BOX + more, GAP_M)
    assert len(ring) == 4 and area(ring) == pytest.approx(0.24, rel=1e-6)


@pytest.mark.parametrize("gap", [(0.0, 0.0), (1e-3, 0.0), (0.0, 1e-3), (1e-3, 1e-3), (-1e-3, 0.0), (-4e-3, 0.0)])
def test_gaps_up_to_a_millimetre_are_closed_and_overshoots_cut(gap: tuple[float, float]) -> None:
    short = (0.6 - gap[0], 0.0 + gap[1])
    (ring,) = enclosing_rings(lines((A, short), (B, C), (C, D), (D, A)), GAP_M)
    assert area(ring) == pytest.approx(0.24, rel=3e-3)


def test_a_wide_gap_stays_open() -> None:
    assert enclosing_rings(lines((A, (0.59, 0.0)), (B, C), (C, D), (D, A)), GAP_M) == []
    assert enclosing_rings([], GAP_M) == []


def test_the_ends_of_one_line_may_meet_across_a_gap() -> None:
    (ring,) = enclosing_rings(lines(((0.0, 0.001), D, C, B, A)), GAP_M)
    assert area(ring) == pytest.approx(0.24, rel=1e-3)


def test_an_outline_of_many_short_lines_is_found_whatever_their_order_and_direction() -> None:
    rng = np.random.default_rng(7)
    turns = np.linspace(0.0, 2.0 * np.pi, 2001)
    points = 0.3 * np.column_stack([np.cos(turns), np.sin(turns)])
    short = [points[n : n + 2][:: rng.choice([-1, 1])] + rng.normal(0.0, 2e-5, (2, 2)) for n in range(2000)]
    rng.shuffle(short)
    (ring,) = enclosing_rings(short, GAP_M)
    assert area(ring) == pytest.approx(np.pi * 0.09, rel=1e-3)


def test_pieces_that_touch_in_a_point_or_not_at_all_are_rings_of_their_own() -> None:
    for away in ((0.6, 0.4), (0.7, 0.0)):
        other = [moved(line, *away) for line in BOX]
        assert len(enclosing_rings(BOX + other, GAP_M)) == 2


def test_many_crossings_are_counted_without_making_them() -> None:
    rng = np.random.default_rng(1)
    tangle = list(rng.random((5000, 2, 2)))
    assert are_tangled(tangle, 20_000)
    assert not are_tangled(BOX, 0)
    turns = np.linspace(0.0, 6.0, 30_000)
    assert not are_tangled([np.column_stack([turns, np.sin(turns)])], 0)


def test_a_half_and_its_reflection_are_one_ring_with_twice_the_area() -> None:
    half = np.array([A, B, C, (0.0, 0.3)])
    line = Segment(A, (0.0, 0.3))
    whole = united_ring((half, reflected(half, line)), 0.0)
    assert whole is not None and area(whole) == pytest.approx(2.0 * area(half))
    assert are_alike(whole, reflected(whole, line), 1e-5)
    assert united_ring((half, moved(half, 2.0, 0.0)), 0.0) is None


def test_a_ring_within_a_clip_stays_and_one_across_it_is_cut() -> None:
    ring, clip = np.array([A, B, C, D]), np.array([(0.1, -1.0), (2.0, -1.0), (2.0, 1.0), (0.1, 1.0)])
    assert clipped(moved(ring, 0.2, 0.0), [[clip]]) is None
    cut = clipped(ring, [[clip]])
    assert cut is not None and area(cut[0]) == pytest.approx(0.2)
    assert clipped(moved(ring, -9.0, 0.0), [[clip]]) == []
