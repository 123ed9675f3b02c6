"""Forward and inverse kinematics in closed form, against pinocchio."""

import numpy as np
import pytest

from tests.required import required
from tests.robots.model import joints_near, limits, pin_tool_pose, random_joints, the_pr2

ROBOT = the_pr2()
CARD = ROBOT.card


@pytest.mark.parametrize("arm", [0, 1])
def test_the_tool_is_where_pinocchio_says(arm: int) -> None:
    rng = np.random.default_rng(1)
    for _ in range(200):
        joints, torso_m = random_joints(CARD, arm, rng), rng.uniform(*CARD.lift_limits_m)
        position, rotation = ROBOT.tool_pose(arm, joints, torso_m)
        expected_position, expected_rotation = pin_tool_pose(CARD, arm, joints, torso_m)
        np.testing.assert_allclose(position, expected_position, atol=1e-12)
        np.testing.assert_allclose(rotation, expected_rotation, atol=1e-12)


@pytest.mark.parametrize("arm", [0, 1])
def test_joints_found_bring_the_tool_to_the_pose_within_limits(arm: int) -> None:
    rng = np.random.default_rng(2)
    low, high = limits(CARD, arm)
    for _ in range(500):
        torso_m = rng.uniform(*CARD.lift_limits_m)
        position, rotation = ROBOT.tool_pose(arm, random_joints(CARD, arm, rng), torso_m)
        found = joints_near(ROBOT, arm, position, rotation, torso_m, random_joints(CARD, arm, rng))
        assert found is not None
        assert np.all((low <= found) & (found <= high))
        reached, turned = pin_tool_pose(CARD, arm, found, torso_m)
        np.testing.assert_allclose(reached, position, atol=2e-9)
        np.testing.assert_allclose(turned, rotation, atol=2e-9)


@pytest.mark.parametrize("arm", [0, 1])
def test_the_joints_found_near_a_solution_are_that_solution(arm: int) -> None:
    rng = np.random.default_rng(4)
    for _ in range(300):
        joints = random_joints(CARD, arm, rng)
        found = required(joints_near(ROBOT, arm, *ROBOT.tool_pose(arm, joints, 0.1), 0.1, joints))
        np.testing.assert_allclose(found, joints, atol=1e-6)


def test_out_of_reach_there_are_no_joints() -> None:
    assert joints_near(ROBOT, 0, np.array([2.0, 0.0, 1.0]), np.eye(3), 0.1, ROBOT.home(0)) is None


@pytest.mark.parametrize("torso_m", [0.0, 0.3])
def test_mirrored_poses_have_mirrored_joints(torso_m: float) -> None:
    rng = np.random.default_rng(7)
    mirror = np.array([1.0, -1.0, 1.0])
    sides = np.array([-1, 1, -1, 1, -1, 1, -1])
    for _ in range(50):
        near = random_joints(CARD, 0, rng)
        position, rotation = ROBOT.tool_pose(0, random_joints(CARD, 0, rng), torso_m)
        left = required(joints_near(ROBOT, 0, position, rotation, torso_m, near))
        turned = mirror[:, None] * rotation * mirror
        right = required(joints_near(ROBOT, 1, mirror * position, turned, torso_m, sides * near))
        np.testing.assert_allclose(right, sides * left, atol=1e-9)
