"""The duration of waypoints: laws of the pace, and a few paces worked out by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from planner.geometry.pose import FloatArray
from planner.motion.pacing import needed_s, paced_s

EASINGS = st.floats(0.01, 0.5)


def steps(low: float, high: float, count: int = 12) -> st.SearchStrategy[np.ndarray]:
    return hnp.arrays(float, count, elements=st.floats(low, high))


def test_a_step_needs_the_time_of_its_slowest_joint() -> None:
    speeds = np.array([2.0, 1.0, 1.0, 1.0, 1.0, 1.0, 4.0])
    joints = np.zeros((3, 7))
    # First the pan turns by 1 rad at 2 rad/s while the wrist rolls by 1 rad at 4 rad/s: 0.5 s and 0.25 s.
    joints[1:, [0, 6]] = 1.0
    # Then the lift goes back by 0.3 rad at 1 rad/s, and the wrist rolls by 2 rad at 4 rad/s: 0.3 s and 0.5 s.
    joints[2, 1], joints[2, 6] = -0.3, 3.0
    assert needed_s(joints, speeds) == pytest.approx([0.5, 0.5])


def test_of_two_arms_the_slower_one_counts() -> None:
    joints = np.zeros((2, 2, 7))
    joints[1, 0, 2], joints[1, 1, 4] = 0.2, -0.6
    # 0.2 / 1 = 0.2 s for the left arm, 0.6 / 2 = 0.3 s for the right one.
    assert needed_s(joints.reshape(2, 14), np.array([1.0] * 7 + [2.0] * 7)) == pytest.approx([0.3])


def test_a_single_configuration_needs_no_time() -> None:
    assert needed_s(np.zeros((1, 14)), np.ones(14)).tolist() == []


def test_steps_that_are_no_shorter_than_they_must_be_keep_their_pace() -> None:
    nominal = np.array([1.0, 2.0, 0.5])
    assert paced_s(nominal, np.array([0.9, 2.0, 0.0])).tolist() == nominal.tolist()


def test_what_a_slow_step_takes_is_taken_evenly_from_the_others() -> None:
    # Of 4 s one step needs 2 and the others next to nothing: 2 / 3 s are left for each of them.
    assert paced_s(np.ones(4), np.array([2.0, 0.0, 0.5, 0.1])) == pytest.approx([2.0, 2 / 3, 2 / 3, 2 / 3])


def test_a_step_that_cannot_give_its_share_gives_what_it_can() -> None:
    # The third needs 0.9 of its second: 4 - 2 - 0.9 = 1.1 s are left for two.
    assert paced_s(np.ones(4), np.array([2.0, 0.0, 0.9, 0.1])) == pytest.approx([2.0, 0.55, 0.9, 0.55])


def test_longer_steps_keep_longer_shares() -> None:
    # Of 1 + 1 + 3 s the first needs 3: 2 s are shared as 1 to 3.
    assert paced_s(np.array([1.0, 1.0, 3.0]), np.array([3.0, 0.0, 0.0])) == pytest.approx([3.0, 0.5, 1.5])


def test_steps_that_need_more_than_there_is_take_what_they_need() -> None:
    assert paced_s(np.ones(3), np.array([2.0, 0.5, 1.0])).tolist() == [2.0, 0.5, 1.0]


@given(steps(0.001, 1.0), steps(0.0, 1.5))
def test_no_step_is_shorter_than_it_needs_and_together_they_last_no_longer_than_they_must(
    nominal: FloatArray, least: FloatArray
) -> None:
    found = paced_s(nominal, least)
    assert (found >= least).all()
    assert found.sum() == pytest.approx(max(nominal.sum(), least.sum()))


@given(steps(0.001, 1.0), steps(0.0, 1.5))
def test_all_steps_that_are_not_as_quick_as_can_be_have_one_pace(nominal: FloatArray, least: FloatArray) -> None:
    found = paced_s(nominal, least)
    if least.sum() < nominal.sum():
        paces = (found / nominal)[found > least + 1e-9]
        assert np.ptp(paces) < 1e-6
        assert (found[found <= least + 1e-9] >= (paces.min() * nominal)[found <= least + 1e-9] - 1e-6).all()
