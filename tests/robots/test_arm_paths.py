"""Both arms along their tools' paths: exactly on them, and past each other if one is in the other's way."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from planner.geometry.pose import Approach, BoolArray, FloatArray
from planner.geometry.table import Table
from planner.robots.arm_paths import Together
from planner.robots.tool_path import IsFree, NoPath, ToolPath
from tests.robots.collision_samples import FAR, ROBOT, TORSO_M
from tests.robots.remade import THREE_ARMS, UNLIKE
from tests.robots.required import joints_of

TABLE_M = 0.79
COLLISIONS = ROBOT.collisions(Table(), TORSO_M)
LEAP_RAD = 0.4

NEAR_M = 0.54
"""How far ahead a hand is that passes straight before its own shoulder (m).

At 45 degrees down its wrist is 0.127 m behind it and 0.053 m below the shoulder. An elbow at its soft limit of
2.1213 rad holds the wrist hypot(0.4 - 0.321 cos(pi - 2.1213), 0.321 sin(pi - 2.1213)) = 0.359 m from the lift axis,
which is 0.05 m ahead of the base's middle where the arm faces the hand: so 0.532 m is the nearest.
"""


def line(start: tuple[float, float, float], end: tuple[float, float, float], yaw_deg: float) -> ToolPath:
    """Return a straight path in 40 steps, the hand pointing down by 45 degrees."""
    rotation = Approach(math.radians(yaw_deg), math.radians(45)).rotation
    return ToolPath(np.linspace(start, end, 41), np.broadcast_to(rotation, (41, 3, 3)), np.full(40, np.inf), (0, 41))


def is_free(arm: int) -> IsFree:
    """Return the collision check of an arm while the robot stands nowhere near the table."""
    return lambda _, joints: COLLISIONS.arm_free(arm, FAR, joints)


def along(paths: tuple[ToolPath, ToolPath], both_arms: Together = COLLISIONS) -> FloatArray | NoPath:
    are_free = {arm: is_free(arm) for arm in (0, 1)}
    return by_arm(ROBOT.arm_paths(dict(enumerate(paths)), TORSO_M, TABLE_M, are_free, both_arms))


def by_arm(found: FloatArray | NoPath) -> FloatArray | NoPath:
    """Return joints arm by arm, shape (n, 2, 7)."""
    return found if isinstance(found, NoPath) else found.reshape(-1, 2, 7)


def alone(paths: tuple[ToolPath, ToolPath]) -> FloatArray:
    """Return each arm's path as if the other arm were not there."""
    each = enumerate(paths)
    found = [ROBOT.arm_paths({arm: path}, TORSO_M, TABLE_M, {arm: is_free(arm)}, COLLISIONS) for arm, path in each]
    return np.stack([joints_of(one) for one in found], axis=1)


def require_followed(paths: tuple[ToolPath, ToolPath], joints: FloatArray) -> None:
    assert joints.shape == (41, 2, 7)
    for arm, path in enumerate(paths):
        for at, position, rotation in zip(joints[:, arm], path.positions, path.rotations, strict=True):
            found = ROBOT.tool_pose(arm, at, TORSO_M)
            np.testing.assert_allclose(found[0], position, atol=1e-6)
            np.testing.assert_allclose(found[1], rotation, atol=1e-6)
    assert np.abs(np.diff(joints, axis=0)).max() < LEAP_RAD
    assert COLLISIONS.free(FAR, joints).all()


class Between:
    """Collisions between arms that a test specifies."""

    def __init__(self, is_apart: Callable[[FloatArray, FloatArray], bool]) -> None:
        self._is_apart = is_apart

    def arms_apart(self, arms: tuple[int, ...], joints: FloatArray) -> BoolArray:
        return np.array([self._is_apart(left, right) for left, right in joints.reshape(-1, 2, 7)], dtype=bool)

    def postures_apart(self, arms: tuple[int, int], left: FloatArray, right: FloatArray) -> BoolArray:
        return np.array([[self._is_apart(a, b) for b in right] for a in left], dtype=bool)


APART = (line((0.6, 0.4, 0.9), (0.7, 0.2, 0.9), 0.0), line((0.6, -0.4, 0.9), (0.7, -0.2, 0.9), 0.0))


def test_arms_that_are_not_in_each_others_way_go_as_they_would_alone() -> None:
    joints = joints_of(along(APART))
    require_followed(APART, joints)
    np.testing.assert_array_equal(joints, alone(APART))


@pytest.mark.parametrize("gap_m", [0.12, 0.16])
def test_hands_that_cross_over_the_middle_find_a_way_past_each_other(gap_m: float) -> None:
    # The left hand goes to the right and the right one to the left, one behind the other.
    paths = (
        line((0.62 + gap_m, 0.25, 0.9), (0.62 + gap_m, -0.1, 0.9), 0.0),
        line((NEAR_M, -0.25, 0.9), (NEAR_M, 0.1, 0.9), 0.0),
    )
    assert not COLLISIONS.arms_apart((0, 1), alone(paths)).all(), "else nothing is to be found"
    require_followed(paths, joints_of(along(paths)))


def test_where_neither_can_go_as_it_would_alone_both_give_way() -> None:
    # Elbows by the arms' pans: what both together may have is less than either has by itself.
    calm = joints_of(along(APART))
    room = [np.abs(calm[:, arm, 0]).max() for arm in (0, 1)]
    assert min(room) > 0.3
    most = 0.7 * min(room)

    def is_apart(left: FloatArray, right: FloatArray) -> bool:
        return bool(abs(left[0]) < most and abs(right[0]) < most)

    joints = joints_of(along(APART, Between(is_apart)))
    require_followed(APART, joints)
    assert (np.abs(joints[:, :, 0]) < most).all()


def test_the_room_that_one_needs_is_left_to_it_by_the_other() -> None:
    # Together the pans may not be wider than a little less than what both would take: each alone could keep its own.
    calm = joints_of(along(APART))
    most = 0.9 * (calm[:, 0, 0] - calm[:, 1, 0]).max()
    joints = joints_of(along(APART, Between(lambda left, right: left[0] - right[0] < most)))
    require_followed(APART, joints)
    assert (joints[:, 0, 0] - joints[:, 1, 0] < most).all()


def test_where_they_touch_whatever_they_do_every_pose_that_was_asked_is_blocked() -> None:
    found = along(APART, Between(lambda left, right: False))
    assert isinstance(found, NoPath)
    assert len(found.blocked) and found.is_core


def test_where_one_arm_has_no_way_by_itself_that_is_told() -> None:
    # An arm is 0.951 m long ahead of the base's middle at most (see `test_arm_path`).
    paths = (line((0.6, 0.188, 0.9), (1.0, 0.188, 0.9), 0.0), APART[1])
    found = along(paths)
    assert isinstance(found, NoPath)
    assert {36, 39, 40} <= set(found.blocked.tolist())


def test_arms_of_eight_and_seven_joints_cross_as_those_of_seven_do() -> None:
    paths = (line((0.74, 0.25, 0.9), (0.74, -0.1, 0.9), 0.0), line((NEAR_M, -0.25, 0.9), (NEAR_M, 0.1, 0.9), 0.0))
    real = UNLIKE.collisions(Table(), TORSO_M)

    def is_free_of(arm: int) -> IsFree:
        return lambda _, joints: real.arm_free(arm, FAR, joints)

    found = UNLIKE.arm_paths(dict(enumerate(paths)), TORSO_M, TABLE_M, {arm: is_free_of(arm) for arm in (0, 1)}, real)
    assert not isinstance(found, NoPath) and found.shape == (41, 15)
    assert (found[:, 7] == 0.0).all(), "the eighth joint of the first arm does nothing"
    without = np.delete(found, 7, axis=1).reshape(-1, 2, 7)
    require_followed(paths, without)
    np.testing.assert_array_equal(without, joints_of(along(paths)))


def test_three_arms_go_as_they_would_alone_or_one_pair_after_the_other_gives_way() -> None:
    aside = np.array([0.0, 0.45, 0.0])
    crossing = (line((0.74, 0.25, 0.9), (0.74, -0.1, 0.9), 0.0), line((NEAR_M, -0.25, 0.9), (NEAR_M, 0.1, 0.9), 0.0))
    outer = line((0.6, 0.4, 0.9), (0.7, 0.2, 0.9), 0.0)
    paths = {0: replace(outer, positions=outer.positions + aside), 1: crossing[0], 2: crossing[1]}
    real = THREE_ARMS.collisions(Table(), TORSO_M)

    def is_free_of(arm: int) -> IsFree:
        return lambda _, joints: real.arm_free(arm, FAR, joints)

    found = THREE_ARMS.arm_paths(paths, TORSO_M, TABLE_M, {arm: is_free_of(arm) for arm in paths}, real)
    assert not isinstance(found, NoPath) and found.shape == (41, 23)
    np.testing.assert_array_equal(found[:, 7:21].reshape(-1, 2, 7), joints_of(along(crossing)))
    assert real.arms_apart((0, 1, 2), found).all()
