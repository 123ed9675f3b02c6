"""Centres of smallest circles round pairs and triples."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from planner.geometry.pose import Point2
from planner.geometry.smallest_circle import pair_centres, triple_centres
from planner.geometry.tolerance import GRID_M

places = st.integers(-1_000_000, 1_000_000).map(lambda steps: steps * GRID_M)
points = st.tuples(places, places)


def centre(*three: Point2) -> Point2:
    return tuple(triple_centres(np.array(three))[0])


def test_pairs_have_their_midpoints() -> None:
    found = pair_centres(np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 4.0]]))
    assert found.tolist() == [[1.0, 0.0], [0.0, 2.0], [1.0, 2.0]]


def test_an_equilateral_triangle_has_its_centroid() -> None:
    assert centre((0.0, 0.0), (1.0, 0.0), (0.5, math.sqrt(0.75))) == pytest.approx((0.5, math.sqrt(0.75) / 3))


def test_a_right_triangle_has_the_middle_of_its_hypotenuse() -> None:
    assert centre((0.0, 0.0), (3.0, 0.0), (0.0, 4.0)) == pytest.approx((1.5, 2.0))


def test_an_obtuse_triangle_has_the_middle_of_its_longest_side() -> None:
    assert centre((0.0, 0.0), (4.0, 0.0), (2.0, 0.5)) == pytest.approx((2.0, 0.0))


def test_three_points_in_line_have_the_middle_of_the_outer_two() -> None:
    assert centre((0.0, 0.0), (0.2, 0.2), (1.0, 1.0)) == pytest.approx((0.5, 0.5))


@given(points, points, points)
def test_a_triple_has_a_circle_no_larger_than_shapely_finds(a: Point2, b: Point2, c: Point2) -> None:
    three = np.array([a, b, c])
    radius = np.hypot(*(three - centre(a, b, c)).T).max()
    assert radius == pytest.approx(shapely.minimum_bounding_radius(shapely.MultiPoint(three)), abs=1e-4)


def test_all_triples_of_five_points_are_there() -> None:
    assert triple_centres(np.random.default_rng(0).uniform(size=(5, 2))).shape == (10, 2)
