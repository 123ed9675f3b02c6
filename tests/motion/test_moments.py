"""Moments of hand-built phases: their number, the tools' poses, and how tools turn in their grips."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from planner.geometry.pose import Approach, FloatArray, Point3, Pose2
from planner.geometry.table import Table, TableTop
from planner.motion.phase_stretches import STEP_M, STEP_RAD
from planner.motion.transfer import is_carrying
from planner.motion.waypoints import Waypoints, forget_waypoints, waypoints_of
from planner.task.trajectory import ClothMotion, Hand, Phase
from tests.replay.planned import planned

HEIGHT_M = 0.79
STAND = Pose2(-0.95, 0.0, 0.0)
HERE = (-0.35, 0.2, 0.02)
SLANTED, STEEP, DOWN = Approach(0.3, math.radians(30.0)), Approach(-0.9, math.radians(60.0)), Approach(0.0, math.pi / 2)
CLOTH = ClothMotion(0, Pose2(0.0, 0.0, 0.0), Pose2(0.0, 0.0, 0.0), TableTop.of(Table()))


def holding(*points: Point3, approach: Approach = SLANTED, rolls_rad: tuple[float, ...] = ()) -> Hand:
    return Hand(approach, points, is_closed=True, rolls_rad=rolls_rad)


def phase(*hands: Hand | None, duration_s: float = 3.0, end: Pose2 = STAND) -> Phase:
    """Return a phase in which the base goes from `STAND` to `end`, with hands for the given arms, from the left."""
    both = (*hands, *(None,) * (2 - len(hands)))
    return Phase(duration_s, (STAND, end), both, CLOTH, motion=0 if end == STAND else None)


def turns(waypoints: Waypoints, arm: int) -> FloatArray:
    """Return the angle by which a tool turns from each moment to the next (rad)."""
    rotations = waypoints.rotations[arm]
    return np.asarray(Rotation.from_matrix(rotations[:-1].swapaxes(1, 2) @ rotations[1:]).magnitude())


def lean(rotation: FloatArray) -> float:
    """Return the upward component of the line from finger to finger."""
    return abs(float(rotation[2, 1]))


def test_a_way_is_cut_into_steps_of_a_centimetre_that_meet_its_corner() -> None:
    # Two pieces, of 31 and 5 mm, passed in the same time: 4 steps of 7.75 mm for the longer, one for the other.
    corner, goal = (-0.35, 0.2, 0.051), (-0.35, 0.2, 0.056)
    waypoints = waypoints_of([phase(holding(HERE, corner, goal))], HEIGHT_M)
    assert len(waypoints) == 6
    assert waypoints.fractions == pytest.approx([0.0, 0.125, 0.25, 0.375, 0.5, 1.0])
    assert waypoints.nominal_s == pytest.approx([0.0, 0.375, 0.375, 0.375, 0.375, 1.5])
    # The base stands at x = -0.95, looking along x: the hand is 0.6 m ahead, 0.2 m to the left; z is over the floor.
    assert waypoints.positions[0, 0] == pytest.approx((0.6, 0.2, HEIGHT_M + 0.02))
    assert waypoints.positions[0, 4] == pytest.approx((0.6, 0.2, HEIGHT_M + 0.051))
    assert waypoints.positions[0, 5] == pytest.approx((0.6, 0.2, HEIGHT_M + 0.056))


def test_only_where_a_hand_rolls_are_there_more_moments() -> None:
    # 20 mm, of which the last 5 are passed with a roll of 0.2 rad: 4 steps of 0.05 there, one in the other 15 mm.
    points = tuple((-0.35, 0.2, 0.02 + 0.005 * i) for i in range(5))
    waypoints = waypoints_of([phase(holding(*points, rolls_rad=(0.0, 0.0, 0.0, 0.0, 0.2)))], HEIGHT_M)
    assert waypoints.fractions == pytest.approx([0.0, 0.25, 0.5, 0.75, 0.8125, 0.875, 0.9375, 1.0])


def test_equal_phases_have_the_same_moments_until_they_are_forgotten() -> None:
    there = (-0.3, 0.2, 0.12)
    found = waypoints_of([phase(holding(HERE, there))], HEIGHT_M)
    assert waypoints_of([phase(holding(HERE, there))], HEIGHT_M) is found
    assert waypoints_of([phase(holding(HERE, there))], HEIGHT_M, only_ends=True) is not found
    forget_waypoints()
    again = waypoints_of([phase(holding(HERE, there))], HEIGHT_M)
    assert again is not found
    np.testing.assert_array_equal(again.positions, found.positions)


def test_where_only_ends_are_wanted_they_are_those_of_all_moments() -> None:
    # The second phase turns the hand in its grip before it goes on, the third begins where a hand lets go.
    there, further = (-0.3, 0.2, 0.12), (-0.25, 0.1, 0.05)
    goal = Pose2(-1.05, 0.0, 0.0)
    phases = [
        phase(holding(HERE, there), holding(HERE)),
        phase(holding(there, HERE, further, approach=STEEP, rolls_rad=(0.0, 0.4, 0.9)), holding(HERE), end=goal),
        phase(holding(further, approach=STEEP)),
    ]
    every, ends = waypoints_of(phases, HEIGHT_M), waypoints_of(phases, HEIGHT_M, only_ends=True)
    assert len(ends) < len(every)
    last = np.flatnonzero(np.diff(every.phases, append=len(phases)))
    last_of_ends = np.flatnonzero(np.diff(ends.phases, append=len(phases)))
    for of_all, of_ends in ((0, 0), *zip(last.tolist(), last_of_ends.tolist(), strict=True)):
        assert np.array_equal(every.bases[of_all], ends.bases[of_ends])
        assert np.array_equal(every.positions[:, of_all], ends.positions[:, of_ends], equal_nan=True)
        assert np.array_equal(every.rotations[:, of_all], ends.rotations[:, of_ends], equal_nan=True)


def test_a_hand_that_goes_straight_has_the_moments_of_one_that_does_not() -> None:
    # One hand passes 30 mm and then 10 mm, the other 50 mm at the same time: 25 mm in each half.
    bent = holding(HERE, (-0.35, 0.2, 0.05), (-0.35, 0.2, 0.06))
    straight = holding((-0.35, -0.2, 0.02), (-0.3, -0.2, 0.02))
    waypoints = waypoints_of([phase(bent, straight)], HEIGHT_M)
    assert waypoints.fractions == pytest.approx([*np.arange(7) / 6])


def test_a_free_hand_is_nowhere() -> None:
    waypoints = waypoints_of([phase(holding(HERE, (-0.35, 0.2, 0.05)))], HEIGHT_M)
    assert waypoints.is_held.all(axis=1).tolist() == [True, False]
    assert np.isnan(waypoints.positions[1]).all() and np.isnan(waypoints.rotations[1]).all()


def test_time_goes_on_evenly_within_a_phase_and_none_goes_by_before_it() -> None:
    waypoints = waypoints_of([phase(holding(HERE, (-0.35, 0.2, 0.07)), duration_s=2.0)], HEIGHT_M)
    # 5 cm are 5 steps of 0.4 s.
    assert waypoints.nominal_s == pytest.approx([0.0, 0.4, 0.4, 0.4, 0.4, 0.4])
    assert not waypoints.is_driving.any()


def test_while_the_base_backs_off_from_cloth_that_rests_the_hand_goes_ahead_in_its_frame() -> None:
    waypoints = waypoints_of([phase(holding(HERE), duration_s=0.2, end=STAND.ahead(-0.05))], HEIGHT_M)
    assert len(waypoints) == 6 and waypoints.is_driving.all()
    assert waypoints.bases[:, 0] == pytest.approx([-0.95, -0.96, -0.97, -0.98, -0.99, -1.0])
    assert waypoints.positions[0, :, 0] == pytest.approx([0.6, 0.61, 0.62, 0.63, 0.64, 0.65])
    assert np.ptp(waypoints.positions[0, :, 1:], axis=0) == pytest.approx([0.0, 0.0])


def test_a_base_that_stands_turned_sees_the_table_turned() -> None:
    stand = Pose2(0.45, 0.64, -math.pi / 2)
    turned = replace(phase(holding((0.35, 0.04, 0.02))), base=(stand, stand))
    # It looks along -y from y = 0.64: 0.6 m ahead; its left is along +x, where the hand is at -0.1 m.
    assert waypoints_of([turned], HEIGHT_M).positions[0, 0] == pytest.approx((0.6, -0.1, HEIGHT_M + 0.02))


def test_a_roll_is_cut_into_small_angles() -> None:
    # 0.42 rad in steps of 0.05: 9 of them, though the tool goes no further than a centimetre.
    waypoints = waypoints_of([phase(holding(HERE, (-0.35, 0.2, 0.03), rolls_rad=(0.0, 0.42)))], HEIGHT_M)
    assert len(waypoints) == 10
    assert turns(waypoints, 0) == pytest.approx(np.full(9, 0.42 / 9))
    # About the approach axis, which stays.
    assert np.ptp(waypoints.rotations[0, :, :, 0], axis=0) == pytest.approx(np.zeros(3), abs=1e-12)


def test_both_hands_share_the_steps_of_the_one_that_goes_further() -> None:
    left, right = holding(HERE, (-0.35, 0.2, 0.08)), holding((-0.35, -0.2, 0.02), (-0.35, -0.2, 0.03))
    waypoints = waypoints_of([phase(left, right)], HEIGHT_M)
    assert len(waypoints) == 7
    assert np.diff(waypoints.positions[1, :, 2]) == pytest.approx(np.full(6, 0.01 / 6))


def test_phases_that_follow_one_another_share_the_moment_between_them() -> None:
    middle, goal = (-0.35, 0.2, 0.05), (-0.35, 0.2, 0.07)
    waypoints = waypoints_of([phase(holding(HERE, middle)), phase(holding(middle, goal))], HEIGHT_M)
    assert waypoints.phases.tolist() == [0, 0, 0, 0, 1, 1]
    assert waypoints.fractions == pytest.approx([0.0, 1 / 3, 2 / 3, 1.0, 0.5, 1.0])


@pytest.mark.parametrize(("before", "after"), [*product((SLANTED, STEEP, DOWN), repeat=2)])
@pytest.mark.parametrize("rolled", [(0.0, 0.0), (0.0, math.pi), (0.0, -math.pi)])
def test_a_hand_that_is_to_point_elsewhere_turns_in_its_grip_while_all_else_rests(
    before: Approach, after: Approach, rolled: tuple[float, float]
) -> None:
    middle, goal = (-0.35, 0.2, 0.05), (-0.35, 0.2, 0.07)
    first = phase(holding(HERE, middle, approach=before, rolls_rad=rolled))
    second = phase(holding(middle, goal, approach=after, rolls_rad=(0.0, 0.0)))
    waypoints = waypoints_of([first, second], HEIGHT_M)
    start, end = int(np.flatnonzero(waypoints.phases == 0)[-1]), len(waypoints) - 3
    # The second phase has two steps of a centimetre; what is between is the turn.
    assert waypoints.fractions[end + 1 :] == pytest.approx([0.5, 1.0])
    assert (waypoints.fractions[start + 1 : end + 1] == 0.0).all()
    assert (waypoints.nominal_s[start + 1 : end + 1] == 0.0).all() and not waypoints.is_driving.any()
    assert np.ptp(waypoints.positions[0, start : end + 1], axis=0) == pytest.approx(np.zeros(3), abs=1e-12)
    # Fingers that were flat are so again, and the approach axis is that of the phase to come.
    assert lean(waypoints.rotations[0, start]) < 1e-9 and lean(waypoints.rotations[0, end]) < 1e-9
    axis = after.rotation[:, 0]
    assert waypoints.rotations[0, end:, :, 0] == pytest.approx(np.broadcast_to(axis, (3, 3)), abs=1e-9)
    assert turns(waypoints, 0).max() <= STEP_RAD + 1e-9
    assert (end == start) == (before == after)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_half_a_turn_in_the_grip_goes_by_way_of_ahead_for_mirror_images_alike(side: float) -> None:
    here, there = (Approach(angle, SLANTED.pitch_rad) for angle in (side * math.pi / 2, -side * math.pi / 2))
    waypoints = waypoints_of(
        [phase(holding(HERE, (-0.35, 0.2, 0.05), approach=one)) for one in (here, there)], HEIGHT_M
    )
    ahead = waypoints.rotations[0, :, 0, 0]
    assert ahead.max() == pytest.approx(math.cos(SLANTED.pitch_rad), abs=1e-3) and ahead.min() > -1e-9


def test_a_hand_that_let_go_takes_its_next_grip_without_a_turn() -> None:
    middle = (-0.35, 0.2, 0.03)
    left, right = holding(HERE, middle), holding((-0.35, -0.2, 0.02), (-0.35, -0.2, 0.03))
    phases = [phase(left, right), phase(None, right), phase(holding(HERE, middle, approach=STEEP), right)]
    waypoints = waypoints_of(phases, HEIGHT_M)
    assert waypoints.phases.tolist() == [0, 0, 1, 2]
    assert waypoints.is_held[0].tolist() == [True, True, False, True]


@pytest.mark.parametrize("name", ["letter-towel", "t-shirt"])
def test_in_a_plan_nothing_goes_further_from_moment_to_moment_than_is_said(name: str) -> None:
    for plan_segment in planned(name).found.plan_segments:
        if plan_segment.transfer is None:
            continue
        phases = [p for step in plan_segment.steps for p in step.phases if p.duration_s > 0.0 and is_carrying(p)]
        waypoints = waypoints_of(phases, HEIGHT_M)
        assert np.linalg.norm(np.diff(waypoints.bases[:, :2], axis=0), axis=1).max() <= STEP_M + 1e-9
        assert waypoints.nominal_s.sum() == pytest.approx(sum(p.duration_s for p in phases))
        for arm in np.flatnonzero(waypoints.is_held.any(axis=1)):
            held = waypoints.is_held[arm]
            both = held[1:] & held[:-1]
            assert np.linalg.norm(np.diff(waypoints.positions[arm], axis=0), axis=1)[both].max() <= STEP_M + 1e-9
            rotations = waypoints.rotations[arm][held]
            turned = Rotation.from_matrix(rotations[:-1].swapaxes(1, 2) @ rotations[1:]).magnitude()
            assert turned.max() <= STEP_RAD + 1e-9
