"""Cloth drawn over the table's edges: round, without gaps, and of the right area."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.geometry.drape import BEND_M, bends, draped
from planner.geometry.pose import FloatArray
from planner.geometry.region import Region
from planner.geometry.table import Table, TableTop
from planner.geometry.triangles import creased

TOP = TableTop.of(Table(1.6, 0.98, 0.79))
GAP_M = 0.0015
PLACES = {
    "on the table": (0.0, 0.0),
    "over one edge": (-0.8, 0.0),
    "over a corner": (-0.8, 0.49),
    "over the opposite corner": (0.75, -0.5),
    "just over a corner": (-0.56, 0.25),
}


def draped_square(x: float, y: float, turn: float = 0.0, gap_m: float = GAP_M) -> FloatArray:
    """Return a square of cloth, 50 cm wide, about a place of the table, in triangles, shape (n, 3, 3)."""
    along = 0.25 * math.sqrt(2.0) * np.exp(1j * (turn + math.pi / 4 + math.pi / 2 * np.arange(4)))
    flat = Region.polygon(np.column_stack([x + along.real, y + along.imag])).triangles
    cut, _ = creased(flat, bends(TOP, flat, gap_m))
    return draped(TOP, np.concatenate([cut, np.zeros((*cut.shape[:2], 1))], axis=2), gap_m)


def area(triangles: FloatArray) -> float:
    a, b, c = triangles.transpose(1, 0, 2)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def rim(triangles: FloatArray) -> float:
    """Return the length of all sides that only one triangle has."""
    sides = np.round(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2, 3) * 1e6).astype(np.int64)
    order = [sorted(map(tuple, side)) for side in sides.tolist()]
    _, first, counts = np.unique(np.array(order), axis=0, return_index=True, return_counts=True)
    single = sides[first[counts == 1]] / 1e6
    return float(np.linalg.norm(single[:, 0] - single[:, 1], axis=1).sum())


@pytest.mark.parametrize("place", PLACES.values(), ids=PLACES.keys())
@pytest.mark.parametrize("turn", [0.0, 0.4])
def test_cloth_has_no_gap_and_keeps_its_size_wherever_it_hangs(place: tuple[float, float], turn: float) -> None:
    triangles = draped_square(*place, turn)
    assert area(triangles) == pytest.approx(0.25, rel=0.01)
    assert rim(triangles) == pytest.approx(2.0, rel=0.01)


@pytest.mark.parametrize("place", PLACES.values(), ids=PLACES.keys())
def test_nothing_of_it_is_in_the_table(place: tuple[float, float]) -> None:
    points = draped_square(*place).reshape(-1, 3)
    is_over = np.all((points[:, :2] > np.array(TOP.low) + 1e-9) & (points[:, :2] < np.array(TOP.high) - 1e-9), axis=1)
    assert points[is_over, 2].min(initial=GAP_M) >= GAP_M - 1e-9


def test_upper_layers_go_round_the_edge_further_out_and_never_through_the_lower() -> None:
    steps = np.linspace(0.0, 0.3, 301)
    unrolled = np.column_stack([-0.8 - steps, np.zeros(301), np.zeros(301)])
    inner, outer = (draped(TOP, unrolled, gap_m) for gap_m in (0.002, 0.02))
    apart = np.hypot(*(inner[:, None, [0, 2]] - outer[None, :, [0, 2]]).transpose(2, 0, 1))
    # Both bends have their axis in the edge's plane, so what hangs is as far apart as what lies.
    assert apart.min() == pytest.approx(0.018, abs=1e-4)
    assert outer[-1, 0] == pytest.approx(-0.8 - BEND_M - 0.02)


@given(st.floats(-1.2, 1.2), st.floats(-0.9, 0.9), st.floats(-math.pi, math.pi), st.sampled_from([0.0, 0.5, 1.0]))
def test_two_points_near_to_each_other_are_drawn_near_to_each_other(
    x: float, y: float, angle: float, droop: float
) -> None:
    step = 1e-3
    ends = np.array([(x, y, 0.0), (x + step * math.cos(angle), y + step * math.sin(angle), 0.0)])
    one, other = draped(TOP, ends, GAP_M, droop)
    # While it sinks at a corner cloth stretches: both the ways outwards and the way down turn with the place.
    assert math.dist(one, other) <= (1.02 if droop == 1.0 and not is_beyond_corner(x, y) else 3.0) * step


def is_beyond_corner(x: float, y: float) -> bool:
    return abs(x) > 0.79 and abs(y) > 0.48


def test_level_cloth_goes_on_straight_and_sinking_cloth_turns_at_the_edge() -> None:
    unrolled = np.array([[-1.0, 0.1, 0.0]])
    assert draped(TOP, unrolled, GAP_M, 0.0)[0] == pytest.approx([-1.0, 0.1, GAP_M])
    half = draped(TOP, unrolled, GAP_M, 0.5)[0]
    assert math.degrees(math.atan2(GAP_M - half[2], -0.8 - half[0])) == pytest.approx(45.0, abs=2.0)


def test_cloth_that_stands_over_an_edge_comes_up_there() -> None:
    heights = [draped(TOP, np.array([[-1.0, 0.1, z]]))[0] for z in (0.0, 0.19, 0.2, 0.3)]
    assert [round(float(z), 2) for *_, z in heights[2:]] == [0.0, 0.1]
    assert [x for x, *_ in heights[2:]] == pytest.approx([-0.8, -0.8])
    assert all(a[2] < b[2] for a, b in itertools.pairwise(heights))
