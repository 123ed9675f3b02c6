"""Trajectories: joints clear of everything and without a gap, also between transfers, while the base drives."""

from itertools import pairwise

import numpy as np
import pytest

from planner import Plan, Scene, make_plan
from planner.geometry.pose import FloatArray, Pose2
from planner.motion.joint_trajectory import CLOSED_M, OPEN_M, JointTrajectory, Keyframes
from planner.motion.opened_collisions import OpenedCollisions
from planner.motion.timeline import Timeline
from planner.robots.card import EDGE_OPEN_M, HELD_M
from planner.robots.load_robot import load_robot
from planner.task.trajectory import Segment, Trajectory
from tests.builders import fold, garment, rectangle_points
from tests.replay.planned import shipped_plan
from tests.required import required

RATE_HZ = 25.0
ROBOT = load_robot("pr2")
HOME = np.concatenate([ROBOT.home(0), ROBOT.home(1)])
NAMES = ("hand-towel", "t-shirt", "jeans")

each_name = pytest.mark.parametrize("name", NAMES)


def trajectory_of(name: str) -> Trajectory:
    found = shipped_plan(name).trajectory
    assert found is not None
    return found


def joints_at(trajectory: Trajectory, t_s: float) -> FloatArray:
    """Return all arms' joints at a time, shape (joints,)."""
    return trajectory.arms.at(t_s)


def is_holding(segment: Segment, arm: int) -> bool:
    hand = segment.phase.hands[arm]
    return hand is not None and not hand.is_reaching


@pytest.mark.parametrize("name", NAMES[1:])
def test_between_some_runs_the_base_drives(name: str) -> None:
    # Else the tests that follow say little.
    phases = [segment.phase for segment in trajectory_of(name).segments]
    assert any(phase.motion is None and phase.base[0] != phase.base[1] for phase in phases)


@each_name
def test_the_arms_touch_nothing_all_through(name: str) -> None:
    expect_free(shipped_plan(name), 1.0 / RATE_HZ)


def test_fingers_touch_nothing_between_waypoints_either() -> None:
    # The hem's slant lets the left hand turn as it lifts; its fingertips begin .1 mm above the table.
    outline = ((-0.005, 0.0), (0.298, 0.006), (0.319, 0.133), (0.348, 0.008), (0.647, -0.004), (0.583, 0.402))
    folds = (
        fold((0.212, 0.004), (0.212, 0.407)),
        fold((0.43, 0.005), (0.43, 0.404)),
        fold((0.647, 0.202), (0.43, 0.202)),
        fold((0.538, 0.202), (0.538, 0.408)),
    )
    cloth = garment((*outline, (0.064, 0.408)), *folds, placement=Pose2(-0.745, -0.202, 0.0))
    expect_free(make_plan(cloth), 0.005)


def expect_free(plan: Plan, every_s: float) -> None:
    """Expect that at times so far apart nothing touches."""
    trajectory, cost_s = required(plan.trajectory), required(plan.cost_s)
    collisions = OpenedCollisions(ROBOT, plan.scene.table, plan.scene.torso_m)
    for t in np.arange(0.0, cost_s, every_s):
        base = trajectory.segment_at(t).base_at(t)
        opened = np.array([[track.opening_at(t) for track in trajectory.grippers]])
        stands, joints = np.array([[base.x_m, base.y_m, base.yaw_rad]]), joints_at(trajectory, t)[None]
        assert collisions.is_path_free(stands, joints, opened), f"at {t:.3f} s"


@each_name
def test_segments_follow_one_another_without_a_gap_and_last_as_long_as_the_plan(name: str) -> None:
    plan, trajectory = shipped_plan(name), trajectory_of(name)
    assert trajectory.duration_s == plan.cost_s
    assert trajectory.segments[0].start_s == 0.0
    for segment, after in pairwise(trajectory.segments):
        assert after.start_s == pytest.approx(segment.start_s + segment.duration_s)
        assert after.step >= segment.step
        one, other = segment.base_at(after.start_s), after.base_at(after.start_s)
        assert (one.x_m, one.y_m) == pytest.approx((other.x_m, other.y_m), abs=1e-6)
        one, other = segment.placement_at(after.start_s), after.placement_at(after.start_s)
        assert (one.x_m, one.y_m, one.yaw_rad) == pytest.approx((other.x_m, other.y_m, other.yaw_rad), abs=1e-6)
    last = trajectory.segments[-1]
    assert last.start_s + last.duration_s == pytest.approx(plan.cost_s)
    assert trajectory.arms.times_s[-1] <= plan.cost_s + 1e-9


@each_name
def test_a_steps_segments_lead_from_the_world_before_it_to_the_world_after_it(name: str) -> None:
    plan, trajectory = shipped_plan(name), trajectory_of(name)
    for number, step in enumerate(plan.steps):
        last = trajectory.of_step(number)[-1]
        base, cloth = last.phase.base[1], last.phase.cloth
        for there, wanted in ((base, step.after.base.pose), (cloth.end, step.after.placement)):
            assert (there.x_m, there.y_m) == pytest.approx((wanted.x_m, wanted.y_m), abs=1e-6)
        folded = 1 << cloth.fold if cloth.fold is not None and cloth.sweep[1] == 2.0 else 0
        assert cloth.done | folded == step.after.done
        assert last.start_s + last.duration_s <= step.end_s + 1e-6


@each_name
def test_no_joint_is_faster_from_keyframe_to_keyframe_than_it_can_be(name: str) -> None:
    arms = trajectory_of(name).arms
    limits = np.array([arm.speeds_rad_s for arm in ROBOT.card.arms]).ravel()
    speeds = np.abs(np.diff(arms.positions, axis=0)) / np.diff(arms.times_s)[:, None]
    assert (speeds / limits).max() <= 1.0 + 1e-6


@each_name
def test_grippers_are_shut_while_they_hold_cloth_and_open_at_the_start_and_the_end(name: str) -> None:
    plan, trajectory = shipped_plan(name), trajectory_of(name)
    assert [track.arm for track in trajectory.grippers] == [arm.name for arm in ROBOT.card.arms]
    for track in trajectory.grippers:
        assert track.opening_at(0.0) == pytest.approx(OPEN_M)
        at_end_m = track.opening_at(required(plan.cost_s))
        assert any(at_end_m == pytest.approx(opening_m) for opening_m in (OPEN_M, EDGE_OPEN_M))
    held = 0
    segments = trajectory.segments
    for segment, after in zip(segments, (*segments[1:], None), strict=True):
        for arm, track in enumerate(trajectory.grippers):
            if is_holding(segment, arm):
                held += 1
                is_last = after is None or not is_holding(after, arm)
                lasts = segment.duration_s - plan.scene.grip_dwell_s if is_last else segment.duration_s
                for t in np.linspace(segment.start_s, segment.start_s + lasts, 5):
                    assert track.opening_at(t) in (pytest.approx(CLOSED_M), pytest.approx(HELD_M))
    assert held >= len(plan.garment.folds)


@each_name
def test_arms_begin_at_home(name: str) -> None:
    assert joints_at(trajectory_of(name), 0.0) == pytest.approx(HOME)


@each_name
def test_every_actuated_joint_is_told_at_every_moment_and_its_velocity(name: str) -> None:
    plan, trajectory = shipped_plan(name), trajectory_of(name)
    assert trajectory.torso_m == plan.scene.torso_m
    frames = list(Timeline.of(plan).samples(10.0))
    assert {frozenset(frame.joints) for frame in frames} == {frozenset(frame.velocities) for frame in frames}
    assert len({frozenset(frame.joints) for frame in frames}) == 1
    card, lift = ROBOT.card, required(ROBOT.card.lift_joint)
    named = {name for arm in card.arms for name in (*arm.joint_names, arm.gripper.joint_name)}
    assert {*named, lift, *dict(card.resting)} == set(frames[0].joints)
    assert all(frame.velocities[name] == 0.0 for frame in frames for name in (lift, *dict(card.resting)))


@each_name
def test_velocities_are_those_with_which_the_joints_go_on(name: str) -> None:
    # A cubic is at its middle as fast as from end to end, but for a twenty-fourth of its third derivative.
    plan, trajectory = shipped_plan(name), trajectory_of(name)
    knots = np.unique([*trajectory.arms.times_s, *(t for track in trajectory.grippers for t in track.times_s)])
    step_s = 1e-3
    for t in knots[:-1][np.diff(knots) > 2 * step_s]:
        here, there = (trajectory.joints_at(float(t) + approach) for approach in (0.25 * step_s, 1.25 * step_s))
        going = trajectory.velocities_at(float(t) + 0.75 * step_s)
        for joint, velocity in going.items():
            assert there[joint] - here[joint] == pytest.approx(velocity * step_s, abs=2e-7)
    assert set(trajectory.velocities_at(required(plan.cost_s) + 1.0).values()) == {0.0}


def test_a_track_is_a_cubic_between_keyframes_and_rests_at_its_ends() -> None:
    track = JointTrajectory.at_rest(HOME, arms=2)
    still = np.zeros((2, len(HOME)))
    track.add(Keyframes(np.array([1.0, 2.0]), np.array([HOME + 0.4, HOME]), still))
    # From rest to rest a cubic has done 3 u^2 - 2 u^3 of its way.
    found = track.joints_at(np.array([0.25, 1.5, -1.0, 9.0]))
    assert found == pytest.approx(np.array([HOME + 0.4 * 0.15625, HOME + 0.2, HOME, HOME]))
    assert JointTrajectory.at_rest(HOME, arms=2).joints_at(np.array([0.5])) == pytest.approx(HOME[None])


def test_keyframes_that_come_too_late_are_left_out() -> None:
    track = JointTrajectory.at_rest(HOME, arms=2)
    late = Keyframes(np.array([1.0, 1.0, 0.5]), np.array([HOME + 0.4, HOME + 0.8, HOME]), np.zeros((3, len(HOME))))
    track.add(late)
    assert track.times_s == [0.0, 1.0]
    assert track.joints_at(np.array([1.0])) == pytest.approx(HOME[None] + 0.4)


def test_fingers_close_and_open_evenly_and_when_they_are_told() -> None:
    track = JointTrajectory.at_rest(HOME, arms=2)
    track.close(1, 1.5, 2.0)
    track.open(1, 3.0, 3.5)
    assert track.openings(1) == ([0.0, 1.5, 2.0, 3.0, 3.5], [OPEN_M, OPEN_M, CLOSED_M, CLOSED_M, OPEN_M])
    assert track.openings(0) == ([0.0], [OPEN_M])


def test_fingers_are_led_along_their_links_while_they_close_and_open() -> None:
    # The joint, which swings, is at each keyframe where the opening has it.
    plan = shipped_plan("hand-towel")
    assert plan.trajectory is not None
    for arm, track in zip(ROBOT.card.arms, plan.trajectory.grippers, strict=True):
        assert (min(track.openings_m), max(track.openings_m)) == pytest.approx((HELD_M, OPEN_M))
        assert list(track.positions) == [arm.gripper.angle(opening) for opening in track.openings_m]
        for t in np.arange(0.0, plan.cost_s, 0.02):
            assert track.position_at(t) == pytest.approx(arm.gripper.angle(track.opening_at(t)), abs=0.002)


def test_cloth_that_lies_still_is_one_surface_and_what_is_folded_another() -> None:
    plan = shipped_plan("hand-towel")
    timeline = Timeline.of(plan)
    moving = [primitive.start_s + 0.5 * primitive.duration_s for primitive in plan.primitives]
    still = timeline.at(0.0).cloth
    assert timeline.at(0.1).cloth is still
    surfaces = [timeline.at(t_s).cloth for t_s in moving]
    assert len({id(surface) for surface in [still, *surfaces]}) == len(moving) + 1


@pytest.mark.long
def test_hands_that_rest_through_a_phase_for_which_there_is_no_time_take_none() -> None:
    # The grips lie nearer to the fold line than the far corner does, so they rest while the cloth begins to rise; and
    # between two stands of the base that takes no time in a way that is tried, slower as a whole than 1 ms.
    towel = garment(
        rectangle_points(0.2, 0.4),
        fold((0.0, 0.39604646049498443), (0.2, 0.3877103804729817)),
        placement=Pose2(0.162323971451364, -0.025457994644062065, np.pi / 2),
    )
    plan = make_plan(towel, Scene(approach_cone_rad=0.0, arm_motion_s=0.001, base_speed_m_s=1000.0), time_limit_s=60.0)
    assert plan.is_solved
    last = required(plan.trajectory).segments[-1]
    assert last.start_s + last.duration_s == pytest.approx(plan.cost_s)
    assert [frame.t_s for frame in Timeline.of(plan).samples(50.0)][-1] == plan.cost_s
