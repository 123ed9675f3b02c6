"""Paths found by sampling: through a gap in a wall, always the same, and given up after bounded work."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.motion.sampled_paths import TESTED_MAX, SampledPaths, sampled

STEP_RAD = 0.05
LOW, HIGH = np.full(3, -3.0), np.full(3, 3.0)
START, GOAL = np.array([-2.0, -2.0, 0.0]), np.array([2.0, -2.0, 0.0])


def beside_the_wall(joints: FloatArray) -> BoolArray:
    """A wall 1 rad thick at joint 0, open where joints 1 and 2 are between 1.5 and 2.7."""
    is_in_wall, is_in_gap = np.abs(joints[:, 0]) < 0.5, (np.abs(joints[:, 1:] - 2.1) < 0.6).all(axis=1)
    return np.asarray(~is_in_wall | is_in_gap)


def until(are_free: Callable[[FloatArray], BoolArray]) -> Callable[[FloatArray], int]:
    """Return the number of configurations before the first that is not free."""
    return lambda joints: int(np.append(are_free(joints), False).argmin())


def no_gap(joints: FloatArray) -> BoolArray:
    return np.asarray(np.abs(joints[:, 0]) >= 0.5)


def test_a_path_goes_through_the_only_gap_of_a_wall() -> None:
    way = SampledPaths(until(beside_the_wall), LOW, HIGH, STEP_RAD).path(START, GOAL)
    assert way is not None and (way[0] == START).all() and (way[-1] == GOAL).all()
    line = np.concatenate([sampled(a, b, STEP_RAD) for a, b in pairwise(way)])
    assert beside_the_wall(line).all() and ((line >= LOW) & (line <= HIGH)).all()


def test_the_same_question_has_the_same_answer() -> None:
    first, again = (SampledPaths(until(beside_the_wall), LOW, HIGH, STEP_RAD).path(START, GOAL) for _ in range(2))
    assert first is not None and again is not None and np.array_equal(first, again)


def test_where_there_is_no_path_the_work_is_bounded() -> None:
    paths = SampledPaths(until(no_gap), LOW, HIGH, STEP_RAD)
    assert paths.path(START, GOAL) is None
    assert TESTED_MAX <= paths.tested < TESTED_MAX + 100


def test_a_start_that_is_not_free_costs_one_test_of_both_ends() -> None:
    paths = SampledPaths(until(beside_the_wall), LOW, HIGH, STEP_RAD)
    assert paths.path(np.zeros(3), GOAL) is None and paths.tested == 2


def test_joints_that_may_not_move_stay() -> None:
    low, high = np.array([-3.0, -3.0, 2.0]), np.array([3.0, 3.0, 2.0])
    start, goal = np.array([-2.0, -2.0, 2.0]), np.array([2.0, -2.0, 2.0])
    way = SampledPaths(until(beside_the_wall), low, high, STEP_RAD).path(start, goal)
    assert way is not None and (way[:, 2] == 2.0).all()


def test_the_mirror_image_of_a_question_has_the_mirror_image_of_its_answer() -> None:
    def mirror(joints: FloatArray) -> FloatArray:
        return np.asarray(joints[:, ::-1] * [1.0, -1.0, 1.0])

    def beside_its_image(joints: FloatArray) -> BoolArray:
        return beside_the_wall(mirror(joints))

    images = mirror(np.array([START, GOAL]))
    way = SampledPaths(until(beside_the_wall), LOW, HIGH, STEP_RAD, mirror).path(START, GOAL)
    image = SampledPaths(until(beside_its_image), LOW, HIGH, STEP_RAD, mirror).path(*images)
    assert way is not None and image is not None
    assert np.allclose(mirror(way), image, atol=1e-12)
    assert not np.allclose(way, image)
