"""Joints along a tool's path: exactly on it, within their limits, without a jump, round forbidden places."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from planner.geometry.pose import Approach, BoolArray, FloatArray
from planner.geometry.table import Table
from planner.robots.pr2.arm import MIRROR
from planner.robots.tool_path import IsFree, NoPath, ToolPath
from tests.required import required
from tests.robots.model import can_reach, limits, pin_arm_pose, pin_tool_pose, the_pr2
from tests.robots.required import joints_of, no_path_of

ROBOT = the_pr2()
CARD = ROBOT.card
TORSO_M, TABLE_M = 0.29, 0.79
PITCHES_DEG = (30, 45, 60, 90)
LEAP_RAD = 0.4
FREE_M = 0.15
"""The distance to the base's middle line that a left tool may reach, nearer than its shoulder (m)."""

SIDEWAYS = np.array([1.0, -1.0, 1.0])


def line(start: tuple[float, float, float], end: tuple[float, float, float], pitch_deg: float) -> ToolPath:
    """Return a straight path in steps of a centimetre, in one orientation, without time pressure."""
    count = math.ceil(math.dist(start, end) / 0.01) + 1
    rotation = Approach(0.0, math.radians(pitch_deg)).rotation
    return ToolPath(
        np.linspace(start, end, count),
        np.broadcast_to(rotation, (count, 3, 3)),
        np.full(count - 1, np.inf),
        (0, count),
    )


def across(pitch_deg: float) -> ToolPath:
    """Return a path over the table, from the left arm's side to the middle, 0.28 m."""
    return line((0.55, 0.35, 0.9), (0.75, FREE_M, 0.9), pitch_deg)


def mirrored(path: ToolPath) -> ToolPath:
    """Return the mirrored path for the other arm: y is negated, and so is the side of the hand."""
    rotations = path.rotations * np.outer(SIDEWAYS, SIDEWAYS)
    return replace(path, positions=path.positions * SIDEWAYS, rotations=rotations)


def everywhere(_: NDArray[np.int64], joints: FloatArray) -> BoolArray:
    return np.ones(len(joints), dtype=bool)


def nowhere(_: NDArray[np.int64], joints: FloatArray) -> BoolArray:
    return np.zeros(len(joints), dtype=bool)


def found(path: ToolPath, is_free: IsFree = everywhere, arm: int = 0) -> FloatArray | NoPath:
    return ROBOT.arm_paths({arm: path}, TORSO_M, TABLE_M, {arm: is_free}, ROBOT.collisions(Table(), TORSO_M))


def found_near(path: ToolPath, known: FloatArray, is_free: IsFree = everywhere, arm: int = 0) -> FloatArray | None:
    return ROBOT.arm_path_near(arm, path, TORSO_M, is_free, known)


def require_followed(path: ToolPath, joints: FloatArray, arm: int = 0) -> None:
    """Require the tool at its pose everywhere, joints within their limits, and no jump."""
    low, high = limits(CARD, arm)
    assert joints.shape == (len(path.positions), 7)
    for at, position, rotation in zip(joints, path.positions, path.rotations, strict=True):
        for pose in (ROBOT.tool_pose(arm, at, TORSO_M), pin_tool_pose(CARD, arm, at, TORSO_M)):
            np.testing.assert_allclose(pose[0], position, atol=1e-6)
            np.testing.assert_allclose(pose[1], rotation, atol=1e-6)
    assert (joints >= low - 1e-9).all() and (joints <= high + 1e-9).all()
    assert np.abs(np.diff(joints, axis=0)).max() < LEAP_RAD


@pytest.mark.parametrize("arm", [0, 1])
@pytest.mark.parametrize("pitch_deg", PITCHES_DEG)
def test_the_tool_is_on_its_path_at_every_pose(pitch_deg: float, arm: int) -> None:
    path = across(pitch_deg) if arm == 0 else mirrored(across(pitch_deg))
    require_followed(path, joints_of(found(path, arm=arm)), arm)


def test_so_it_is_on_random_lines() -> None:
    rng, followed = np.random.default_rng(11), 0
    for _ in range(30):
        start, end = rng.uniform((0.4, 0.0, 0.82), (0.8, 0.5, 1.2)), rng.uniform((0.4, 0.0, 0.82), (0.8, 0.5, 1.2))
        path = line(tuple(start), tuple(end), rng.choice(PITCHES_DEG))
        joints = found(path)
        if isinstance(joints, NoPath):
            assert not can_reach(ROBOT, 0, path.positions, path.rotations, TORSO_M).all()
        else:
            require_followed(path, joints)
            followed += 1
    assert followed > 15


def test_a_hand_that_turns_over_is_followed_too() -> None:
    path = line((0.6, 0.3, 0.9), (0.6, 0.3, 1.1), 30)
    turns = np.linspace(0.0, math.pi, len(path.positions))
    about_x = np.array([[[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]] for a in turns])
    rolled = replace(path, rotations=path.rotations @ about_x)
    require_followed(rolled, joints_of(found(rolled)))


def test_a_path_that_leaves_the_reach_is_blocked_where_it_is_outside() -> None:
    # The arm is 0.1 + 0.4 + 0.321 + 0.18 m long and its shoulder 0.05 m behind the base's middle: 0.951 m ahead. The
    # path goes on to 1 m; of its 41 poses, 1 cm apart from 0.6 m on, every third and the last are looked at.
    blocked = no_path_of(found(line((0.6, 0.188, 0.9), (1.0, 0.188, 0.9), 30))).blocked
    assert {36, 39, 40} <= set(blocked) <= {27, 30, 33, 36, 39, 40}, (
        "what is nearer than 0.86 m is in reach at any rate"
    )


def test_where_everything_collides_every_pose_that_is_looked_at_is_blocked() -> None:
    assert no_path_of(found(across(45), nowhere)).blocked.tolist() == [*range(0, 29, 3), 29]


def test_poses_before_and_after_the_core_are_not_told_but_may_be_all_that_is_in_the_way() -> None:
    # Of the 41 poses those from 0.88 m on, the 29th and later, may be out of reach, those to the 27th are not.
    path = line((0.6, 0.188, 0.9), (1.0, 0.188, 0.9), 30)
    nearer, farther = (no_path_of(found(replace(path, core=core))) for core in ((0, 27), (30, 41)))
    assert not len(nearer.blocked) and not nearer.is_core
    assert {6, 9, 10} <= set(farther.blocked) <= {0, 3, 6, 9, 10} and farther.is_core


def test_an_arm_goes_round_what_the_calmest_path_would_run_into() -> None:
    path = across(45)
    wall_rad = 0.6

    def beside(_: NDArray[np.int64], joints: FloatArray) -> BoolArray:
        return joints[:, 0] < wall_rad

    calm, other = joints_of(found(path)), joints_of(found(path, beside))
    assert calm[:, 0].max() > wall_rad, "else the wall is in nobody's way"
    require_followed(path, other)
    assert other[:, 0].max() < wall_rad


def test_an_arm_goes_round_what_stands_in_its_way_for_a_while_only() -> None:
    path = across(45)
    middle = len(path.positions) // 2

    def gate(poses: NDArray[np.int64], joints: FloatArray) -> BoolArray:
        return (np.abs(poses - middle) > 2) | (joints[:, 0] < 0.5)

    calm, other = joints_of(found(path)), joints_of(found(path, gate))
    assert calm[middle, 0] > 0.5, "else the gate is wide enough"
    require_followed(path, other)
    assert other[middle - 2 : middle + 3, 0].max() < 0.5


@pytest.mark.parametrize("pitch_deg", PITCHES_DEG)
def test_the_mirror_image_of_a_path_has_the_mirror_image_of_its_joints(pitch_deg: float) -> None:
    path = across(pitch_deg)
    left, right = joints_of(found(path)), joints_of(found(mirrored(path), arm=1))
    np.testing.assert_allclose(right, left * MIRROR, atol=1e-9)


def test_so_has_what_goes_round_a_wall() -> None:
    path = across(45)
    left = joints_of(found(path, lambda _, joints: joints[:, 0] < 0.6))
    right = joints_of(found(mirrored(path), lambda _, joints: joints[:, 0] > -0.6, arm=1))
    np.testing.assert_allclose(right, left * MIRROR, atol=1e-9)


def test_elbows_stay_above_the_table_where_they_can() -> None:
    for pitch_deg in PITCHES_DEG:
        joints = joints_of(found(across(pitch_deg)))
        elbows = [pin_arm_pose("l_elbow_flex_link", CARD, 0, at, TORSO_M)[0] for at in joints]
        assert min(elbow[2] for elbow in elbows) > TABLE_M


def test_where_known_joints_still_do_they_are_kept() -> None:
    path = across(45)
    known = joints_of(found(path))
    shifted = replace(path, positions=path.positions + np.array([0.004, 0.003, 0.002]))
    near = required(found_near(shifted, known))
    require_followed(shifted, near)
    np.testing.assert_allclose(near, known, atol=0.05)


@pytest.mark.parametrize("arm", [0, 1])
def test_where_known_joints_no_longer_do_there_are_none_near_to_them(arm: int) -> None:
    path = across(45) if arm == 0 else mirrored(across(45))
    known = joints_of(found(path, arm=arm))
    barred = known[-1, 0]

    def is_free(poses: NDArray[np.int64], joints: FloatArray) -> BoolArray:
        """Forbid the pan's first value at the last five poses."""
        return np.asarray((np.asarray(poses) < len(known) - 5) | (np.abs(joints[:, 0] - barred) > 0.1))

    assert found_near(path, known, is_free, arm) is None
    require_followed(path, joints_of(found(path, is_free, arm)), arm)


def test_what_is_out_of_reach_is_near_to_nothing() -> None:
    path = across(45)
    beyond = replace(path, positions=path.positions + np.array([1.0, 0.0, 0.0]))
    assert found_near(beyond, joints_of(found(path))) is None
