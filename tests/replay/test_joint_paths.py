"""The joints of every trajectory: within their speeds and soft limits, without a jump, and clear of all hulls."""

from importlib.metadata import distribution
from itertools import pairwise
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import settings

from planner.geometry.keyframes import values_at
from planner.geometry.table import Table
from planner.motion.timeline import Timeline
from tests.laws.law import LONG
from tests.replay.hands import URDF, robot
from tests.replay.joints import RATE_HZ, arm_joints, require_clear, require_speeds, speed_limits
from tests.replay.planned import each_solvable, planned, shipped_plan

CHECKED_S = 1.0 / RATE_HZ if settings.get_current_profile_name() == LONG else 0.9
"""The time between two checks of the hulls (s): a check takes 1.3 ms, and a plan half a minute."""

TURNS = ("forearm_roll", "wrist_roll")


@each_solvable
def test_no_joint_of_an_arm_is_faster_than_the_urdf_allows(name: str) -> None:
    require_speeds(Timeline.of(shipped_plan(name)))


@each_solvable
def test_rolls_are_unwound_so_that_they_never_jump_by_a_turn(name: str) -> None:
    joints, values, _ = arm_joints(Timeline.of(shipped_plan(name)))
    rolls = [i for i, joint in enumerate(joints) if any(turn in joint for turn in TURNS)]
    assert max(np.abs(b - a).max() for a, b in pairwise(values[:, rolls])) < np.pi / 8


@each_solvable
def test_nothing_touches_anything_but_the_cloth(name: str) -> None:
    case = planned(name)
    require_clear(Timeline.of(case.found.plan), Table(**case.scene["table"]), CHECKED_S)


def test_the_speed_limits_are_read_from_the_urdf() -> None:
    assert speed_limits(["l_shoulder_pan_joint"])[0] == pytest.approx(2.088)
    assert isinstance(robot()[0], pin.Model)


STEP_S = 0.01
ROUNDING = 1e-6


def soft_limits() -> dict[str, tuple[float, float]]:
    """Return the soft limits of the joints that have them, as the URDF's text says."""
    root = ElementTree.parse(str(distribution("example-robot-data").locate_file(URDF))).getroot()
    found = {joint.get("name", ""): joint.find("safety_controller") for joint in root.iterfind("joint")}
    return {
        name: (float(own.attrib["soft_lower_limit"]), float(own.attrib["soft_upper_limit"]))
        for name, own in found.items()
        if own is not None and "soft_lower_limit" in own.attrib
    }


@each_solvable
def test_all_joints_stay_within_the_soft_limits_all_the_time(name: str) -> None:
    path, limits = shipped_plan(name).trajectory, soft_limits()
    assert path is not None and len({*path.arms.names} & {*limits}) == 10
    times_s = np.array(path.arms.times_s)
    rows = values_at(times_s, path.arms.rows, path.arms.rates, np.arange(times_s[0], times_s[-1], STEP_S))
    for joint, column in zip(path.arms.names, np.concatenate([rows, path.arms.rows]).T, strict=True):
        if joint in limits:
            low, high = limits[joint]
            assert low - ROUNDING <= column.min() and column.max() <= high + ROUNDING, joint
    low_m, high_m = limits["torso_lift_joint"]
    assert low_m <= path.torso_m <= high_m
