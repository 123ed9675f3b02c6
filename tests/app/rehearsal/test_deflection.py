"""Arms that are a little beside where the robot believes them to be."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.camera.posture import Posture
from app.rehearsal.noisy_world import deflected
from planner.geometry.pose import FloatArray, Pose2
from planner.robots.load_robot import load_robot
from tests.sweep import sweep


def home(robot: str) -> Posture:
    card = load_robot(robot).card
    joints = card.joint_values(card.lift_limits_m[1], [np.array(arm.home) for arm in card.arms], [0.0] * len(card.arms))
    return Posture(Pose2(0.4, -0.2, 0.7), joints)


def tools(robot: str, posture: Posture) -> list[FloatArray]:
    """Where the tools are, table frame, shape (3,), m, each."""
    one = load_robot(robot)
    torso_m = posture.joints.get(one.card.lift_joint or "", 0.0)
    found = []
    for number, arm in enumerate(one.card.arms):
        place = one.tool_pose(number, np.array([posture.joints[name] for name in arm.joint_names]), torso_m)[0]
        found.append(np.array([*posture.base.to_outer(place[None, :2])[0], place[2]]))
    return found


@sweep("robot", ["pr2", "panda-pair", "so101-pair", "tiago-pro"], quick=["pr2", "so101-pair"])
def test_tools_come_to_be_beside_their_places_by_small_turns_of_all_joints(robot: str) -> None:
    posture, arms = home(robot), load_robot(robot).card.arms
    beside = {arm.name: np.array([0.003, -0.002 * number]) for number, arm in enumerate(arms)}
    stands = deflected(robot, posture, beside)
    for there, here, arm in zip(tools(robot, stands), tools(robot, posture), arms, strict=True):
        assert there - here == pytest.approx([*beside[arm.name], 0.0], abs=3e-4)
        turned = [abs(stands.joints[name] - posture.joints[name]) for name in arm.joint_names]
        assert 0.0 < max(turned) < math.radians(2.0)
    assert stands.base == posture.base


def test_other_arms_and_joints_stay() -> None:
    posture = home("pr2")
    stands = deflected("pr2", posture, {"left": np.array([0.002, 0.001])})
    right = load_robot("pr2").card.arms[1]
    moved = {name for name, value in stands.joints.items() if value != posture.joints[name]}
    assert moved and not moved & set(right.joint_names)
    assert replace(stands, joints=posture.joints) == posture
