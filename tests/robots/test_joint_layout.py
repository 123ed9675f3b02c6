"""Where arms' joints are in a configuration, for arms with different numbers of them."""

import numpy as np
import pytest

from planner.robots.card import JointLayout
from tests.robots.remade import ONE_ARM, THREE_ARMS, UNLIKE, RemadeRobot


@pytest.mark.parametrize("robot", [ONE_ARM, UNLIKE, THREE_ARMS])
def test_a_configuration_has_the_joints_of_the_card_arm_by_arm(robot: RemadeRobot) -> None:
    layout = JointLayout.of(robot.card)
    for number, arm in enumerate(robot.card.arms):
        np.testing.assert_array_equal(layout.home[layout.spans[number]], arm.home)
        np.testing.assert_array_equal(layout.speeds_rad_s[layout.spans[number]], arm.speeds_rad_s)
        assert (layout.owners[layout.spans[number]] == number).all()
    assert len(layout.home) == sum(len(arm.joint_names) for arm in robot.card.arms)


def test_some_arms_joints_are_found_among_all() -> None:
    layout = JointLayout.of(THREE_ARMS.card)  # 7, 7 and 9 joints
    every = np.arange(23)
    assert every[layout.joints_of((0, 2))].tolist() == [*range(7), *range(14, 23)]
    assert every[layout.joints_of((0, 1, 2))].tolist() == every.tolist()


def test_homes_are_new_arrays() -> None:
    layout = JointLayout.of(ONE_ARM.card)
    layout.at_home(2)[:] = 5.0
    assert layout.at_home(2).max() < 5.0
