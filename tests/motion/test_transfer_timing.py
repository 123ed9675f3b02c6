"""The times within a transfer: rests in which fingers open are part of arm motions."""

import numpy as np
import pytest

from planner.geometry.pose import Approach, Pose2
from planner.geometry.table import Table
from planner.geometry.table_top import TableTop
from planner.motion.moments import moments_of
from planner.motion.transfer_timing import TransferTiming
from planner.task.phase import ClothMotion, Hand, Phase

HERE, BASE = Pose2(0.0, 0.0, 0.0), Pose2(-0.95, 0.0, 0.0)
STILL = ClothMotion(0, HERE, HERE, TableTop.of(Table()))
START, MIDDLE, END = (-0.4, 0.2, 0.02), (-0.4, 0.2, 0.05), (-0.4, 0.2, 0.08)
REST_S = 0.5


def phase(start, end, duration_s: float = 3.0, motion: int | None = 0) -> Phase:
    hand = Hand(Approach(0.0, 0.5), (start, end), is_closed=True)
    return Phase(duration_s, (BASE, BASE), (hand, None), STILL, motion)


def timed(*carrying: tuple[int, Phase], least_s: float = 0.0) -> TransferTiming:
    moments = moments_of([each for _, each in carrying], 0.79)
    return TransferTiming.of(carrying, moments, np.full(len(moments) - 1, least_s), REST_S)


def test_the_last_motion_makes_room_for_the_rest_at_its_end():
    timing = timed((0, phase(START, MIDDLE)), (0, phase(MIDDLE, END, motion=1)))
    assert [one.duration_s for one in timing.timed_phases] == pytest.approx([3.0, 3.0])
    # The cloth is where it is to be half a second before the end, and lies still from then on.
    last_motion = timing.timed_phases[1]
    assert np.interp([2.5, 1.25], last_motion.times_s, last_motion.fractions) == pytest.approx([1.0, 0.5])
    last = int(timing.moments[-1])
    assert timing.first_s(last) == pytest.approx(5.5) and timing.times_s[-1] == pytest.approx(6.0)
    assert timing.borrowed_s == 0.0


def test_a_motion_that_needs_all_its_time_ends_later_by_the_rest():
    timing = timed((0, phase(START, MIDDLE)), least_s=1.0)
    # Three steps of a centimetre, a second each.
    assert timing.times_s[-1] == pytest.approx(3.0 + REST_S)


def test_a_drag_has_no_arm_motion_but_its_reach_to_rest_in():
    timing = timed((0, phase(START, MIDDLE, duration_s=0.4, motion=None)))
    assert timing.times_s[-1] == pytest.approx(0.4 + REST_S)
    assert timing.borrowed_s == REST_S


def test_hands_that_hold_on_rest_only_at_the_end_of_the_run():
    timing = timed((0, phase(START, MIDDLE, 0.4, None)), (1, phase(MIDDLE, END)))
    assert [one.duration_s for one in timing.timed_phases] == pytest.approx([0.4, 3.0])
    assert timing.borrowed_s == 0.0


def test_a_phase_through_which_hands_rest_takes_no_time_where_there_is_none():
    # The first phase moves nothing; the second needs a second for each of three steps, and there is 1 ms for both.
    carrying = ((0, phase(START, START, 0.0005)), (0, phase(START, MIDDLE, 0.0005)))
    moments = moments_of([each for _, each in carrying], 0.79)
    least = np.where(np.arange(1, len(moments)) < len(moments) - 3, 0.0, 1.0)
    timing = TransferTiming.of(carrying, moments, least, REST_S)
    assert [one.duration_s for one in timing.timed_phases] == pytest.approx([0.0, 3.0 + REST_S])
