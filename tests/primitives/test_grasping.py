"""The assignment of arms to grips, and their approaches."""

import math

import numpy as np
import pytest

from planner.geometry.pose import Approach, Point2, Pose2
from planner.primitives.grasping import approaches_from_outside, assignments, nearest_pair_m
from planner.task.scene import Scene
from tests.builders import context, garment, rectangle_points
from tests.wide_reach import WideReach

TOWEL = garment(rectangle_points(0.4, 0.3))

FAN = WideReach(
    approaches=(
        *(Approach(math.radians(h), math.radians(30)) for h in range(-120, 121, 30)),
        Approach(0.0, math.pi / 2),
    )
)
"""Arms that pinch at 30 degrees from nine headings, and straight down."""


def headings(grip: Point2, cone_deg: float, turn_deg: float = 0.0) -> list[float]:
    """Return the headings from which a grip of the towel may be taken, in degrees; straight down is 999."""
    problem = context(TOWEL, Scene(approach_cone_rad=math.radians(cone_deg)), FAN)
    found = approaches_from_outside(problem, 0, math.radians(turn_deg), grip, 0)
    chosen = [FAN.approaches[i] for i in found]
    return sorted(999.0 if a.is_vertical else round(math.degrees(a.heading_rad)) for a in chosen)


def arms(points: list[Point2], station: int = 0) -> set[tuple[int, ...]]:
    return set(assignments(context(TOWEL), station, np.array(points)))


def test_an_edge_is_pinched_from_within_the_cone_round_straight_in() -> None:
    # The middle of the left edge: inwards is along x, heading 0.
    assert headings((0.0, 0.15), 75.0) == [-60, -30, 0, 30, 60, 999]
    assert headings((0.0, 0.15), 60.0) == [-60, -30, 0, 30, 60, 999]
    assert headings((0.0, 0.15), 59.0) == [-30, 0, 30, 999]


def test_a_corner_is_pinched_from_within_the_cone_round_its_bisector() -> None:
    # The lower left corner: the bisector is at 45 degrees; +-50 degrees of it: -5..95.
    assert headings((0.0, 0.0), 50.0) == [0, 30, 60, 90, 999]


def test_a_corner_a_micrometre_askew_is_pinched_from_the_cones_rim_as_a_true_one_is() -> None:
    # Its lower edge falls by 1 um on 0.4 m, so the bisector by 1.25e-6 rad; 90 degrees is just within 45 of 45.
    assert headings((0.0, 0.0), 45.0) == [0, 30, 60, 90, 999]
    askew = garment([(0.0, 0.0), (0.4, -1e-6), (0.4, 0.3), (0.0, 0.3)])
    problem = context(askew, Scene(approach_cone_rad=math.radians(45.0)), FAN)
    assert len(approaches_from_outside(problem, 0, 0.0, (0.0, 0.0), 0)) == 5


def test_the_garment_turned_turns_the_headings() -> None:
    assert headings((0.0, 0.15), 31.0, turn_deg=90.0) == [60, 90, 120, 999]


def test_half_a_turn_asks_for_nothing() -> None:
    assert len(headings((0.0, 0.15), 180.0)) == 10


def test_what_is_not_on_the_boundary_is_taken_straight_down_only() -> None:
    assert headings((0.2, 0.15), 75.0) == [999]


def test_the_left_arm_takes_the_grip_further_left() -> None:
    # From `front` left is +y; arm 0 is the left one.
    assert arms([(-0.7, 0.2), (-0.7, -0.2)]) == {(0, 1)}
    assert arms([(-0.7, -0.2), (-0.7, 0.2)]) == {(1, 0)}


def test_left_is_as_the_robot_sees_it_from_where_it_stands() -> None:
    # `left` looks along -y: its left is +x.
    assert arms([(0.6, 0.3), (0.2, 0.3)], station=2) == {(0, 1)}


def test_grips_straight_behind_each_other_may_be_taken_either_way() -> None:
    assert arms([(-0.7, 0.1), (-0.5, 0.1)]) == {(0, 1), (1, 0)}


def test_a_single_grip_may_be_taken_by_either_arm() -> None:
    assert arms([(-0.7, 0.3)]) == {(0,), (1,)}


def test_the_nearest_pair_of_fewer_than_two_is_nowhere_near() -> None:
    assert nearest_pair_m(np.array([[0.0, 0.0]])) == math.inf
    assert nearest_pair_m(np.array([[0.0, 0.0], [3.0, 4.0], [0.0, 1.0]])) == pytest.approx(1.0)


def test_the_base_stands_on_the_standoff_grid() -> None:
    problem = context(TOWEL)
    assert problem.standoffs == 17
    assert problem.base_pose(0, 4) == Pose2(-1.15, 0.0, 0.0)
    assert context(TOWEL, Scene(back_off_max_m=0.0)).standoffs == 1
    assert context(TOWEL, Scene(back_off_max_m=0.29)).standoffs == 6
