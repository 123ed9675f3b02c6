"""Red folds in the search: grips, order, and times."""

import math

import pytest

from planner import make_plan
from planner.cloth.garment import DrawnFold, Garment
from planner.errors import FoldError
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Pose2
from planner.primitives.base_move import BaseMove
from planner.primitives.context import Context
from planner.primitives.fold_step import FoldStep
from planner.primitives.g_drag import GDrag
from planner.primitives.g_fold import GFold
from planner.primitives.state import State
from planner.task.reason import Code
from tests.builders import context, fold, garment, is_same_region, is_same_stack, rectangle, rectangle_points
from tests.planning.red_towels import BACK, CORNER, OUT, OVER, TWO_SIDES, WIDTH_M, towel
from tests.required import required

START = State(0, (0.0, 0.0), 0, 0)


def banner(bar_m: float, radius_m: float = 0.127) -> Garment:
    """A T upside down, 0.5 m wide, its bar so high: the bar comes over, its left end then turns in.

    The stem is 0.2 m wide. The bar's inner corners have cloth straight beyond them when the near part comes over,
    so that only its outer corners are held; when its end turns in, both corners of the end must be.
    """
    outline = [
        (0.0, 0.0),
        (0.5, 0.0),
        (0.5, bar_m),
        (0.35, bar_m),
        (0.35, 0.6),
        (0.15, 0.6),
        (0.15, bar_m),
        (0.0, bar_m),
    ]
    over = fold((0.35, 0.3), (0.15, 0.3), name="over")
    turned_in = fold((0.15, 0.6 - bar_m), (0.15, 0.6), "red", name="end in", radius_m=radius_m)
    return garment(outline, over, turned_in, placement=Pose2(-0.75, 0.25, -math.pi / 2))


def step_of(problem: Context, state: State, index: int = 0) -> FoldStep:
    """Return the only successor of a state, for a robot that reaches everything, without driving."""
    steps = [s for s in GFold(problem).successors(state) if s.after.standoff == state.standoff]
    return next(s for s in steps if s.way.trial.fold == index or state.held)


def held(state: State) -> dict[int, tuple[float, float]]:
    return {h.arm: h.point for h in state.held}


def test_a_chain_takes_three_motions_for_the_blue_fold_and_two_for_each_red_one() -> None:
    problem = context(towel(OVER, BACK, OUT))
    over = step_of(problem, START)
    back = step_of(problem, over.after)
    out = step_of(problem, back.after)
    assert [step.duration_s for step in (over, back, out)] == [9.0, 6.0, 6.0]
    assert out.after.done == 0b111


def test_the_hands_keep_the_free_edge_through_the_whole_chain_and_then_let_go() -> None:
    # Its corners are at y = 0, then 2 x 0.25, then 2 x 0.4 - 0.5, then 2 x 0.35 - 0.3; the left arm has x = 0.
    problem = context(towel(OVER, BACK, OUT))
    state, edges = START, []
    for index in range(3):
        step = step_of(problem, state, index)
        edges.append([grip.place for grip in step.grips])
        state = step.after
        if index < 2:
            assert not state.is_dragged
            assert held(state) == {
                0: pytest.approx((0.0, (0.5, 0.3)[index])),
                1: pytest.approx((WIDTH_M, (0.5, 0.3)[index])),
            }
    for places, y in zip(edges, (0.5, 0.3, 0.4), strict=True):
        assert places == [pytest.approx((y - 0.75, side, 0.02)) for side in (0.2, -0.2)]
    assert not state.held


def test_a_red_fold_takes_only_what_the_fold_before_it_moved() -> None:
    # Pattern y: the flap is 0 < p < 0.25 and lies at 0.5 - p; p < 0.1 goes back to 0.3 + p; p < 0.05 out to 0.4 - p.
    layers = FoldSequence.of(towel(OVER, BACK, OUT)).final.layers
    assert [layer.face for layer in layers] == ["front", "back", "front", "back"]
    for layer, (low, high) in zip(layers, ((0.25, 0.6), (0.25, 0.4), (0.35, 0.4), (0.35, 0.4)), strict=True):
        assert is_same_region(layer.region, rectangle(WIDTH_M, high - low, 0.0, low))
    middles = [layer.to_pattern((0.2, 0.375))[1] for layer in layers]
    assert middles == pytest.approx([0.375, 0.125, 0.075, 0.025])


def test_a_red_fold_over_a_flap_of_two_layers_turns_both() -> None:
    # Half of the towel over x = 0.2, so that all is double; then the near part over, and its outer part back.
    double = towel(fold((0.2, 0.0), (0.2, 0.6)), fold((0.4, 0.25), (0.2, 0.25)), fold((0.2, 0.4), (0.4, 0.4), "red"))
    layers = FoldSequence.of(double).final.layers
    # From below at (0.3, 0.35): what stayed (x, then 0.4 - x on it, face down); the flap upside down, 0.4 - x below x;
    # its outer part turned once more: x below 0.4 - x again. Pattern y: 0.35; 0.5 - 0.35; 0.5 - (0.8 - 0.35).
    found = [layer.to_pattern((0.3, 0.35)) for layer in layers if layer.region.contains((0.3, 0.35))]
    wanted = [(0.3, 0.35), (0.1, 0.35), (0.1, 0.15), (0.3, 0.15), (0.3, 0.05), (0.1, 0.05)]
    assert found == [pytest.approx(place) for place in wanted]


def test_of_two_hands_the_one_that_is_not_needed_lets_go_first() -> None:
    # The corner (0.4, 0.5) is held by the right hand, the left one is 0.4 m away.
    problem = context(towel(OVER, CORNER))
    corner = step_of(problem, step_of(problem, START).after)
    assert [grip.arm for grip in corner.grips] == ["right"]
    assert all(phase.hands[0] is None and phase.hands[1] is not None for phase in corner.phases)
    # Over the line through (0.25, 0.5) and (0.4, 0.4), of direction (3, -2) / sqrt 13: the corner is at
    # 0.15 x 2 / sqrt 13 = 0.0832 from it, and goes by twice that along (-2, -3) / sqrt 13.
    twice, length = 2 * 0.15 * 2 / math.sqrt(13), math.sqrt(13)
    x, y = 0.4 - twice * 2 / length, 0.5 - twice * 3 / length
    assert corner.grips[0].place == pytest.approx((y - 0.75, 0.2 - x, 0.02))


def test_a_hand_that_has_let_go_in_a_chain_holds_nothing_later_in_it() -> None:
    # Of the corner's flap, a triangle, the tip goes back again over a line half-way to it: held by the right
    # hand alone.
    problem = context(towel(OVER, CORNER, tip()))
    over = step_of(problem, START)
    corner = step_of(problem, over.after)
    assert set(held(over.after)) == {0, 1} and set(held(corner.after)) == {1}
    assert [grip.arm for grip in step_of(problem, corner.after).grips] == ["right"]


def tip() -> DrawnFold:
    """Return the corner's flap, halved parallel to its crease: from side to side half-way to its tip."""
    length = math.sqrt(13)
    twice = 2 * 0.15 * 2 / length
    landed = (0.4 - twice * 2 / length, 0.5 - twice * 3 / length)
    ends = [((x + landed[0]) / 2, (y + landed[1]) / 2) for x, y in ((0.25, 0.5), (0.4, 0.4))]
    return fold(ends[1], ends[0], "red", name="tip")


def test_one_hand_holds_two_corners_that_are_no_further_apart_than_its_radius() -> None:
    # The bar is 0.12 m high: its end's inner corner is 0.12 m from the outer one, which the left hand holds.
    problem = context(banner(0.12))
    end_in = step_of(problem, step_of(problem, START).after)
    assert [grip.arm for grip in end_in.grips] == ["left"]


def test_what_no_hand_holds_any_more_cannot_be_folded_in_a_chain() -> None:
    # The bar is 0.2 m high, more than the radius of 0.127 m; with a radius of 0.2 m one hand holds both.
    problem = context(banner(0.2))
    assert list(GFold(problem).successors(step_of(problem, START).after)) == []
    assert [o.code for o in problem.obstacles.of(1)] == [Code.RED_NEEDS_HOLD]
    wide = context(banner(0.2, radius_m=0.2))
    assert step_of(wide, step_of(wide, START).after).after.done == 0b11


def test_a_hand_on_the_part_that_stays_holds_nothing_of_the_part_that_moves() -> None:
    # A ribbon 0.15 m wide: one hand holds both corners firmly from between them, 0.075 m from each. A corner then goes
    # back over a line 0.06 m from it along both edges. It is well within the hand's radius, but the hand is on the
    # other side of the line.
    over, corner = fold((0.15, 0.2), (0.0, 0.2)), fold((0.0, 0.34), (0.06, 0.4), "red")
    problem = context(garment(rectangle_points(0.15, 0.5), over, corner))
    first = step_of(problem, START)
    assert [h.point for h in first.after.held] == [pytest.approx((0.075, 0.4))]
    assert list(GFold(problem).successors(first.after)) == []
    assert [o.code for o in problem.obstacles.of(1)] == [Code.RED_NEEDS_HOLD]


def test_a_red_fold_that_cannot_be_held_is_the_reason_why_there_is_no_plan() -> None:
    answer = make_plan(banner(0.2), time_limit_s=60.0)
    assert answer.status == "infeasible"
    assert (answer.reasons[0].fold, answer.reasons[0].code) == (1, Code.RED_NEEDS_HOLD)


def test_a_red_fold_that_would_tear_says_how_much_of_the_crease_it_would_pull_away() -> None:
    # It moves the flap's left 0.1 m, and with it 0.1 m of the crease y = 0.25, up to 100 mm from its line.
    torn = fold((0.1, 0.25), (0.1, 0.5), "red")
    with pytest.raises(FoldError, match=r"reaches 100\.0 mm along the crease.* tear") as caught:
        FoldSequence.of(towel(OVER, torn))
    assert caught.value.field == "folds[1].start"
    with pytest.raises(FoldError, match="tear"):
        make_plan(towel(OVER, torn))


def test_in_a_chain_only_the_last_crease_counts_for_tearing() -> None:
    # The third fold pulls at the second one's crease, y = 0.4, along 0.1 m; that of the first it does not reach.
    torn = fold((0.1, 0.3), (0.1, 0.4), "red")
    with pytest.raises(FoldError, match=r"reaches 100\.0 mm") as caught:
        FoldSequence.of(towel(OVER, BACK, torn))
    assert caught.value.field == "folds[2].start"


def test_while_a_chain_is_under_way_nothing_else_can_be_done() -> None:
    problem = context(TWO_SIDES)
    assert problem.sequence.dag.available(0) == (0, 2)
    first = step_of(problem, START)
    assert {step.way.trial.fold for step in GFold(problem).successors(first.after)} == {1}
    assert list(GDrag(problem).successors(first.after)) == []
    assert list(BaseMove(problem).successors(first.after)) == []


def test_a_chain_takes_its_own_flap_also_after_a_later_fold_that_was_done_first() -> None:
    # In bits: the right side alone is 0b100, the left over it 0b101, its edge back 0b111.
    sequence = FoldSequence.of(TWO_SIDES)
    assert is_same_region(sequence.folded(0b101, 1).moving, rectangle(0.08, 0.24, 0.24))
    right_first = sequence.folded(0b101, 1).cloth
    in_order = FoldSequence.of(TWO_SIDES).final
    assert is_same_stack(right_first, in_order)


@pytest.mark.parametrize("heuristic", ["arm_time", "zero"])
def test_a_search_through_all_orders_of_a_chain_and_a_fold_apart_finds_a_plan(heuristic: str) -> None:
    answer = make_plan(TWO_SIDES, heuristic=heuristic, time_limit_s=60.0)
    folds = [required(step.fold) for step in answer.steps if step.kind == "fold"]
    assert sorted(folds) == [0, 1, 2] and folds.index(1) == folds.index(0) + 1
    # All of it lies before the robot: 9 + 6 + 9 s at least, and no driving.
    assert answer.cost_s == pytest.approx(24.0, abs=0.5)


def test_the_grips_of_a_drag_serve_the_blue_fold_and_then_its_red_one() -> None:
    problem = context(towel(OVER, BACK))
    drag = next(s for s in GDrag(problem).successors(START) if s.after.held and s.distance_m == 0.1)
    over = step_of(problem, drag.after)
    back = step_of(problem, over.after)
    assert (over.duration_s, back.duration_s) == (6.0, 6.0)
    assert over.after.held and not over.after.is_dragged
