"""A plan from elsewhere keeps the limits of joints, fingers and base, in speed and in acceleration."""

import re
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner import Plan, Scene
from planner.errors import RequestError
from planner.geometry.keyframes import extremes, peaks, rate_at, value_at
from planner.motion.motion_values import MotionLimits
from planner.planning.plan_check import require_replay
from planner.planning.problem import Problem
from planner.task.trajectory import Trajectory
from tests.replay.planned import shipped_plan

FACTOR = 3.0


@pytest.fixture(scope="module")
def plan() -> Plan:
    """A plan in which arms, fingers and base move."""
    found = shipped_plan("jeans")
    assert {step.kind for step in found.steps} >= {"move", "fold"}
    return found


def hasty_arms(path: Trajectory) -> Trajectory:
    """Let a joint pass its keyframes at three times its speed."""
    fastest = np.abs(path.arms.rates).max(axis=0).argmax()
    rates = path.arms.rates.copy()
    rates[:, fastest] *= FACTOR
    return replace(path, arms=replace(path.arms, velocities=tuple(map(tuple, rates.tolist()))))


def hasty_fingers(path: Trajectory) -> Trajectory:
    hand = max(path.grippers, key=lambda track: len(track.times_s))
    quick = replace(hand, velocities=tuple(FACTOR * rate for rate in hand.velocities))
    return replace(path, grippers=tuple(quick if track is hand else track for track in path.grippers))


def hasty_base(path: Trajectory) -> Trajectory:
    segments = [replace(own, base_rates=tuple(FACTOR * rate for rate in own.base_rates)) for own in path.segments]
    return replace(path, segments=tuple(segments))


def test_a_plan_keeps_its_limits(plan: Plan) -> None:
    read = Plan.from_dict(plan.to_dict())
    require_replay(read)
    assert read == plan


@pytest.mark.parametrize(
    ("spoil", "what"),
    [(hasty_arms, r"_joint (moves|speeds up)"), (hasty_fingers, "gripper"), (hasty_base, "the base")],
)
def test_one_that_does_not_is_refused_with_what_is_too_fast_and_when(
    plan: Plan, spoil: Callable[[Trajectory], Trajectory], what: str
) -> None:
    assert plan.trajectory is not None
    with pytest.raises(RequestError, match=what) as caught:
        require_replay(replace(plan, trajectory=spoil(plan.trajectory)))
    assert re.fullmatch(r"steps\[\d\]\.trajectory", caught.value.field)
    assert "times as" in caught.value.message and "at " in caught.value.message


def test_too_hard_an_acceleration_is_refused_where_no_speed_is_too_great(
    plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = MotionLimits.of(Problem.of(plan.task).robot.card, plan.task.scene)
    weaker = replace(own, accelerations=0.5 * own.accelerations)
    monkeypatch.setattr(MotionLimits, "of", lambda *_: weaker)
    with pytest.raises(RequestError, match=r"speeds up or slows down (1\.9|2\.0)"):
        require_replay(plan)


def test_a_slower_base_than_a_plan_was_made_for_is_told(plan: Plan) -> None:
    slow = replace(plan.task.scene, base_speed_m_s=0.5 * Scene().base_speed_m_s)
    with pytest.raises(RequestError) as caught:
        require_replay(replace(plan, task=replace(plan.task, scene=slow)))
    assert "the base" in caught.value.message


value = st.floats(-2.0, 2.0)


@given(st.lists(st.tuples(st.floats(0.05, 2.0), value, value), min_size=2, max_size=5))
def test_the_peaks_between_keyframes_are_those_of_the_cubic(keyframes: list[tuple[float, float, float]]) -> None:
    gaps, values, rates = (np.array(column) for column in zip(*keyframes, strict=True))
    times = np.cumsum(gaps)
    speeds, accelerations = peaks(times, values[:, None], rates[:, None])
    for number, (start, end) in enumerate(pairwise(times)):
        at = np.linspace(start, end, 400, endpoint=False)
        sampled = np.array([rate_at(times.tolist(), values, rates, t) for t in at])
        assert speeds[number, 0] == pytest.approx(
            max(np.abs(sampled).max(), abs(rates[number + 1])), rel=1e-3, abs=1e-3
        )
        hardest = np.abs(np.diff(sampled) / np.diff(at)).max()
        assert hardest <= accelerations[number, 0] * (1.0 + 1e-6) + 1e-6
        assert accelerations[number, 0] == pytest.approx(hardest, rel=2e-2, abs=2e-2)
        assert value_at(times.tolist(), values, rates, start) == pytest.approx(values[number])


def test_an_elbow_beyond_its_soft_limit_is_refused_with_the_joint_and_how_far(plan: Plan) -> None:
    path = plan.trajectory
    assert path is not None
    elbow = path.arms.names.index("l_elbow_flex_joint")
    rows, rates = path.arms.rows.copy(), path.arms.rates.copy()
    rows[:, elbow], rates[:, elbow] = -0.1, 0.0  # its limits are -2.1213 and -0.15 rad
    still = replace(path.arms, positions=tuple(map(tuple, rows.tolist())), velocities=tuple(map(tuple, rates.tolist())))
    with pytest.raises(RequestError, match=r"l_elbow_flex_joint is 0\.050 rad beyond its limits -2\.1213 and -0\.15"):
        require_replay(replace(plan, trajectory=replace(path, arms=still)))


@given(st.lists(st.tuples(*[st.floats(-2.0, 2.0)] * 2), min_size=2, max_size=4))
def test_extremes_between_keyframes_are_those_of_a_dense_sampling(keyframes: list[tuple[float, float]]) -> None:
    values, rates = (np.array(column)[:, None] for column in zip(*keyframes, strict=True))
    times = np.arange(len(values), dtype=float)
    low, high = extremes(times, values, rates)
    for number in range(len(times) - 1):
        there = [float(value_at(times.tolist(), values, rates, number + s)[0]) for s in np.linspace(0.0, 0.9999, 400)]
        assert min(there) == pytest.approx(low[number, 0], abs=1e-3)
        assert max(there) == pytest.approx(high[number, 0], abs=1e-3)
        assert low[number, 0] <= min(there) + 1e-9 and high[number, 0] >= max(there) - 1e-9
