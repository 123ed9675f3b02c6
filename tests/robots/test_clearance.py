"""Arms low over cloth are distinguished from others."""

import numpy as np
import pytest

from planner.geometry.table import Table
from tests.robots.collision_samples import FRONT, HOME, ROBOT, TORSO_M
from tests.robots.model import joints_near

OVER_M = 0.03
DOWN = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
ELBOW_OUT = np.array([0.8, -0.2, 1.0, -1.8, 0.0, -1.4, 0.0])
CLOTH = np.array([(-0.5, 0.1), (-0.3, 0.1), (-0.3, 0.4), (-0.5, 0.4)])
"""Cloth in the base frame at `front` from 0.45 to 0.65 m ahead; the tool is in its middle at 0.55 m."""


def pointing_down(arm: int, height_m: float, ahead_m: float = 0.55) -> np.ndarray:
    side = 1.0 - 2.0 * arm
    place = np.array([ahead_m, side * 0.25, Table().height_m + height_m])
    near = ELBOW_OUT if arm == 0 else ELBOW_OUT * [-1, 1, -1, 1, -1, 1, -1]
    joints = joints_near(ROBOT, arm, place, DOWN, TORSO_M, near)
    assert joints is not None
    return joints


@pytest.mark.parametrize("arm", [0, 1])
def test_fingertips_must_be_so_high_over_cloth_and_not_beside_it(arm: int) -> None:
    # Tips end 19 mm below the tool frame.
    piece = CLOTH * [1.0, 1.0 - 2.0 * arm]
    clearance = ROBOT.collisions(Table(), TORSO_M).over_cloth([piece[:: 1 - 2 * arm]], OVER_M)
    joints = np.array([pointing_down(arm, z) for z in (0.02, 0.045, 0.055, 0.1)])
    found = clearance.arm_clear(arm, FRONT, joints)
    assert found.tolist() == [False, False, True, True]
    assert clearance.arm_clear(arm, FRONT, pointing_down(arm, 0.02, 0.4)[None]).tolist() == [True]


def test_without_cloth_everything_is_clear() -> None:
    clearance = ROBOT.collisions(Table(), TORSO_M).over_cloth([], OVER_M)
    assert clearance.arm_clear(0, FRONT, pointing_down(0, 0.0)[None]).tolist() == [True]


def test_arms_at_home_are_clear_of_cloth_on_all_of_the_table() -> None:
    whole = np.array(Table().corners)
    clearance = ROBOT.collisions(Table(), TORSO_M).over_cloth([whole], OVER_M)
    assert all(clearance.arm_clear(arm, FRONT, HOME[arm][None]).all() for arm in (0, 1))
