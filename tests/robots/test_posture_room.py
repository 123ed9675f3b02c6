"""Restrictions of an arm by the robot's own body, and the cache of them."""

import math

import numpy as np

from planner.geometry.pose import Approach, BoolArray
from planner.geometry.reach_query import ReachQuery
from planner.geometry.table import Table
from planner.robots.pr2.posture_room import empty_memory, learn, place_key, slot_of
from planner.robots.pr2.reach import APPROACHES
from tests.robots.collision_samples import FAR, HOME
from tests.robots.model import can_reach, the_pr2

ROBOT = the_pr2()
TORSO_M = 0.29
LEVEL = APPROACHES.index(Approach(0.0, math.radians(15)))

AT_THE_SHOULDER = (0.15, 0.188, 0.66)
"""Straight below and before the left shoulder, at (-0.05, 0.188, 1.08): the wrist is 3 cm ahead of it and 0.37 m
lower. Forearm and upper arm, 0.321 and 0.4 m long, are nearly folded together: the elbow's soft limit of 2.1213 rad
brings the wrist as near as 0.36 m to the lift axis, which is 10 cm ahead of the shoulder."""

AHEAD = (0.6, 0.188, 0.9)


def is_in_reach(place: tuple[float, float, float], arm: int = 0) -> bool:
    """Return whether a tool point is in reach, level, and the body leaves the arm room."""
    reach = ROBOT.reach(TORSO_M, 0.0)
    return bool(reach.standoffs(ReachQuery(arm, np.array([place]), np.array([LEVEL])))[0, 0])


def is_within_limits(place: tuple[float, float, float]) -> bool:
    """Return whether the left arm's joints allow a posture."""
    return bool(can_reach(ROBOT, 0, np.array([place]), APPROACHES[LEVEL].rotation[None], TORSO_M)[0])


def free_postures(place: tuple[float, float, float]) -> int:
    """Return how many samples of the left arm's postures there are free, the right arm at home."""
    collisions = ROBOT.collisions(Table(), TORSO_M)

    def is_free(joints: np.ndarray) -> BoolArray:
        return collisions.free(FAR, np.stack([joints, np.broadcast_to(HOME[1], joints.shape)], axis=1))

    return len(ROBOT.free_postures(0, np.array(place), APPROACHES[LEVEL].rotation, TORSO_M, is_free))


def test_joint_limits_allow_what_is_just_before_the_own_shoulder_and_the_body_does_not() -> None:
    assert is_within_limits(AT_THE_SHOULDER) and free_postures(AT_THE_SHOULDER) == 0
    assert not is_in_reach(AT_THE_SHOULDER)


def test_what_is_well_ahead_has_room() -> None:
    assert is_within_limits(AHEAD) and free_postures(AHEAD) > 0
    assert is_in_reach(AHEAD)


def test_the_right_arm_has_the_mirror_image_of_the_left_arms_room() -> None:
    rng = np.random.default_rng(3)
    places = rng.uniform((0.1, -0.1, 0.7), (0.5, 0.6, 1.3), size=(100, 3))
    left = [is_in_reach(place) for place in places]
    assert left == [is_in_reach(place * (1.0, -1.0, 1.0), arm=1) for place in places]
    assert 0 < sum(left) < len(left)


def test_a_memory_tells_places_and_labels_apart() -> None:
    memory = empty_memory(4)
    asked = [(label, x, y, -x) for label in (1, 7) for x in (-3, 5) for y in (-2, 2)]
    for number, place in enumerate(asked):
        key = place_key(*place)
        learn(memory, slot_of(memory.table, key), key, number % 3 == 0)
    for number, place in enumerate(asked):
        key = place_key(*place)
        assert memory.table[slot_of(memory.table, key)] == 2 * key + (number % 3 == 0)


def test_a_memory_that_is_three_quarters_full_learns_no_more_and_keeps_its_answers() -> None:
    memory = empty_memory(4)
    keys = [place_key(1, x, 0, 0) for x in range(20)]
    for key in keys:
        learn(memory, slot_of(memory.table, key), key, True)
    known = [memory.table[slot_of(memory.table, key)] == 2 * key + 1 for key in keys]
    assert known == [True] * 12 + [False] * 8
