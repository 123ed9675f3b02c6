"""The memory that a robot takes once it has been planned for: its maps are in it once."""

import gc
from types import FunctionType, ModuleType

import numpy as np

from planner.robots.card_robot import CardRobot
from planner.robots.described_robot import read_robot
from planner.robots.load_robot import load_robot
from planner.robots.mapped_arm import all_arms
from tests.sweep import sweep

NONE_OF_IT = (type, ModuleType, FunctionType)


def held_mb(root: object) -> float:
    """Return the size of all arrays that an object holds (MB)."""
    seen, stack, size = set(), [root], 0
    while stack:
        one = stack.pop()
        if id(one) in seen or isinstance(one, NONE_OF_IT):
            continue
        seen.add(id(one))
        if isinstance(one, np.ndarray):
            size += one.nbytes if one.base is None else 0
            stack.append(one.base)
        else:
            stack.extend(gc.get_referents(one))
    return size / 1e6


@sweep("name", ["so101-pair", "ur5e-pair"], quick=["so101-pair"])
def test_the_maps_of_a_robots_arms_are_in_memory_once(name: str) -> None:
    robot = load_robot(name)
    assert isinstance(robot, CardRobot)
    robot.forget_reach()  # what other tests have asked of it is more than its maps
    robot.reach(0.0, 0.03)
    arms = all_arms(read_robot(name))
    maps_mb = sum(arm.size_mb for arm in arms)
    assert maps_mb < held_mb(robot) < 1.25 * maps_mb + 6.0
    rng = np.random.default_rng(1)
    for mine, alone in zip(robot.prepare(), arms, strict=True):
        low, high = np.maximum(alone.chain.low, -2.0), np.minimum(alone.chain.high, 2.0)
        poses = [alone.tool_pose(rng.uniform(low, high), 0.0) for _ in range(300)]
        places, axes = (np.array(each) for each in zip(*poses, strict=True))
        can, joints = mine.joints(places, axes)
        expected, others = alone.joints(places, axes)
        assert expected.any()
        np.testing.assert_array_equal(can, expected)
        np.testing.assert_array_equal(joints[can], others[can])
