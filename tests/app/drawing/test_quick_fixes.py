"""Quick fixes of a drawing that cannot be planned: each one that is offered removes the problem."""

import math
from dataclasses import replace

import pytest

from app.drawing.draft import Draft, draft_of
from app.drawing.drawing import Corner, CornerTie, Crease, Drawing
from app.drawing.edit import Edit
from app.drawing.garment_drawing import drawing_of
from app.drawing.quick_fixes import QUICK_FIXES_MAX, QuickFix, quick_fixes
from app.drawing.solve import solve
from planner import load_garment
from tests.app.drawing.drawings import crease, outlined, tied, towel_drawing, with_corner

HALF = crease("half", (0.4, 0.15), (0.0, 0.15))
ACROSS = crease("across", (0.2, 0.15), (0.2, 0.3))


def offered(drawing: Drawing) -> tuple[QuickFix, ...]:
    return quick_fixes(draft_of(drawing))


def labels(drawing: Drawing) -> list[str]:
    return [quick_fix.label for quick_fix in offered(drawing)]


def red(fold: Crease) -> Crease:
    return replace(fold, kind="red")


def test_nothing_is_offered_where_nothing_is_wrong() -> None:
    assert offered(towel_drawing()) == ()


def test_a_red_fold_that_is_the_first_is_made_blue() -> None:
    first, *_ = offered(towel_drawing(red(HALF)))
    assert first.label == "Make fold 0 'half' blue"
    assert solve(first.drawing).problems == ()
    assert first.drawing.folds[0].kind == "blue"


def test_a_red_fold_that_misses_the_flap_is_made_blue() -> None:
    """Of the flap, the right near corner folded in, nothing is near the line across the left far corner."""
    corner = crease("corner", (0.3, 0.0), (0.4, 0.1))
    drawing = towel_drawing(
        replace(corner, start=corner.end, end=corner.start), red(crease("miss", (0, 0.2), (0.2, 0.3)))
    )
    assert "not the flap of 'corner'" in solve(drawing).problems[0].message
    assert labels(drawing) == ["Make fold 1 'miss' blue", "Delete fold 1 'miss'"]
    assert all(solve(quick_fix.drawing).problems == () for quick_fix in offered(drawing))


def test_a_fold_that_ends_in_the_cloth_is_put_onto_its_edge_along_its_line() -> None:
    first, *_, last = offered(towel_drawing(crease("half", (0.3, 0.15), (0.0, 0.15))))
    assert first.label == "Put fold 0 'half' onto the cloth"
    assert first.drawing.folds[0].start.point == pytest.approx((0.4, 0.15))
    assert first.drawing.folds[0].end.point == pytest.approx((0.0, 0.15))
    assert last.label == "Delete fold 0 'half'"


def test_a_fold_beside_the_cloth_can_only_be_deleted() -> None:
    drawing = towel_drawing(crease("beside", (0.7, 0.0), (0.7, 0.3)), ACROSS)
    assert labels(drawing) == ["Delete fold 0 'beside'"]


def test_of_two_folds_that_both_miss_the_cloth_one_after_the_other_is_mended() -> None:
    beside, ends_inside = crease("beside", (0.7, 0.0), (0.7, 0.3)), crease("half", (0.3, 0.15), (0.0, 0.15))
    (first,) = offered(towel_drawing(beside, ends_inside))
    assert [problem.fold for problem in solve(first.drawing).problems] == [0]
    second, *_ = offered(first.drawing)
    assert second.label == "Put fold 0 'half' onto the cloth"
    assert solve(second.drawing).problems == ()


def test_a_fold_without_length_can_be_deleted_and_its_twin_is_left_alone() -> None:
    nothing = replace(crease("nothing", (0.2, 0.15), (0.2, 0.15)), twin="half")
    (quick_fix,) = offered(towel_drawing(nothing, replace(HALF, twin="nothing")))
    assert [(fold.id, fold.twin) for fold in quick_fix.drawing.folds] == [("half", None)]


def test_what_leaves_nothing_wrong_comes_before_what_uncovers_the_next_problem() -> None:
    """Without the first fold the second, which is red, would be the first: that is wrong in another way."""
    first = crease("first", (0.3, 0.15), (0.0, 0.15))
    drawing = towel_drawing(first, red(crease("second", (0.0, 0.25), (0.4, 0.25))))
    wrong = [bool(solve(quick_fix.drawing).problems) for quick_fix in offered(drawing)]
    assert wrong == sorted(wrong)
    assert not wrong[0]


def test_corners_that_were_dragged_past_each_other_are_exchanged() -> None:
    """The near corners of a towel have changed places: its sides cross in the middle."""
    drawing = towel_drawing()
    points = drawing.points
    crossed = with_corner(with_corner(drawing, 0, points[1]), 1, points[0])
    first, *_ = offered(crossed)
    assert first.label == "Exchange the two corners"
    assert solve(first.drawing).problems == ()
    assert sorted(first.drawing.points) == sorted(points)


def test_a_corner_dragged_across_the_garment_may_be_left_out() -> None:
    shirt = drawing_of(load_garment("t-shirt"))
    x, y = shirt.outline[1].point
    crossed = with_corner(shirt, 1, (x, y + 0.9))
    for quick_fix in offered(crossed):
        assert "outline" not in {problem.field.partition("[")[0] for problem in solve(quick_fix.drawing).problems}
    assert "Delete one corner" in labels(crossed)


def test_many_crossings_are_all_uncrossed() -> None:
    """A star of seven points, drawn in one stroke with every third corner next."""
    star = [(math.cos(2 * math.pi * 3 * k / 7), math.sin(2 * math.pi * 3 * k / 7)) for k in range(7)]
    drawing = replace(outlined(towel_drawing(), *star), folds=())
    (quick_fix,) = offered(drawing)
    assert quick_fix.label == "Uncross the edges"
    assert solve(quick_fix.drawing).problems == ()


def test_two_corners_in_one_place_are_merged_and_what_was_tied_to_one_stays_tied() -> None:
    drawing = towel_drawing(crease("corner", tied((0.2, 0.0), CornerTie("new")), (0.4, 0.1)))
    first, *others = drawing.outline
    twice = (first, Corner("old", (0.2, 0.0)), Corner("new", (0.2004, 0.0)), *others)
    (quick_fix,) = offered(replace(drawing, outline=twice))
    assert quick_fix.label == "Merge the two corners"
    assert solve(quick_fix.drawing).problems == ()
    assert [corner.id for corner in quick_fix.drawing.outline][:2] == [first.id, "old"]
    assert quick_fix.drawing.folds[0].start.tie == CornerTie("old")


def test_all_corners_that_are_too_near_are_merged_at_once_round_the_start_too() -> None:
    points = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.0005), (0.4, 0.3), (0.0, 0.3), (0.0, 0.0004)]
    (quick_fix,) = offered(replace(outlined(towel_drawing(), *points), folds=()))
    assert quick_fix.label == "Merge corners nearer than 1 mm"
    assert quick_fix.drawing.points == (points[0], points[1], points[3], points[4])


def test_an_unknown_station_is_replaced_by_the_first() -> None:
    (quick_fix,) = offered(replace(towel_drawing(), start_station="nowhere"))
    assert quick_fix.label == "Start at front"
    assert solve(quick_fix.drawing).problems == ()


def test_where_nothing_else_helps_the_last_step_is_taken_back() -> None:
    before = replace(towel_drawing(), folds=())
    tiny = outlined(before, (0.0, 0.0), (0.005, 0.0), (0.0, 0.005))
    draft = draft_of(before).edited(Edit("Scale", tiny), 0.0)
    assert draft.solution.problems[0].code == "outline_too_small"
    (quick_fix,) = quick_fixes(draft)
    assert quick_fix.label == "Take back \N{LEFT DOUBLE QUOTATION MARK}Scale\N{RIGHT DOUBLE QUOTATION MARK}"
    assert quick_fix.drawing == before
    assert quick_fixes(Draft(draft.solution)) == ()


def test_there_are_few_enough_to_be_read() -> None:
    off = crease("off", (0.3, 0.15), (0.0, 0.15))
    assert len(offered(towel_drawing(off))) <= QUICK_FIXES_MAX
