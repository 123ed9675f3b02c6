"""Out of reach: each cause provoked, its numbers worked out by hand, and fixed by its change."""

import math
from dataclasses import replace

import numpy as np
import pytest

from planner import Garment, Scene, Task, find_plan, make_plan
from planner.deadline import ENDLESS, Deadline
from planner.explain.reasons import reasons
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.task.reason import Code, Reason
from tests.builders import fold, garment, rectangle_points
from tests.planning.found import found_plan
from tests.planning.provoked import (
    BACK,
    COMFORT_M,
    FORE_M,
    FRONT,
    FURTHEST_X,
    HAMMER_SCENE,
    LEVEL_M,
    STRAIGHT_M,
    UPPER_M,
    but_for_collisions,
    fixed,
    hammer,
    is_gone,
    is_in_reach,
    met,
    refused,
    strip,
)
from tests.replay.planned import shipped_plan
from tests.required import required


def test_a_grip_too_far_ahead_is_short_by_what_it_is_beyond_the_straight_arm() -> None:
    # The comfort circle's furthest point must be in reach too.
    cloth = strip(FURTHEST_X - COMFORT_M + 0.05, 0.3, 0.1)
    (reason,) = refused(cloth, fixed()).reasons
    assert (reason.fold, reason.code, reason.cause, reason.joint) == (0, Code.OUT_OF_REACH, "too_far", None)
    assert reason.short_by_m == pytest.approx(0.05, abs=0.0015)
    assert reason.point == pytest.approx((FURTHEST_X + 0.02, 0.188, 0.02))
    assert reason.towards == pytest.approx((-1.0, 0.0, 0.0)) and reason.arm == "left"
    assert (reason.station, reason.back_off_m, reason.offset_m) == ("front", 0.0, (0.0, 0.0))
    # It is pinched from beyond, which of the hand's orientations only straight down allows.
    assert required(reason.approach).pitch_rad == pytest.approx(math.pi / 2)
    assert not reason.is_at_least and "at least" not in reason.message
    assert "the left grip at (-0.16, 0.19) m, 0.02 m over the table where it is picked up" in reason.message
    assert "0.05 m out of reach (too far); closest: front, backed off 0.00 m" in reason.message
    # Nearer to the table, the robot's base would be in its way.
    assert "nearer to the robot: move the cloth" in reason.message and "station" not in reason.message.split(":")[-1]


@pytest.mark.parametrize("by_m", [0.001, -0.003])
def test_moved_by_what_it_is_short_and_no_less_it_is_in_reach(by_m: float) -> None:
    cloth = strip(FURTHEST_X - COMFORT_M + 0.05, 0.3, 0.1)
    (reason,) = refused(cloth, fixed()).reasons
    for moved, scene in (_moved_cloth(cloth, reason, by_m), _moved_station(cloth, reason, by_m)):
        assert is_in_reach(found_plan(moved, scene, time_limit_s=60.0), 0) == (by_m > 0.0)


def test_a_grip_that_lacks_only_comfort_says_how_much_it_has() -> None:
    # 14 mm further than comfort allows: 16 mm of the circle's 30 mm are left.
    cloth = strip(FURTHEST_X - 0.016, 0.3, 0.1)
    answer = met(cloth, fixed())
    (reason,) = answer.plan.reasons
    assert (reason.code, reason.cause) == (Code.OUT_OF_REACH, "comfort_only")
    assert reason.comfort_m == pytest.approx(0.016, abs=0.0011)
    assert reason.short_by_m == pytest.approx(0.014, abs=0.0015)
    assert "with a margin of 0.015 m only, not 0.03 m" in reason.message
    assert not is_in_reach(answer, 0)
    comfort_m = required(reason.comfort_m)
    assert is_in_reach(found_plan(cloth, fixed(), comfort_radius_m=comfort_m, time_limit_s=60.0), 0)
    assert not is_in_reach(found_plan(cloth, fixed(), comfort_radius_m=comfort_m + 0.002, time_limit_s=60.0), 0)


def test_a_path_rises_as_high_as_the_part_that_moves_is_deep() -> None:
    # Only straight ahead or down: to its sides a hand reaches higher, and then the table is in its way.
    # Straight down, a hand hangs from a forearm that the wrist's limit of 1.994 rad lets rise by 1.994 - pi / 2 at
    # most, from an elbow that the shoulder's lift lets rise by 0.3536 rad. The apex is D + 0.02 over the table, and the
    # wrist 0.18 m over that.
    depth, height = 0.26, 0.903
    rise = UPPER_M * math.sin(0.3536) + FORE_M * math.sin(1.994 - math.pi / 2)
    over = height + depth + 0.02 + 0.18 - (0.051 + 0.739675 + 0.29) - rise
    assert 0.01 < over < 0.03
    scene = Scene(stations=FRONT, table=Table(height_m=height), approach_cone_rad=0.0)
    reason = but_for_collisions(refused(strip(-0.24, 0.54, depth), scene))
    assert (reason.code, reason.cause, reason.joint) == (Code.OUT_OF_REACH, "too_far", "wrist")
    assert reason.short_by_m == pytest.approx(over, abs=0.0015)
    assert required(reason.point)[2] == pytest.approx(depth + 0.02)
    assert reason.towards == pytest.approx((0.0, 0.0, -1.0))
    assert "0.28 m over the table at the top of its way" in reason.message
    assert "lower the table or raise the torso" in reason.message
    lower = replace(scene, table=Table(height_m=height - required(reason.shift_m) - 0.001))
    assert is_gone(reason, make_plan(strip(-0.24, 0.54, depth), lower, time_limit_s=60.0))
    raised = Scene(stations=FRONT, table=Table(height_m=height), torso_m=0.29 + required(reason.shift_m) + 0.001)
    assert is_gone(reason, make_plan(strip(-0.24, 0.54, depth), raised, time_limit_s=60.0))
    less = strip(-0.24, 0.54, depth - required(reason.short_by_m) - 0.001)
    assert is_gone(reason, make_plan(less, scene, time_limit_s=60.0))


def test_a_grip_at_the_shoulders_foot_is_too_near_for_the_elbow() -> None:
    # Fingers ahead: approach cone 0. From the pan axis, 0.05 m behind the base's middle, the grip is 0.1 m ahead and
    # the wrist 0.18 cos(p) behind it and 0.18 (1 - sin p) below the shoulder, at pitches of 15 to 90 degrees.
    cloth = garment(
        rectangle_points(0.1, 0.3), fold((0.1, 0.1), (0.0, 0.1)), placement=Pose2(-0.95 + 0.05, 0.238, BACK)
    )
    scene = replace(fixed(approach_cone_rad=0.0), table=Table(height_m=LEVEL_M, depth_m=2.4))
    reason = but_for_collisions(refused(cloth, scene))
    assert (reason.code, reason.cause) == (Code.OUT_OF_REACH, "too_near")
    assert required(reason.approach).heading_rad == pytest.approx(0.0)
    # However the shoulder pans, the wrist is at most so far from the lift axis; the elbow, bent by 2.3213 rad at most,
    # lets it come no nearer than `nearest`.
    nearest = math.sqrt(0.4**2 + 0.321**2 + 2 * 0.4 * 0.321 * math.cos(2.3213))
    pitches = np.radians([15, 30, 45, 60, 90])
    furthest = np.hypot(abs(0.1 - 0.18 * np.cos(pitches)) + 0.1, 0.18 * (1.0 - np.sin(pitches))).max()
    assert nearest - furthest > 0.07
    assert required(reason.short_by_m) > nearest - furthest
    assert required(reason.towards)[0] == pytest.approx(1.0)
    moved, changed = _moved_station(cloth, reason, 0.001)
    assert is_in_reach(found_plan(moved, changed, time_limit_s=60.0), 0)


def test_a_grip_behind_the_shoulder_is_beyond_the_limit_of_its_pan() -> None:
    # From the left shoulder the grip is 0.05 m behind and 0.288 m to the right: at -100 degrees, and a left shoulder
    # pans to -0.5646 rad, -32 degrees. To go ahead hardly changes how far it is, only where. At a table as low as this
    # it is further below the shoulder than what its lift keeps it from.
    cloth = garment(rectangle_points(0.1, 0.5), fold((0.1, 0.1), (0.0, 0.1)), placement=Pose2(-0.1 - 0.95, -0.05, BACK))
    scene = Scene(
        stations=FRONT,
        back_off_max_m=0.0,
        approach_cone_rad=0.0,
        table=Table(height_m=0.6, depth_m=4.0, width_m=3.0),
    )
    reason = but_for_collisions(refused(cloth, scene))
    assert (reason.code, reason.cause, reason.joint) == (Code.OUT_OF_REACH, "joint_limit", "shoulder pan")
    assert reason.arm == "left"
    seen = np.array(reason.point) - np.array([-0.95 - 0.05, 0.188, 0.051 + 0.739675 + 0.29 - 0.6])
    assert math.degrees(math.atan2(seen[1], seen[0])) < -90.0
    short_by_m = required(reason.short_by_m)
    further = np.linalg.norm(seen + short_by_m * np.array(reason.towards)) - np.linalg.norm(seen)
    assert abs(further) < 0.1 * short_by_m
    assert "joint limit, shoulder pan limit" in reason.message


def test_what_is_far_away_is_short_by_at_least_its_distance() -> None:
    # The arm is 1.001 m long from pan axis to tool, and the far end 2.0 m ahead of the left shoulder. With the hand
    # straight down, the elbow as straight as it goes, and room for comfort, the arm gets as far as its wrist does.
    table = Table(depth_m=4.0, height_m=LEVEL_M)
    scene = replace(fixed(), table=table, stations=(("front", Pose2(-1.5, 0.0, 0.0)),))
    reason = but_for_collisions(refused(strip(-1.5 - 0.05 + 2.0, 0.3, 0.1), scene))
    assert (reason.code, reason.cause) == (Code.OUT_OF_REACH, "too_far")
    short_by_m, shift_m = required(reason.short_by_m), required(reason.shift_m)
    assert short_by_m >= 2.0 - (0.1 + 0.4 + 0.321 + 0.18)
    assert reason.is_at_least and "at least" in reason.message
    assert shift_m == pytest.approx(2.0 + COMFORT_M - (0.1 + STRAIGHT_M), abs=0.001)
    assert shift_m - (UPPER_M + FORE_M - STRAIGHT_M) - 0.001 < short_by_m < shift_m
    assert "1.21 m nearer to the robot: move the cloth" in reason.message


@pytest.mark.long
def test_where_no_shift_would_do_the_reason_says_so() -> None:
    (reason, *_) = shipped_plan("scarf-halved").reasons
    assert reason.shift_m is None
    assert "make a smaller fold" in reason.message


@pytest.mark.parametrize(("height_m", "up"), [(0.35, 0.0), (1.5, -1.0)])
def test_shifted_as_the_reason_says_all_that_both_hands_do_is_in_reach(height_m: float, up: float) -> None:
    towel = garment(rectangle_points(0.4, 0.4), fold((0.0, 0.3), (0.4, 0.3)), placement=Pose2(-0.7, 0.2, BACK))
    reason = but_for_collisions(refused(towel, fixed(height_m)))
    shift_m = required(reason.shift_m)
    assert required(reason.shift_towards)[2] == pytest.approx(up)
    assert shift_m >= required(reason.short_by_m) - 0.002
    for by_m, is_enough in ((0.001, True), (-0.021, False)):
        x, y, z = (shift_m + by_m) * np.array(reason.shift_towards)
        stations = tuple((name, pose.moved(-float(x), -float(y))) for name, pose in FRONT)
        changed = replace(fixed(height_m + float(z)), stations=stations)
        assert is_in_reach(found_plan(towel, changed, time_limit_s=60.0), 0) == is_enough


def _moved_cloth(cloth: Garment, reason: Reason, by_m: float) -> tuple[Garment, Scene]:
    x, y, _ = (required(reason.short_by_m) + by_m) * np.array(reason.towards)
    return replace(cloth, placement=cloth.placement.moved(float(x), float(y))), fixed()


def _moved_station(cloth: Garment, reason: Reason, by_m: float) -> tuple[Garment, Scene]:
    x, y, _ = (required(reason.short_by_m) + by_m) * np.array(reason.towards)
    stations = tuple((name, pose.moved(-float(x), -float(y))) for name, pose in FRONT)
    return cloth, replace(fixed(), stations=stations)


def test_a_reason_is_told_with_what_is_known_once_nobody_waits_any_more() -> None:
    """No move that would help is looked for then."""
    known = find_plan(Task.of(hammer(), HAMMER_SCENE), with_reasons=False).context
    shifts = []
    for deadline in (Deadline(-1.0), ENDLESS):
        context = replace(known, deadline=deadline)
        shifts += [reason.shift_m for reason in reasons(context, (), [0]) if reason.code is Code.NOT_A_G_STATE]
    assert shifts == [None, pytest.approx(0.05)]
