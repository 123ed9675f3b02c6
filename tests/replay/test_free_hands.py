"""Free hands in every trajectory: never in the table, never low over cloth, fingers open in time."""

from functools import cache

import numpy as np
import pytest
from hypothesis import settings

from planner.geometry.table import Table
from planner.motion.timeline import Timeline
from tests.laws.law import LONG
from tests.replay.free_hands import Look, in_table, looks, too_low
from tests.replay.hands import CLOSED_M
from tests.replay.joints import speed_limits
from tests.replay.planned import SOLVABLE, each_solvable, shipped_plan
from tests.required import required
from tests.sweep import sweep

IS_LONG = settings.get_current_profile_name() == LONG
RATE_HZ = 50.0 if IS_LONG else 4.0
FINGERS = {"left": "l_gripper_l_finger_joint", "right": "r_gripper_l_finger_joint"}

each_looked_at = sweep("name", SOLVABLE, ("vest", "hand-towel"))
"""Give a test the name of each plan; comparing hulls with the cloth takes 3 ms a sample."""


@cache
def looks_at(name: str) -> list[Look]:
    return looks(shipped_plan(name), RATE_HZ)


@each_looked_at
def test_no_part_of_a_free_hand_is_in_the_table(name: str) -> None:
    for look in looks_at(name):
        found = list(in_table(look, Table()))
        assert not found, f"at {look.frame.t_s:.2f} s: {found}"


@each_looked_at
def test_no_part_of_a_free_arm_is_low_over_cloth_but_near_its_grip(name: str) -> None:
    for look in looks_at(name):
        found = list(too_low(look, Table()))
        assert not found, f"at {look.frame.t_s:.2f} s: {found}"


@each_solvable
def test_no_finger_opens_before_the_cloth_lies(name: str) -> None:
    plan = shipped_plan(name)
    timeline, opened = Timeline.of(plan), 0
    for primitive in plan.primitives:
        end = primitive.start_s + primitive.duration_s
        lies = timeline.at(end - 1e-6).cloth.vertices
        times = np.arange(primitive.start_s, end, 0.02)
        openings = np.array([[track.opening_at(float(t)) for track in timeline.trajectory.grippers] for t in times])
        for arm in range(openings.shape[1]):
            is_opening = (openings[1:, arm] > openings[:-1, arm] + 1e-6) & (openings[1:, arm] > CLOSED_M)
            for t in times[1:][is_opening]:
                opened += 1
                np.testing.assert_allclose(timeline.at(float(t)).cloth.vertices, lies, atol=1e-9)
    assert opened > 0


@each_solvable
def test_fingers_are_no_faster_than_the_urdf_allows(name: str) -> None:
    path = required(shipped_plan(name).trajectory)
    times = np.arange(0.0, path.duration_s, 0.02)
    joints = [path.joints_at(float(t)) for t in times]
    for joint, limit in zip(FINGERS.values(), speed_limits([*FINGERS.values()]), strict=True):
        angles = np.array([at[joint] for at in joints])
        assert np.ptp(angles) > 0.1 or joint.startswith("l_"), f"{joint} never moves"
        assert np.abs(np.diff(angles) / np.diff(times)).max() <= limit + 1e-6


@pytest.mark.parametrize("rate_hz", [1.0, *(pytest.param(rate, marks=pytest.mark.long) for rate in (10.0, 30.0, 50.0))])
@each_solvable
def test_sample_times_strictly_grow_by_whole_steps_to_exactly_the_end(name: str, rate_hz: float) -> None:
    plan = shipped_plan(name)
    times = np.array([sample.t_s for sample in Timeline.of(plan).samples(rate_hz)])
    assert times[-1] == plan.cost_s
    steps = np.diff(times)
    assert steps[:-1] == pytest.approx(np.full(len(steps) - 1, 1.0 / rate_hz), abs=1e-9)
    assert 1e-6 < steps[-1] <= 1.0 / rate_hz + 1e-9
