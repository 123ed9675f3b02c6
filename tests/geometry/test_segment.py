"""Directed segments: sides, distances, intersections."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.geometry.pose import Point2
from planner.geometry.segment import Segment

places = st.floats(-1.0, 1.0)
points = st.tuples(places, places)
far_apart = st.tuples(points, points).filter(lambda p: math.dist(*p) > 1e-2)


def test_a_segment_without_a_direction_is_refused() -> None:
    with pytest.raises(ValueError, match="two different ends"):
        Segment((0.1, 0.2), (0.1, 0.2))


def test_left_is_to_the_left_of_the_direction() -> None:
    line = Segment((0.0, 0.0), (2.0, 0.0))
    assert line.left == (0.0, 1.0)
    assert line.left_distances(np.array([[5.0, 0.3], [1.0, -0.2]])) == pytest.approx([0.3, -0.2])


@given(far_apart, points)
def test_reversing_a_segment_exchanges_its_sides(ends: tuple[Point2, Point2], point: Point2) -> None:
    line, row = Segment(*ends), np.array([point])
    assert line.reversed.left_distances(row)[0] == pytest.approx(-line.left_distances(row)[0], abs=1e-9)
    assert line.reversed.reversed == line


@given(far_apart, points)
def test_position_and_left_distance_lead_back_to_the_point(ends: tuple[Point2, Point2], point: Point2) -> None:
    line, row = Segment(*ends), np.array([point])
    (x, y), (nx, ny) = line.at(float(line.positions(row)[0])), line.left
    away = float(line.left_distances(row)[0])
    assert (x + away * nx, y + away * ny) == pytest.approx(point, abs=1e-9)


def test_the_distance_to_a_segment_is_to_its_nearer_end_beyond_it() -> None:
    # (4, 4) is 3 to the right of and 4 above the end (1, 0): 5.
    assert Segment((0.0, 0.0), (1.0, 0.0)).distances(np.array([[4.0, 4.0], [0.5, 0.2]])) == pytest.approx([5.0, 0.2])


@pytest.mark.parametrize(
    ("other", "meeting"),
    [
        (Segment((0.5, -1.0), (0.5, 1.0)), (0.5, 0.0)),
        (Segment((0.5, 0.0), (0.5, 1.0)), (0.5, 0.0)),
        (Segment((1.0, 0.0), (2.0, 3.0)), (1.0, 0.0)),
        (Segment((0.5, 5e-6), (0.5, 1.0)), (0.5, 5e-6)),
        (Segment((0.5, 2e-5), (0.5, 1.0)), None),
        (Segment((0.5, 0.1), (0.5, 1.0)), None),
        (Segment((0.0, 0.1), (1.0, 0.1)), None),
        (Segment((1.5, 0.0), (2.0, 0.0)), None),
        (Segment((0.7, 0.0), (2.0, 0.0)), (0.7, 0.0)),
    ],
    ids=[
        "cross",
        "touch in the middle",
        "share an end",
        "touch to the tolerance",
        "apart by a hair more",
        "apart",
        "parallel",
        "in line, apart",
        "in line, overlapping",
    ],
)
def test_two_segments_meet_where_they_cross_or_touch(other: Segment, meeting: Point2 | None) -> None:
    assert Segment((0.0, 0.0), (1.0, 0.0)).meeting_point(other) == (meeting and pytest.approx(meeting))
