"""The joints of every film: within their speeds, without a jump, and clear of everything that a hull can hit."""

from itertools import pairwise

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import settings

from planner.geometry.table import Table
from tests.laws.law import LONG
from tests.replay.hands import robot
from tests.replay.hulls import contacts
from tests.replay.planned import SOLVABLE, planned

RATE_HZ = 50.0
CHECKED_S = 1.0 / RATE_HZ if settings.get_current_profile_name() == LONG else 0.9
"""Hulls are compared this often (s): 1.3 ms a moment, and a plan takes half a minute."""

TURNS = ("forearm_roll", "wrist_roll")

each_solvable = pytest.mark.parametrize("name", SOLVABLE)


def joint_values(name: str) -> tuple[list[str], np.ndarray, float]:
    """The arms' joints, 50 samples a second, shape (n, joints), and the time between two (s)."""
    timeline = planned(name).answer.timeline()
    count = int(np.ceil(timeline.duration_s * RATE_HZ))
    frames = [timeline.at(t) for t in np.linspace(0.0, timeline.duration_s, count + 1)]
    names = [joint for joint in frames[0].joints if joint.split("_", 1)[1].endswith(("_joint",)) and joint[1] == "_"]
    arms = [joint for joint in names if not joint.split("_", 1)[1].startswith("gripper")]
    values = np.array([[frame.joints[joint] for joint in arms] for frame in frames])
    return arms, values, timeline.duration_s / count


def speed_limits(joints: list[str]) -> np.ndarray:
    model, _ = robot()
    return np.array([model.velocityLimit[model.joints[model.getJointId(joint)].idx_v] for joint in joints])


@each_solvable
def test_no_joint_of_an_arm_is_faster_than_the_urdf_allows(name: str):
    joints, values, step_s = joint_values(name)
    speeds = np.abs(np.diff(values, axis=0)) / step_s
    over = speeds / speed_limits(joints)
    worst = np.unravel_index(over.argmax(), over.shape)
    assert over.max() <= 1.0 + 1e-6, f"{joints[worst[1]]} at {worst[0] * step_s:.2f} s: {over.max():.2f} of its speed"


@each_solvable
def test_rolls_are_unwound_so_that_they_never_jump_by_a_turn(name: str):
    joints, values, _ = joint_values(name)
    rolls = [i for i, joint in enumerate(joints) if any(turn in joint for turn in TURNS)]
    assert max(np.abs(b - a).max() for a, b in pairwise(values[:, rolls])) < np.pi / 8


@each_solvable
def test_nothing_touches_anything_but_the_cloth(name: str):
    case = planned(name)
    timeline = case.answer.timeline()
    for t in np.arange(0.4 * CHECKED_S, timeline.duration_s, CHECKED_S):
        frame = timeline.at(float(t))
        base = (frame.base.x_m, frame.base.y_m, frame.base.yaw_rad)
        found = contacts(frame.joints, base, Table(**case.scene["table"]))
        assert not found, f"at {t:.2f} s: {found}"


def test_the_speed_limits_are_read_from_the_urdf():
    assert speed_limits(["l_shoulder_pan_joint"])[0] == pytest.approx(2.088)
    assert isinstance(robot()[0], pin.Model)
