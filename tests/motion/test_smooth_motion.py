"""A smooth motion goes through the plan's keyframes, keeps its limits, and rests between steps."""

from dataclasses import replace
from functools import cache
from itertools import islice

import numpy as np
import pytest
from scipy.optimize import brentq

from planner import Plan
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import Pose2
from planner.motion.motion_limits import RISE_S, MotionLimits
from planner.motion.smooth_motion import PACE_MAX, SmoothStep, smooth_steps
from planner.task.trajectory import Segment
from tests.small_plan import CARD, one_armed, small_plan, unsolved

PLAN = small_plan()
LIMITS = MotionLimits.of(CARD, PLAN.scene)
PATH = PLAN.trajectory
JOINTS = slice(0, len(PATH.arms.names)) if PATH else slice(0)
BETWEEN = 5e-3
"""The share by which limits may be exceeded between the points where they are solved for."""


def askew(plan: Plan, angle: float) -> Plan:
    """Return a plan whose base is turned about the table frame's origin."""
    assert plan.trajectory is not None
    cos, sin = np.cos(angle), np.sin(angle)

    def turned(pose: Pose2) -> Pose2:
        return Pose2(cos * pose.x_m - sin * pose.y_m, sin * pose.x_m + cos * pose.y_m, pose.yaw_rad + angle)

    def segment(one: Segment) -> Segment:
        first, last = one.phase.base
        return replace(one, phase=replace(one.phase, base=(turned(first), turned(last))))

    path = plan.trajectory
    return replace(plan, trajectory=replace(path, segments=tuple(segment(one) for one in path.segments)))


@cache
def steps() -> tuple[SmoothStep, ...]:
    """Return the steps, made when a test first asks: each worker of the tests collects this file."""
    return tuple(smooth_steps(PLAN, LIMITS))


@pytest.fixture
def step(request: pytest.FixtureRequest) -> SmoothStep:
    return steps()[request.param]


each_step = pytest.mark.parametrize("step", range(len(PLAN.steps)), ids=lambda number: f"step {number}", indirect=True)


@each_step
def test_speeds_and_accelerations_stay_within_their_limits(step: SmoothStep):
    times = step.times_s(1000.0)
    values, gap = step.at(times), times[1]
    speeds = np.abs(np.diff(values, axis=0) / gap)
    accelerations = np.abs(np.diff(values, 2, axis=0) / gap**2)
    assert np.all(speeds <= LIMITS.speeds * (1.0 + BETWEEN))
    assert np.all(accelerations <= LIMITS.accelerations * (1.0 + BETWEEN))
    assert accelerations.max() > 0.0


def test_a_base_that_drives_askew_keeps_the_limits_of_its_whole_way_and_nearly_uses_them():
    turned = replace(LIMITS, speeds=1000.0 * LIMITS.speeds, accelerations=1000.0 * LIMITS.accelerations)
    fast, hard = turned.speeds.copy(), turned.accelerations.copy()
    fast[-3:-1], hard[-3:-1] = 0.05, 0.02
    for angle in (0.0, 0.2, 0.7):
        step = next(smooth_steps(askew(PLAN, angle), replace(turned, speeds=fast, accelerations=hard)))
        times = step.times_s(500.0)
        way, gap = step.at(times)[:, -3:-1], times[1]
        speed = np.linalg.norm(np.diff(way, axis=0), axis=1) / gap
        acceleration = np.linalg.norm(np.diff(way, 2, axis=0), axis=1) / gap**2
        assert 0.9 * 0.02 < acceleration.max() <= 0.02 * (1.0 + BETWEEN)
        assert speed.max() <= 0.05 * (1.0 + BETWEEN)


@each_step
def test_what_is_told_as_velocity_and_acceleration_are_the_derivatives(step: SmoothStep):
    times = np.linspace(0.1, step.duration_s - 0.1, 50)
    for order in (1, 2):
        slope = (step.at(times + 1e-5, order - 1) - step.at(times - 1e-5, order - 1)) / 2e-5
        off = np.abs(slope - step.at(times, order)).max(axis=1)
        assert np.median(off) < 1e-5
        assert (off < 0.05).sum() >= len(times) - 2  # accelerations jump, sometimes right between two of these moments


@each_step
def test_a_step_begins_and_ends_at_rest_where_the_plan_does(step: SmoothStep):
    ends = np.array([0.0, step.duration_s])
    assert np.abs(step.at(ends, 1)).max() < 1e-9
    planned = PLAN.steps[step.number]
    np.testing.assert_allclose(step.plan_s(ends), [planned.start_s, planned.end_s], atol=1e-9)


@each_step
def test_every_keyframe_of_the_arms_is_passed_exactly(step: SmoothStep):
    assert PATH is not None
    planned = PLAN.steps[step.number]
    keyframes = [t for t in PATH.arms.times_s if planned.start_s < t < planned.end_s]
    for keyframe in keyframes[:: max(len(keyframes) // 20, 1)]:
        found = brentq(lambda t, k=keyframe: step.plan_s(np.array([t]))[0] - k, 0.0, step.duration_s, xtol=1e-12)
        np.testing.assert_allclose(step.at(np.array([found]))[0, JOINTS], PATH.arms.at(keyframe), atol=1e-6)


@each_step
def test_between_keyframes_it_is_as_near_to_the_plan_as_it_says(step: SmoothStep):
    assert PATH is not None
    times = step.times_s(200.0)
    planned = np.array([PATH.arms.at(t) for t in step.plan_s(times).tolist()])
    off = np.abs(step.at(times)[:, JOINTS] - planned).max()
    assert off <= 1.1 * step.deviation < 0.03


def test_steps_follow_each_other_and_take_no_less_than_planned():
    assert steps()[1].start_s == pytest.approx(steps()[0].duration_s)
    for step, planned in zip(steps(), PLAN.steps, strict=True):
        assert step.duration_s >= planned.duration_s - 1e-9


@each_step
def test_where_it_turns_it_loses_time_that_it_makes_up_elsewhere_with_no_more_hurry_than_that_takes(step: SmoothStep):
    planned = PLAN.steps[step.number]
    paces = np.diff(step.plan_s(step.times_s(100.0))) * 100.0
    assert paces.min() < 0.5
    assert 1.0 < paces.max() < PACE_MAX - 0.1
    assert step.duration_s <= 1.02 * planned.duration_s


def test_where_speeds_leave_no_time_to_make_up_it_takes_longer_at_the_quickest_pace():
    slow = replace(LIMITS, accelerations=LIMITS.accelerations / 20.0)
    (step,) = islice(smooth_steps(PLAN, slow), 1)
    assert step.duration_s > 1.2 * PLAN.steps[0].duration_s
    times = step.times_s(1000.0)
    assert np.all(np.abs(np.diff(step.at(times), 2, axis=0) / times[1] ** 2) <= slow.accelerations * (1.0 + BETWEEN))


def test_a_robot_with_one_arm_has_a_motion_too():
    plan, card = one_armed()
    limits = MotionLimits.of(card, plan.scene)
    assert limits.names == (*card.arms[0].joint_names, card.arms[0].gripper.joint_name, *LIMITS.names[-3:])
    first = next(smooth_steps(plan, limits))
    assert first.at(np.zeros(1)).shape == (1, len(limits.names))


def test_where_a_card_gives_no_acceleration_it_follows_from_the_speed():
    arm = CARD.arms[0]
    np.testing.assert_allclose(LIMITS.accelerations[: len(arm.joint_names)] * RISE_S, arm.speeds_rad_s)


def test_without_a_plan_there_is_no_motion():
    with pytest.raises(UnsolvedPlanError):
        next(smooth_steps(unsolved(), LIMITS))
