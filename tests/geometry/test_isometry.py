"""Isometries are a group; a reflection undoes itself."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.segment import Segment

places = st.floats(-2.0, 2.0)
points = st.tuples(places, places)
angles = st.floats(-math.pi, math.pi)


def line_through(point: Point2, angle_rad: float) -> Segment:
    return Segment(point, (point[0] + math.cos(angle_rad), point[1] + math.sin(angle_rad)))


lines = st.builds(line_through, points, angles)
isometries = st.one_of(st.builds(Isometry.rotation, angles, places, places), st.builds(Isometry.reflection, lines))


def near(point: Point2) -> object:
    return pytest.approx(point, abs=1e-9)


@given(isometries, isometries, isometries, points)
def test_doing_three_one_after_another_is_associative(a: Isometry, b: Isometry, c: Isometry, p: Point2) -> None:
    assert a.after(b).after(c).apply_point(p) == near(a.after(b.after(c)).apply_point(p))


@given(isometries, isometries, points)
def test_after_does_the_first_one_first(a: Isometry, b: Isometry, p: Point2) -> None:
    assert a.after(b).apply_point(p) == near(a.apply_point(b.apply_point(p)))


@given(isometries, points)
def test_the_identity_changes_nothing(a: Isometry, p: Point2) -> None:
    assert Isometry().apply_point(p) == p
    assert a.after(Isometry()).apply_point(p) == near(a.apply_point(p))
    assert Isometry().after(a).apply_point(p) == near(a.apply_point(p))


@given(isometries, points)
def test_the_inverse_undoes_from_either_side(a: Isometry, p: Point2) -> None:
    assert a.inverse.after(a).apply_point(p) == near(p)
    assert a.after(a.inverse).apply_point(p) == near(p)


@given(isometries, points, points)
def test_distances_are_kept(a: Isometry, p: Point2, q: Point2) -> None:
    assert math.dist(a.apply_point(p), a.apply_point(q)) == pytest.approx(math.dist(p, q), abs=1e-9)


@given(lines, points)
def test_a_reflection_undoes_itself(line: Segment, p: Point2) -> None:
    over = Isometry.reflection(line)
    assert over.apply_point(over.apply_point(p)) == near(p)


@given(lines, places)
def test_a_reflection_leaves_the_points_of_its_line_alone(line: Segment, position_m: float) -> None:
    assert Isometry.reflection(line).apply_point(line.at(position_m)) == near(line.at(position_m))


@given(lines, points)
def test_a_reflection_takes_a_point_as_far_to_the_other_side(line: Segment, p: Point2) -> None:
    image = Isometry.reflection(line).apply_point(p)
    before, after = line.left_distances(np.array([p, image]))
    assert after == pytest.approx(-before, abs=1e-9)
    assert line.positions(np.array([p, image]))[1] == pytest.approx(line.positions(np.array([p]))[0], abs=1e-9)


@given(isometries, isometries)
def test_two_that_turn_the_cloth_over_leave_its_front_up(a: Isometry, b: Isometry) -> None:
    assert a.after(b).is_mirrored == (a.is_mirrored != b.is_mirrored)
    assert a.inverse.is_mirrored == a.is_mirrored


@given(isometries, st.lists(points, min_size=1, max_size=5))
def test_many_points_go_where_each_of_them_goes(a: Isometry, several: list[Point2]) -> None:
    together = a.apply(np.array(several))
    for row, p in zip(together, several, strict=True):
        assert tuple(row) == near(a.apply_point(p))


def test_reflections_over_two_parallel_lines_are_a_shift_by_twice_their_gap() -> None:
    first = Isometry.reflection(Segment((0.0, 0.0), (0.0, 1.0)))
    second = Isometry.reflection(Segment((0.3, 0.0), (0.3, 1.0)))
    assert second.after(first).apply_point((0.1, 0.2)) == near((0.7, 0.2))


def test_a_quarter_turn_takes_x_to_y() -> None:
    # (1, 0) turns to (0, 1), then moves by (0.5, 0).
    assert Isometry.rotation(math.pi / 2, 0.5, 0.0).apply_point((1.0, 0.0)) == near((0.5, 1.0))
