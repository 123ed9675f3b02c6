"""Joints keep the soft limits of a URDF's safety controllers: cards, reach, homes, lifts."""

from xml.etree import ElementTree

import numpy as np
import pytest

from planner.geometry.pose import Approach
from planner.robots.armed_robot import ArmedRobot
from planner.robots.chain_reader import limits_of
from planner.robots.described_robot import read_robot
from planner.robots.known_robots import shipped_robots
from planner.robots.load_robot import load_robot
from tests.robots.model import can_reach, the_pr2


def joint(limits: str, soft: str, kind: str = "revolute") -> ElementTree.Element:
    return ElementTree.fromstring(f'<joint name="j" type="{kind}"><limit {limits}/>{soft}</joint>')


@pytest.mark.parametrize(
    ("limits", "soft", "kept"),
    [
        ('lower="-2" upper="1"', "", (-2.0, 1.0)),
        ('lower="-2" upper="1"', '<safety_controller soft_lower_limit="-1.5" soft_upper_limit=".5"/>', (-1.5, 0.5)),
        ('lower="-2" upper="1"', '<safety_controller soft_lower_limit="-3" soft_upper_limit=".5"/>', (-2.0, 0.5)),
        ('lower="-2" upper="1"', '<safety_controller soft_lower_limit="-1.5"/>', (-1.5, 0.0)),
        ('lower="-2" upper="1"', '<safety_controller k_velocity="2"/>', (-2.0, 1.0)),
    ],
)
def test_the_narrower_of_hard_and_soft_limits_counts(limits: str, soft: str, kept: tuple[float, float]) -> None:
    assert limits_of(joint(limits, soft)) == kept


def test_a_joint_that_turns_without_end_has_none() -> None:
    soft = '<safety_controller soft_lower_limit="-1" soft_upper_limit="1"/>'
    assert limits_of(joint('effort="1"', soft, "continuous")) == (-np.inf, np.inf)


@pytest.mark.parametrize("name", shipped_robots())
def test_homes_and_lifts_of_shipped_robots_are_within_the_soft_limits(name: str) -> None:
    robot, described = load_robot(name), read_robot(name)
    soft = {one.get("name"): one.find("safety_controller") for one in ElementTree.fromstring(described.urdf)}
    values = dict(zip(*_home(robot), strict=True)) | {described.card.lift: described.card.scene.torso_m}
    for joint_name, value in values.items():
        own = soft.get(joint_name)
        if own is not None and "soft_lower_limit" in own.attrib:
            assert float(own.attrib["soft_lower_limit"]) <= value <= float(own.attrib["soft_upper_limit"]), joint_name


def _home(robot: ArmedRobot) -> tuple[list[str], list[float]]:
    arms = robot.card.arms
    return [name for arm in arms for name in arm.joint_names], [q for arm in arms for q in arm.home]


def test_a_pr2_does_not_reach_what_only_a_straight_elbow_reaches() -> None:
    # Shoulder, elbow and wrist 0.4 and 0.321 m apart: at -0.15 rad, the soft limit, the wrist is 2.0 mm nearer to the
    # shoulder than with the elbow straight.
    pr2 = the_pr2()
    shape = pr2._arms[0].shape
    ahead = np.array([1.0, 0.0, 0.0])
    straight = Approach(0.0, 0.0).rotation[None]
    shoulder = np.array([shape.shoulder_x + shape.offset, shape.shoulder_y, shape.shoulder_z + 0.2])
    bent_m = np.sqrt(shape.upper**2 + shape.fore**2 + 2.0 * shape.upper * shape.fore * np.cos(0.15))
    for beyond_m, is_reached in ((-2e-3, True), (1e-3, False)):
        point = shoulder + (bent_m + beyond_m + shape.tool) * ahead
        assert bool(can_reach(pr2, 0, point[None], straight, 0.2)[0]) is is_reached
