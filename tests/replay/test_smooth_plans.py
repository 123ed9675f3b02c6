"""Every shipped plan is a motion that could be sent to the robot as it is."""

from dataclasses import replace

import numpy as np
import pytest

from planner import Plan
from planner.motion.motion_values import MotionLimits, accelerations_at, positions_at, velocities_at
from planner.task.trajectory import ArmTrack, GripperTrack
from tests.replay.planned import each_solvable, shipped_plan
from tests.replay.smooth import require_smooth
from tests.small_plan import CARD, small_plan


@each_solvable
def test_speeds_and_accelerations_keep_their_limits_and_all_rests_between_the_steps(name: str) -> None:
    require_smooth(shipped_plan(name), CARD)


@each_solvable
def test_steps_last_as_long_as_their_motions(name: str) -> None:
    plan = shipped_plan(name)
    assert plan.trajectory is not None
    for number, step in enumerate(plan.steps):
        segments = plan.trajectory.of_step(number)
        assert segments[0].start_s == pytest.approx(step.start_s, abs=1e-9)
        assert segments[-1].start_s + segments[-1].duration_s == pytest.approx(step.end_s, abs=1e-9)


@each_solvable
def test_a_plan_takes_little_longer_than_the_model_says_and_never_less(name: str) -> None:
    plan = shipped_plan(name)
    assert plan.cost_s is not None and plan.bound_s is not None
    assert plan.bound_s - 1e-9 <= plan.cost_s <= 1.04 * plan.bound_s


def jerked(plan: Plan, arms: ArmTrack) -> Plan:
    assert plan.trajectory is not None
    return replace(plan, trajectory=replace(plan.trajectory, arms=arms))


def test_a_motion_that_goes_straight_from_keyframe_to_keyframe_is_none_for_a_robot() -> None:
    plan = small_plan()
    assert plan.trajectory is not None
    arms = plan.trajectory.arms
    halved = replace(arms, velocities=tuple(tuple(0.5 * v for v in row) for row in arms.velocities))
    with pytest.raises(AssertionError):
        require_smooth(jerked(plan, halved), CARD)


def test_a_base_whose_velocity_jumps_is_found() -> None:
    plan = small_plan()
    assert plan.trajectory is not None
    segments = list(plan.trajectory.segments)
    number = next(n for n, one in enumerate(segments) if one.phase.base[0] != one.phase.base[1])
    rates = (0.05, *segments[number].base_rates[1:])
    segments[number] = replace(segments[number], base_rates=rates)
    with pytest.raises(AssertionError, match="base"):
        require_smooth(replace(plan, trajectory=replace(plan.trajectory, segments=tuple(segments))), CARD)


def test_fingers_that_are_too_quick_are_found() -> None:
    plan = small_plan()
    assert plan.trajectory is not None

    def hurried(track: GripperTrack) -> GripperTrack:
        return replace(track, times_s=tuple(0.5 * t for t in track.times_s))

    grippers = tuple(hurried(track) for track in plan.trajectory.grippers)
    with pytest.raises(AssertionError, match="fingers"):
        require_smooth(replace(plan, trajectory=replace(plan.trajectory, grippers=grippers)), CARD)


def test_told_velocities_and_accelerations_are_the_derivatives() -> None:
    plan = small_plan()
    path = plan.trajectory
    assert path is not None and plan.cost_s is not None
    limits = MotionLimits.of(CARD, plan.scene)
    times = np.linspace(0.05, plan.cost_s - 0.05, 701)
    for lower, upper in (
        (positions_at, velocities_at(path, times)),
        (velocities_at, accelerations_at(path, times, plan.cost_s)),
    ):
        slope = (lower(path, times + 1e-6) - lower(path, times - 1e-6)) / 2e-6
        off = (np.abs(slope - upper) / limits.accelerations).max(axis=1)
        assert np.median(off) < 1e-5
        assert (off < 0.01).sum() >= 0.98 * len(times)  # accelerations jump, sometimes right at one of these times
