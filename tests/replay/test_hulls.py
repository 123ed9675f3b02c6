"""The independent check of collisions finds those that are there."""

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.table import Table
from planner.robots.load_robot import load_robot
from planner.robots.pr2.robot import Pr2
from tests.replay.hulls import are_compared, contacts
from tests.required import required
from tests.robots.model import joints_near

ROBOT = load_robot("pr2")
HOME = (ROBOT.home(0), ROBOT.home(1))
FRONT, FAR = (-0.95, 0.0, 0.0), (-5.0, 0.0, 0.0)


def seen(
    left: FloatArray, right: FloatArray, base: tuple[float, float, float] = FAR, torso_m: float = 0.29
) -> list[tuple[str, str, float]]:
    return contacts(ROBOT.card.joint_values(torso_m, [left, right], [0.06, 0.06]), base, Table())


def test_arms_at_home_touch_nothing() -> None:
    assert seen(*HOME, base=FRONT) == []


def test_a_hand_through_the_table_is_seen_and_how_deep() -> None:
    # Straight down, fingers end 15 mm above the tool frame, and the palm 55 mm. With the tool 50 mm below the upper
    # side, fingers are 35 mm deep in the top, which is 30 mm thick, tips are nearly through it, the palm is not in it.
    elbow_out, down = np.array([0.8, -0.2, 1.0, -1.8, 0.0, -1.4, 0.0]), [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
    assert isinstance(ROBOT, Pr2)
    joints = required(joints_near(ROBOT, 0, np.array([0.5, 0.2, 0.74]), np.array(down, dtype=float), 0.29, elbow_out))
    found = {(a, b): depth for a, b, depth in seen(joints, HOME[1], base=FRONT)}
    fingers = [(f"l_gripper_{side}_finger_link", "table top") for side in "lr"]
    tips = [(f"l_gripper_{side}_finger_tip_link", "table top") for side in "lr"]
    assert found.keys() == {*fingers, *tips}
    assert all(abs(found[finger] - 0.035) < 0.002 for finger in fingers)
    assert seen(joints, HOME[1]) == []


def test_arms_crossed_before_the_chest_are_seen() -> None:
    crossed = np.array([-0.6, 0.0, 0.0, -0.2, 0.0, -0.2, 0.0])
    pairs = {(a, b) for a, b, _ in seen(crossed, crossed * [-1, 1, -1, 1, -1, 1, -1])}
    assert any({a[:2], b[:2]} == {"l_", "r_"} for a, b in pairs)


def test_neighbours_are_not_compared_and_the_two_arms_are() -> None:
    assert not are_compared("torso_lift_link", "l_upper_arm_link")
    assert not are_compared("l_forearm_link", "l_gripper_palm_link")
    assert not are_compared("l_gripper_l_finger_tip_link", "l_gripper_r_finger_tip_link")
    assert are_compared("torso_lift_link", "l_forearm_link")
    assert are_compared("l_shoulder_pan_link", "r_shoulder_pan_link")
    assert are_compared("head_tilt_link", "l_gripper_palm_link")
