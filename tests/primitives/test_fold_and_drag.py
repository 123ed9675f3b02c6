"""Folds and drags of a robot that reaches everything: what is left are cloth, grips, and the base's grid.

The towel is 0.4 x 0.3 m. At yaw -90 degrees its upper edge lies away from `front`: garment (x, y) is at table
(px + y, py - x).
"""

import math

import numpy as np
import pytest

from planner.cloth.garment import DrawnFold, Garment
from planner.geometry.pose import Pose2
from planner.primitives.base_legs import unbeaten
from planner.primitives.context import Context
from planner.primitives.drag_step import DragStep
from planner.primitives.fold_step import FoldStep
from planner.primitives.fold_trial import fold_trials
from planner.primitives.g_drag import GDrag
from planner.primitives.g_fold import GFold
from planner.primitives.state import Held, State
from planner.task.scene import Scene
from tests.builders import context, fold, garment, rectangle_points
from tests.wide_reach import WideReach

NEAR_HALF = fold((0.4, 0.15), (0.0, 0.15))
BACK = -math.pi / 2


def towel(*folds: DrawnFold, x_m: float = -0.75, y_m: float = 0.2) -> Garment:
    """Return a towel whose near edge lies at x = `x_m`."""
    return garment(rectangle_points(0.4, 0.3), *folds, placement=Pose2(x_m, y_m, BACK))


def start(standoff: int = 0) -> State:
    return State(0, (0.0, 0.0), 0, standoff)


def folds_of(problem: Context, state: State | None = None) -> list[FoldStep]:
    return list(GFold(problem).successors(state or start()))


def drags_of(problem: Context, state: State | None = None) -> list[DragStep]:
    return list(GDrag(problem).successors(state or start()))


def test_a_fold_in_reach_from_where_the_base_stands_takes_three_arm_motions() -> None:
    (step,) = folds_of(context(towel(NEAR_HALF)))
    assert step.duration_s == 9.0
    assert step.after.done == 1 and step.after.standoff == 0 and not step.after.held
    assert sum(phase.duration_s for phase in step.phases) == pytest.approx(9.0)


def test_its_grips_are_the_near_corners_the_left_arm_at_the_left() -> None:
    (step,) = folds_of(context(towel(NEAR_HALF)))
    left, right = step.grips
    assert (left.arm, right.arm) == ("left", "right")
    assert left.pick == pytest.approx((-0.75, 0.2, 0.02))
    assert left.apex == pytest.approx((-0.6, 0.2, 0.17))
    assert left.place == pytest.approx((-0.45, 0.2, 0.02))
    assert right.pick == pytest.approx((-0.75, -0.2, 0.02))


def test_a_hand_on_the_extension_of_the_fold_line_stays_as_it_is_while_the_other_folds() -> None:
    # The line x = 0.2 ends in a notch at (0.2, 0.24); the corner (0.2, 0.3) of the part that moves is on its extension.
    outline = ((0.0, 0.0), (0.4, 0.0), (0.4, 0.2), (0.3, 0.3), (0.2, 0.24), (0.2, 0.3), (0.0, 0.2))
    notched = garment(outline, fold((0.2, 0.0), (0.2, 0.24)), placement=Pose2(-0.75, 0.2, BACK))
    step = folds_of(context(notched))[0]
    left, right = step.grips
    assert left.place == pytest.approx((-0.65, -0.2, 0.02))
    for place in (right.pick, right.apex, right.place):
        assert place == pytest.approx((-0.45, 0.0, 0.02))
    still = [phase.hands[1] for phase in step.phases if phase.hands[1] is not None]
    assert {roll for hand in still for roll in hand.rolls_rad} == {0.0}


def test_the_base_drives_to_where_the_grips_are_in_reach_and_pays_for_it() -> None:
    # The hands go from x = 0.2 to 0.5 m ahead of the base at 0: all their way is between 0.35 and 0.65 only from 0.15 m
    # back. 0.15 / 0.25 = 0.6 s more.
    far = WideReach([(0.35, 0.65)])
    (step,) = folds_of(context(towel(NEAR_HALF), reach=far))
    assert step.after.standoff == 3
    assert step.duration_s == pytest.approx(9.6)
    assert sum(phase.duration_s for phase in step.phases) == pytest.approx(9.6)


def test_the_base_follows_its_hands_where_no_one_place_will_do() -> None:
    # The hands go from x = 0.2 to 0.5 m ahead of the base at 0. Only x + 0.05 b between 0.4 and 0.6 is in reach:
    # 0.2 needs b = 4..8, 0.5 needs b = 0..2: at least two steps forward, and from b = 0 first four back.
    band = WideReach([(0.4, 0.6)])
    steps = folds_of(context(towel(NEAR_HALF), reach=band))
    nearest = min(steps, key=lambda s: s.duration_s)
    assert nearest.after.standoff == 2
    assert nearest.duration_s == pytest.approx(9.0 + (4 + 2) * 0.2)
    assert sum(phase.duration_s for phase in nearest.phases) == pytest.approx(nearest.duration_s)


def test_what_no_arm_reaches_is_noted_and_not_done() -> None:
    problem = context(towel(NEAR_HALF), reach=WideReach([]))
    assert folds_of(problem) == []
    assert [code.value for code in problem.obstacles.codes(0)] == ["out_of_reach"]


def test_grips_nearer_than_ten_centimetres_are_not_taken_by_two_hands() -> None:
    # A ribbon 0.08 m wide with a grip radius too small for one hand to hold both its corners.
    ribbon = garment(
        rectangle_points(0.08, 0.3), fold((0.08, 0.15), (0.0, 0.15), radius_m=0.03), placement=Pose2(-0.7, 0.0, BACK)
    )
    problem = context(ribbon)
    assert folds_of(problem) == []
    assert [code.value for code in problem.obstacles.codes(0)] == ["grips_too_close"]


def test_a_line_wholly_off_the_table_is_not_folded() -> None:
    problem = context(towel(NEAR_HALF, x_m=-0.97))
    # The line lies at x = -0.97 + 0.15 = -0.82, beyond the edge at -0.8.
    assert folds_of(problem) == []
    assert "line_off_table" in [code.value for code in problem.obstacles.codes(0)]


def test_a_fold_after_which_the_cloth_would_slip_is_not_done() -> None:
    # The far half comes over the near one: at x = -0.9..-0.75 twice, of it 0.1 m hang and 0.05 m lie.
    problem = context(towel(fold((0.0, 0.15), (0.4, 0.15)), x_m=-0.9))
    assert folds_of(problem) == []
    assert [code.value for code in problem.obstacles.codes(0)] == ["slips"]


def test_a_fold_before_a_red_one_keeps_hold_and_the_red_one_saves_the_reach() -> None:
    blue = fold((0.4, 0.12), (0.0, 0.12))
    # The flap's free edge comes to lie at y = 0.24; its outer third turns back down over y = 0.2.
    red = fold((0.0, 0.2), (0.4, 0.2), "red")
    problem = context(towel(blue, red))
    holding = [s for s in folds_of(problem) if s.after.standoff == 0]
    assert len(holding) == 1 and holding[0].details == {"fold": 0, "holds": True}
    held = holding[0].after
    assert not held.is_dragged
    assert [h.point for h in held.held] == [pytest.approx((0.0, 0.24)), pytest.approx((0.4, 0.24))]
    assert list(GDrag(problem).successors(held)) == []
    (second,) = folds_of(problem, held)
    assert second.duration_s == 6.0 and not second.after.held
    assert second.grips[0].pick == pytest.approx((-0.51, 0.2, 0.02))


def test_drags_go_towards_the_robot_by_tenths_of_a_metre_up_to_the_garments_length() -> None:
    # 0.3 m along the way of the drag, 0.4 m long: at most 0.4, but 0.3 would leave nothing on the table, and at
    # 0.2 m 0.15 m hang against 0.15 m lying: that just stays.
    steps = drags_of(context(towel(NEAR_HALF)))
    assert {s.details["distance_m"] for s in steps} == {0.1, 0.2}
    for step in steps:
        assert step.after.offset == pytest.approx((-step.distance_m, 0.0))
        assert step.after.standoff == step.first_stand + round(20 * step.distance_m)
        assert sum(p.duration_s for p in step.phases) == pytest.approx(step.duration_s)


def test_a_drag_costs_the_reach_and_the_way() -> None:
    straight = [s for s in drags_of(context(towel(NEAR_HALF))) if s.first_stand == 0 and s.distance_m == 0.2]
    assert {s.duration_s for s in straight} == {3.0 + 0.2 / 0.25 + 0.25 / 0.5}  # from rest to rest


def test_a_drag_takes_the_near_corners_and_moves_them_by_its_distance() -> None:
    step = next(s for s in drags_of(context(towel(NEAR_HALF))) if s.distance_m == 0.1)
    for grip in step.grips:
        assert grip.apex is None
        assert grip.pick[2] == grip.place[2] == 0.02
        assert grip.place == pytest.approx((grip.pick[0] - 0.1, grip.pick[1], 0.02))
    assert step.grips[0].pick == pytest.approx((-0.75, 0.2, 0.02))


def test_after_a_drag_the_hands_let_go_or_hold_on_for_a_fold() -> None:
    held = {bool(s.after.held) for s in drags_of(context(towel(NEAR_HALF)))}
    assert held == {True, False}
    # Without a fold that could use them, they let go.
    across = fold((0.2, 0.0), (0.2, 0.3))
    assert {bool(s.after.held) for s in drags_of(context(towel(across)))} == {False}


def test_a_fold_with_the_grips_of_a_drag_starts_where_they_are_held_and_saves_the_reach() -> None:
    problem = context(towel(NEAR_HALF))
    drag = next(s for s in drags_of(problem) if s.after.held and s.distance_m == 0.1 and s.first_stand == 0)
    steps = folds_of(problem, drag.after)
    step = min(steps, key=lambda s: s.duration_s)
    assert step.duration_s == 6.0
    # Held out at the table's height 0.05 m beyond its edge, not hanging.
    assert step.grips[0].pick == pytest.approx((-0.85, 0.2, 0.02))


def test_no_drag_goes_towards_an_edge_from_which_cloth_hangs() -> None:
    assert drags_of(context(towel(NEAR_HALF, x_m=-0.85))) == []


def test_a_drag_ends_no_further_back_than_the_base_may_go() -> None:
    short = Scene(back_off_max_m=0.1)
    assert {s.distance_m for s in drags_of(context(towel(NEAR_HALF), short))} == {0.1}


def test_of_ends_those_stay_that_cannot_be_had_by_driving_on() -> None:
    # From end 2 (cost 1) end 3 costs 2 by driving on, so its own 2 is no better and its own 1 would be.
    assert unbeaten(np.array([9, 5, 1, 2, 2])) == [2, 4]
    assert unbeaten(np.array([9, 5, 1, 1])) == [2, 3]


def test_grips_that_are_the_same_to_the_grid_are_held_alike_though_a_rounding_error_lies_between() -> None:
    # A drag that is tried from two places may find its grips a rounding error apart: equal states, unequal points.
    problem = context(towel(NEAR_HALF))
    ways = []
    for off_m in (0.0, 1e-9):
        held = tuple(Held(arm, (x + off_m, off_m)) for arm, x in enumerate((0.0, 0.4)))
        state = State(0, (-0.1, 0.0), 0, 2, held, dragged=1)
        (trial,) = fold_trials(problem, state, 0)
        ways.append((state, trial.arms))
        assert sorted(trial.cover) == sorted(h.point for h in held)
    assert ways[0] == ways[1]
