"""Poses: from frame to frame and back; approaches as rotations."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.geometry.pose import Approach, Pose2, wrapped_angle

places = st.floats(-3.0, 3.0)
poses = st.builds(Pose2, places, places, st.floats(-7.0, 7.0))


@given(st.floats(-100.0, 100.0))
def test_a_wrapped_angle_is_the_same_direction_above_minus_pi_and_up_to_pi(angle: float) -> None:
    wrapped = wrapped_angle(angle)
    assert -math.pi < wrapped <= math.pi
    assert math.cos(wrapped) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(wrapped) == pytest.approx(math.sin(angle), abs=1e-9)


def test_half_a_turn_is_plus_pi_whichever_way_it_is_written() -> None:
    assert wrapped_angle(-math.pi) == wrapped_angle(math.pi) == wrapped_angle(3 * math.pi) == math.pi


@given(poses, places, places, places)
def test_going_out_and_in_again_leads_back(pose: Pose2, x: float, y: float, z: float) -> None:
    point = np.array([[x, y, z]])
    assert pose.to_inner(pose.to_outer(point)) == pytest.approx(point, abs=1e-9)
    assert pose.to_outer(point)[0, 2] == z
    assert pose.to_outer(point)[:, :2] == pytest.approx(pose.to_outer(point[:, :2]), abs=1e-12)


def test_a_point_ahead_of_a_base_that_looks_left_lies_further_along_y() -> None:
    base = Pose2(1.0, 2.0, math.pi / 2)
    assert base.to_outer(np.array([0.5, 0.0])) == pytest.approx([1.0, 2.5])
    assert base.to_inner(np.array([1.0, 2.5])) == pytest.approx([0.5, 0.0])


@given(poses, places)
def test_driving_ahead_and_back_ends_where_it_began(pose: Pose2, distance: float) -> None:
    there = pose.ahead(distance).ahead(-distance)
    assert (there.x_m, there.y_m, there.yaw_rad) == pytest.approx((pose.x_m, pose.y_m, pose.yaw_rad))


def test_a_pose_between_two_others_turns_the_short_way() -> None:
    # From 170 to -170 degrees it is 20 degrees by way of 180, not 340 by way of 0.
    start, end = Pose2(0.0, 0.0, math.radians(170)), Pose2(1.0, 2.0, math.radians(-170))
    middle = start.between(end, 0.5)
    assert (middle.x_m, middle.y_m) == (0.5, 1.0)
    assert abs(middle.yaw_rad) == pytest.approx(math.pi)


def test_a_pose_as_json_has_its_three_numbers() -> None:
    assert Pose2(0.1, 0.2, 0.3).to_dict() == {"x_m": 0.1, "y_m": 0.2, "yaw_rad": 0.3}


@given(st.floats(-math.pi, math.pi), st.floats(0.0, math.pi / 2))
def test_an_approach_is_a_right_handed_frame_whose_fingers_close_horizontally(heading: float, pitch: float) -> None:
    axes = Approach(heading, pitch).rotation
    assert axes.T @ axes == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes[2, 1] == 0.0


def test_an_approach_points_along_its_heading_and_below_the_horizontal_by_its_pitch() -> None:
    # 30 degrees down: cos 30 = 0.8660 ahead, here along y, and sin 30 = 0.5 down.
    assert Approach(math.pi / 2, math.radians(30)).rotation[:, 0] == pytest.approx([0.0, math.sqrt(0.75), -0.5])


def test_only_straight_down_is_vertical() -> None:
    assert Approach(0.3, math.pi / 2).is_vertical
    assert not Approach(0.3, math.radians(60)).is_vertical
