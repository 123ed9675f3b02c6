"""The times within a transfer: rests in which fingers open are part of arm motions, and limits are kept."""

import numpy as np
import pytest

from planner.geometry.pose import Approach, Point3, Pose2
from planner.geometry.table import Table, TableTop
from planner.motion.transfer_timing import TransferLimits, TransferTiming
from planner.motion.waypoints import waypoints_of
from planner.primitives.drive_time import DriveTime
from planner.task.trajectory import ClothMotion, Hand, Phase

HERE, BASE = Pose2(0.0, 0.0, 0.0), Pose2(-0.95, 0.0, 0.0)
STILL = ClothMotion(0, HERE, HERE, TableTop.of(Table()))
START, MIDDLE, END, FAR = (-0.4, 0.2, 0.02), (-0.4, 0.2, 0.05), (-0.4, 0.2, 0.08), (-0.4, 0.2, 0.62)
REST_S = 0.5
DRIVING = DriveTime(0.25, 0.5)


def phase(start: Point3, end: Point3, duration_s: float = 3.0, motion: int | None = 0) -> Phase:
    hand = Hand(Approach(0.0, 0.5), (start, end), is_closed=True)
    return Phase(duration_s, (BASE, BASE), (hand, None), STILL, motion)


def drag(distance_m: float) -> Phase:
    """Return a phase in which the base drags cloth straight back."""
    after = BASE.ahead(-distance_m)
    transfer_path = ClothMotion(0, HERE, Pose2(-distance_m, 0.0, 0.0), TableTop.of(Table()))
    hand = Hand(Approach(0.0, 0.5), (START, (START[0] - distance_m, *START[1:])), is_closed=True)
    return Phase(DRIVING.driving_s(distance_m), (BASE, after), (hand, None), transfer_path)


def timed(
    *carrying: tuple[int, Phase], turn: float = 0.0, speed: float = 1.0, acceleration: float = 100.0
) -> TransferTiming:
    """Return the timing where one joint turns by `turn` from moment to moment, with its limits."""
    waypoints = waypoints_of([each for _, each in carrying], 0.79)
    joints = turn * np.arange(len(waypoints), dtype=np.float64)[:, None]
    hard = (DRIVING.acceleration_m_s2, DRIVING.acceleration_m_s2, DRIVING.turn_acceleration_rad_s2)
    fast = (DRIVING.speed_m_s, DRIVING.speed_m_s, DRIVING.turn_rad_s)
    limits = TransferLimits(np.array([speed, *fast]), np.array([acceleration, *hard]), REST_S)
    return TransferTiming.of(carrying, waypoints, joints, limits)


def test_the_last_motion_makes_room_for_the_rest_at_its_end() -> None:
    timing = timed((0, phase(START, MIDDLE)), (0, phase(MIDDLE, END, motion=1)), turn=0.1)
    assert sum(one.duration_s for one in timing.timed_phases) == pytest.approx(6.0)
    # The cloth is where it is to be half a second before the end, and lies still from then on.
    last_motion = timing.timed_phases[1]
    rests = last_motion.duration_s - REST_S
    assert np.interp(rests, last_motion.times_s, last_motion.fractions) == pytest.approx(1.0)
    last = int(timing.waypoints[-1])
    assert timing.first_s(last) == pytest.approx(5.5) and timing.times_s[-1] == pytest.approx(6.0)
    assert timing.borrowed_s == 0.0


def test_a_motion_that_needs_all_its_time_ends_later_by_the_rest() -> None:
    timing = timed((0, phase(START, FAR)), turn=0.1, acceleration=1e6)
    # 60 steps of a centimetre, a tenth of a second each, and a moment to speed up and to slow down.
    assert timing.times_s[-1] == pytest.approx(6.0 + REST_S, rel=0.05)
    assert timing.times_s[-1] > 6.0 + REST_S


def test_a_joint_that_takes_long_to_speed_up_and_slow_down_makes_a_motion_longer_by_that() -> None:
    timing = timed((0, phase(START, FAR)), turn=0.1, acceleration=1.0)
    # From rest to rest over 6 rad: 1 s to speed up, 5 s at 1 rad/s, 1 s to slow down.
    assert timing.times_s[-1] == pytest.approx(7.0 + REST_S, abs=0.05)
    assert np.abs(timing.velocities).max() <= 1.0 + 1e-6


@pytest.mark.parametrize("distance_m", [0.1, 0.2, 0.3, 0.7, 1.6])
def test_a_drag_takes_as_long_as_the_base_needs_from_rest_to_rest(distance_m: float) -> None:
    timing = timed((0, drag(distance_m)))
    wanted_s = DRIVING.driving_s(distance_m)
    assert timing.times_s[-1] == pytest.approx(wanted_s + REST_S, abs=1e-9)
    assert timing.borrowed_s == REST_S
    (one,) = timing.timed_phases
    assert one.base_rates * distance_m == pytest.approx(one.rates * distance_m)
    assert one.base_rates.max() * distance_m <= DRIVING.speed_m_s + 1e-9
    assert one.base_rates[[0, -1]].tolist() == [0.0, 0.0]


def test_all_rests_between_two_steps() -> None:
    timing = timed((0, drag(0.1)), (1, phase(START, MIDDLE)), turn=0.1)
    drag_s = DRIVING.driving_s(0.1)
    at_border = np.flatnonzero(np.isclose(timing.times_s, timing.timed_phases[0].duration_s))
    assert len(at_border) and not timing.velocities[at_border].any()
    assert timing.timed_phases[0].duration_s >= drag_s - 1e-9
    assert timing.timed_phases[0].base_rates[-1] == 0.0


def test_hands_that_hold_on_rest_only_at_the_end_of_the_run() -> None:
    timing = timed((0, phase(START, MIDDLE, 0.4, None)), (1, phase(MIDDLE, END)))
    assert [one.duration_s for one in timing.timed_phases] == pytest.approx([0.4, 3.0])
    assert timing.borrowed_s == 0.0


def test_a_phase_through_which_hands_rest_takes_no_time_where_there_is_none() -> None:
    # The first phase moves nothing; the second needs a tenth of a second for each of 60 steps; there is 1 ms for both.
    carrying = ((0, phase(START, START, 0.0005)), (0, phase(START, FAR, 0.0005)))
    waypoints = waypoints_of([each for _, each in carrying], 0.79)
    joints = 0.1 * np.maximum(np.arange(len(waypoints)) - (len(waypoints) - 61), 0.0)[:, None]
    limits = TransferLimits(np.ones(4), np.array([1e6, 1.0, 1.0, 1.0]), REST_S)
    timing = TransferTiming.of(carrying, waypoints, joints, limits)
    assert [one.duration_s for one in timing.timed_phases] == pytest.approx([0.0, 6.0 + REST_S], rel=0.05)
