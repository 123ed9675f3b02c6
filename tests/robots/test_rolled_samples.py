"""Samples of an arm whose last joint gives the roll: they take the pose, and none of the general ones is missing."""

import math

import numpy as np
import pytest

from planner.geometry.pose import Approach, FloatArray
from planner.robots.chain import tool_poses
from planner.robots.described_robot import read_robot
from planner.robots.mapped_arm import ALL_ROUND, MappedArm
from planner.robots.posture_samples import gives_roll_alone, posture_samples, unrolled
from planner.robots.reach_maps import reach_map

FLOOR_M = 0.75


@pytest.fixture(scope="module")
def ur5e(tmp_path_factory: pytest.TempPathFactory) -> MappedArm:
    """Return an arm with a map one cell high: whole maps take seconds."""
    arm = read_robot("ur5e-pair").arms[0]
    height_m = FLOOR_M + 0.02 - float(arm.root[2])
    cache = tmp_path_factory.mktemp("cache")
    return MappedArm(arm, reach_map(arm.chain, ALL_ROUND, (height_m, height_m + 0.01), directory=cache))


def rolled(approach: Approach, roll_rad: float) -> FloatArray:
    c, s = math.cos(roll_rad), math.sin(roll_rad)
    return np.asarray(approach.rotation @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]))


def samples(found: tuple[FloatArray, FloatArray]) -> FloatArray:
    """Return the samples of one pose, shape (k, joints)."""
    joints, costs = found
    return np.asarray(joints[0, np.isfinite(costs[0])])


def test_an_arm_whose_tool_is_beside_its_last_axis_is_not_one_of_them() -> None:
    assert gives_roll_alone(read_robot("ur5e-pair").arms[0].chain)
    assert not gives_roll_alone(read_robot("so101-pair").arms[0].chain)


def test_equal_axes_have_equal_rotations_whatever_their_roll() -> None:
    approach = Approach(0.4, math.radians(60))
    (one, other) = unrolled(np.array([rolled(approach, 0.0), rolled(approach, 0.5 * math.pi)]))
    assert one.tobytes() == other.tobytes()
    np.testing.assert_allclose(one[:, 0], approach.rotation[:, 0], atol=1e-12)
    np.testing.assert_allclose(one @ one.T, np.eye(3), atol=1e-12)


def test_samples_take_their_pose_or_one_rolled_by_half_a_turn_as_those_of_the_whole_pose_do(ur5e: MappedArm) -> None:
    rng, chain, shoulder, posed = np.random.default_rng(1), ur5e.chain, ur5e.shoulder(0.0), 0
    for _ in range(40):
        point = np.array([*rng.uniform((0.3, -0.3), (0.7, 0.3)), FLOOR_M + 0.025]) - shoulder
        rotation = rolled(ALL_ROUND[rng.integers(len(ALL_ROUND))], rng.uniform(-math.pi, math.pi))
        able = samples(ur5e.samples(point[None] + shoulder, rotation[None], 0.0, FLOOR_M))
        places, axes = tool_poses(chain, able)
        np.testing.assert_allclose(places, np.tile(point, (len(able), 1)), atol=2e-6)
        for found in axes:
            half = np.diag([1.0, -1.0, -1.0]) if found[:, 1] @ rotation[:, 1] < 0.0 else np.eye(3)
            np.testing.assert_allclose(found, rotation @ half, atol=1e-5)
        floor = FLOOR_M - float(shoulder[2])
        whole = samples(posture_samples(chain, ur5e.known, ur5e.periods, point[None], rotation[None], floor))
        posed += bool(len(whole))
        for one in whole:
            off = np.abs(np.remainder(able - one + math.pi, math.tau) - math.pi).max(axis=1)
            assert off.min(initial=math.inf) < 0.2, f"{one} is none of the samples"
    assert posed >= 10
