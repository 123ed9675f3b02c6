"""Cloth over the table's edge: lengths are kept, and the part beyond it hangs."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.geometry.table import Table, TableTop

TOP = TableTop.of(Table(1.6, 0.98, 0.79))
places = st.floats(-1.5, 1.5)


def over(x: float, y: float, z: float = 0.0) -> tuple[float, ...]:
    return tuple(TOP.over_edge(np.array([x, y, z])).tolist())


def test_the_corners_of_the_table_run_counter_clockwise_from_near_right() -> None:
    assert Table(1.6, 0.98, 0.79).corners == ((-0.8, -0.49), (0.8, -0.49), (0.8, 0.49), (-0.8, 0.49))


def test_on_the_table_nothing_changes() -> None:
    assert over(0.3, -0.2, 0.1) == (0.3, -0.2, 0.1)


def test_a_point_beyond_an_edge_hangs_as_deep_as_it_lies_beyond() -> None:
    assert over(-1.0, 0.1) == pytest.approx((-0.8, 0.1, -0.2))
    assert over(0.0, 0.69, 0.05) == pytest.approx((0.0, 0.49, -0.15))


def test_beyond_a_corner_the_nearest_point_is_the_corner() -> None:
    # 0.3 beyond along x, 0.4 along y: 0.5 from the corner.
    assert over(1.1, 0.89) == pytest.approx((0.8, 0.49, -0.5))
    assert TOP.beyond(np.array([1.1, 0.89])) == pytest.approx(0.5)


@given(places, places, st.floats(-math.pi, math.pi), st.floats(0.0, 0.01))
def test_a_short_way_over_the_edge_is_no_longer_than_on_the_plane(
    x: float, y: float, angle: float, step: float
) -> None:
    there = (x + step * math.cos(angle), y + step * math.sin(angle))
    # The nearest point of the table and the depth each change by at most the step.
    assert math.dist(over(x, y), over(*there)) <= math.sqrt(2.0) * step + 1e-12


def test_a_way_straight_over_the_edge_keeps_its_length() -> None:
    ways = [over(x, 0.1) for x in np.linspace(-0.9, -0.7, 41)]
    assert sum(math.dist(a, b) for a, b in itertools.pairwise(ways)) == pytest.approx(0.2)


def test_a_top_opened_towards_points_beyond_one_edge_goes_on_there_only() -> None:
    opened = TOP.open_towards(np.array([[-0.9, 0.1], [0.0, 0.0]]))
    assert opened == TableTop((-math.inf, -0.49), (0.8, 0.49))
    assert tuple(opened.over_edge(np.array([-1.0, 0.1, 0.02]))) == (-1.0, 0.1, 0.02)
