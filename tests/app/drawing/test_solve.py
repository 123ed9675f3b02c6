"""The position of folds on a towel of 0.4 x 0.3 m; nothing drawn is lost."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from app.drawing.drawing import ChordTie, Corner, CornerTie, CreaseTie, Drawing, EdgeTie, End
from app.drawing.garment_drawing import drawing_of
from app.drawing.solution import Solution
from app.drawing.solve import solve
from planner import load_garment
from planner.geometry.pose import Point2
from tests.app.drawing.drawings import about, crease, outlined, pulled, tied, towel_drawing, with_corner

HALF = crease("half", (0.4, 0.15), (0.0, 0.15))
ACROSS = crease("across", (0.2, 0.15), (0.2, 0.3))


def near(*point: float) -> object:
    return pytest.approx(point, abs=1e-9)


def ends(solution: Solution, fold: int) -> tuple[object, object]:
    drawn = solution.drawing.folds[fold]
    return drawn.start.point, drawn.end.point


def test_ends_just_drawn_are_tied_to_what_is_there() -> None:
    solution = solve(towel_drawing(HALF, ACROSS))
    assert solution.problems == ()
    half, across = solution.drawing.folds
    assert half.start.tie == EdgeTie("v1", "v2", about(0.5))
    assert half.end.tie == EdgeTie("v3", "v0", about(0.5))
    assert across.start.tie == CreaseTie("half", about(0.5))
    assert across.end.tie == EdgeTie("v2", "v3", about(0.5))


def test_an_end_within_five_millimetres_is_put_onto_the_boundary() -> None:
    solution = solve(towel_drawing(crease("half", (0.396, 0.15), (0.0, 0.15))))
    assert ends(solution, 0) == (near(0.4, 0.15), near(0.0, 0.15))


def test_ends_follow_the_corners_that_are_pulled() -> None:
    """The right side runs from (0.4, -0.1) to (0.4, 0.3): its half is at y = 0.1."""
    drawn = solve(towel_drawing(HALF, ACROSS)).drawing
    solution = solve(pulled(drawn, 1, 0.0, -0.1))
    assert ends(solution, 0) == (near(0.4, 0.1), near(0.0, 0.15))
    assert ends(solution, 1)[0] == near(0.2, 0.125)


def test_an_end_under_cloth_slides_along_the_line_to_its_edge() -> None:
    """The near right corner, pulled 2 cm down, lands 2 cm beyond the far edge; at x = 0.2 cloth ends 1 cm beyond."""
    drawn = towel_drawing(crease("half", tied((0.4, 0.15), ChordTie()), tied((0.0, 0.15), ChordTie())), ACROSS)
    solution = solve(pulled(solve(drawn).drawing, 1, 0.0, -0.02))
    assert ends(solution, 0) == (near(0.4, 0.15), near(0.0, 0.15))
    assert ends(solution, 1) == (near(0.2, 0.15), near(0.2, 0.31))
    assert solution.drawing.folds[1].end.tie == EdgeTie("v2", "v3", about(0.5))


def test_an_end_that_slid_comes_back_with_the_corner() -> None:
    drawn = solve(towel_drawing(HALF, ACROSS)).drawing
    there = solve(pulled(drawn, 1, 0.0, -0.02)).drawing
    back = solve(with_corner(there, 1, drawn.outline[1].point)).drawing
    assert [fold.start.tie for fold in back.folds] == [fold.start.tie for fold in drawn.folds]
    assert ends(solve(back), 1) == (near(0.2, 0.15), near(0.2, 0.3))


def test_a_corner_put_into_an_edge_moves_no_fold() -> None:
    drawn = solve(towel_drawing(HALF)).drawing
    more = (*drawn.outline[:2], Corner("new", (0.4, 0.06)), *drawn.outline[2:])
    solution = solve(replace(drawn, outline=more))
    assert ends(solution, 0) == (near(0.4, 0.15), near(0.0, 0.15))
    assert solution.drawing.folds[0].start.tie == EdgeTie("new", "v2", about((0.15 - 0.06) / 0.24))


def test_when_a_corner_goes_the_line_is_kept_and_finds_new_ends() -> None:
    """A diagonal between corners 1 and 3; without corner 1 it ends on the new edge from (0, 0) to (0.4, 0.3)."""
    diagonal = crease("diagonal", tied((0.0, 0.3), CornerTie("v3")), tied((0.4, 0.0), CornerTie("v1")))
    solution = solve(towel_drawing(diagonal))
    assert solution.problems == ()
    rest = tuple(corner for corner in solution.drawing.outline if corner.id != "v1")
    without = solve(replace(solution.drawing, outline=rest))
    assert without.problems == ()
    assert ends(without, 0) == (near(0.0, 0.3), near(0.2, 0.15))
    assert without.drawing.folds[0].end.tie == EdgeTie("v0", "v2", about(0.5))


def test_when_a_fold_goes_what_was_tied_to_its_crease_finds_the_cloth_again() -> None:
    drawn = solve(towel_drawing(HALF, ACROSS)).drawing
    solution = solve(replace(drawn, folds=drawn.folds[1:]))
    assert solution.problems == ()
    assert ends(solution, 0) == (near(0.2, 0.0), near(0.2, 0.3))
    assert solution.drawing.folds[0].start.tie == EdgeTie("v0", "v1", about(0.5))


def test_an_end_off_the_cloth_is_kept_and_told_of_where_it_is() -> None:
    off = crease("off", (0.2, 0.1), (0.0, 0.15))
    solution = solve(towel_drawing(off))
    assert solution.drawing.folds == (off,)
    assert solution.garment is None
    (problem,) = solution.problems
    assert (problem.code, problem.field, problem.fold) == ("fold_off_boundary", "folds[0].start", 0)
    assert problem.points == ((0.2, 0.1),)
    assert "100.0 mm" in problem.message


def test_folds_after_an_illegal_one_are_kept_and_not_looked_at() -> None:
    off = crease("off", (0.2, 0.1), (0.0, 0.15))
    solution = solve(towel_drawing(HALF, off, ACROSS))
    assert [state["status"] for state in solution.fold_states()] == ["legal", "illegal", "unchecked"]
    assert solution.drawing.folds[1:] == (off, ACROSS)
    assert len(solution.steps) == 2


def test_a_fold_that_comes_back_onto_the_cloth_is_legal_again() -> None:
    drawn = solve(towel_drawing(HALF)).drawing
    crossing = outlined(drawn, (0.0, 0.0), (0.4, 0.3), (0.4, 0.0), (0.0, 0.3))
    lost = solve(crossing)
    assert lost.problems and lost.spread is None
    assert solve(replace(lost.drawing, outline=drawn.outline)).drawing == drawn


@pytest.mark.parametrize(
    ("points", "code", "field"),
    [
        ((), "outline_unfinished", "outline"),
        (((0.0, 0.0), (0.4, 0.0)), "outline_unfinished", "outline"),
        (((0.0, 0.0), (0.4, 0.3), (0.4, 0.0), (0.0, 0.3)), "outline_crosses", "outline[2]"),
        (((0.0, 0.0), (0.4, 0.0), (0.4, 0.0005), (0.0, 0.3)), "edge_too_short", "outline[2]"),
        (((0.0, 0.0), (0.4, 0.0), (0.2, 0.0), (0.2, 0.3)), "outline_crosses", "outline[1]"),
        (((0.0, 0.0), (0.01, 0.0), (0.01, 0.01)), "outline_too_small", "outline"),
    ],
)
def test_an_outline_that_is_none_is_kept_and_told_of(points: tuple[Point2, ...], code: str, field: str) -> None:
    solution = solve(outlined(towel_drawing(HALF), *points))
    assert solution.drawing.points == points
    assert (solution.problems[0].code, solution.problems[0].field) == (code, field)
    assert solution.garment is None
    assert solution.steps == []


def test_a_crossing_is_told_where_it_is() -> None:
    """The diagonals of a rectangle of 0.4 x 0.3 m meet in its middle."""
    solution = solve(outlined(towel_drawing(), (0.0, 0.0), (0.4, 0.3), (0.4, 0.0), (0.0, 0.3)))
    (problem,) = solution.problems
    assert problem.points == (near(0.2, 0.15),)
    assert {problem.lines[0].start, problem.lines[0].end} == {(0.0, 0.0), (0.4, 0.3)}


def test_every_crossing_is_told_of() -> None:
    """A zigzag of three strokes across one long edge crosses it twice in all."""
    zigzag = ((0.0, 0.0), (0.4, 0.0), (0.3, 0.1), (0.3, -0.1), (0.2, -0.1), (0.2, 0.1), (0.0, 0.1))
    solution = solve(outlined(towel_drawing(), *zigzag))
    assert [problem.points for problem in solution.problems] == [(near(0.3, 0.0),), (near(0.2, 0.0),)]


def test_the_first_fold_cannot_be_red() -> None:
    (problem,) = solve(towel_drawing(replace(HALF, kind="red"))).problems
    assert problem.field == "folds[0].kind"


def test_a_station_that_is_not_there_is_told_of() -> None:
    (problem,) = solve(replace(towel_drawing(), start_station="nowhere")).problems
    assert problem.field == "start_station"
    assert "front" in problem.message


def test_steps_tell_what_moves_and_where_it_lands() -> None:
    step, after = solve(towel_drawing(HALF)).steps
    assert sorted(map(tuple, step["moving"][0])) == [near(0.0, 0.0), near(0.0, 0.15), near(0.4, 0.0), near(0.4, 0.15)]
    assert sorted(map(tuple, step["landed"][0])) == [near(0.0, 0.15), near(0.0, 0.3), near(0.4, 0.15), near(0.4, 0.3)]
    assert sorted(map(tuple, after["silhouette"][0])) == sorted(map(tuple, step["landed"][0]))
    assert after["moving"] is None
    assert step["flap"] == [] and after["flap"] != []


def test_a_red_fold_sees_the_flap_alone() -> None:
    red = crease("back", End((0.0, 0.25)), End((0.4, 0.25)), kind="red")
    solution = solve(towel_drawing(HALF, red))
    assert solution.problems == ()
    assert solution.drawing.folds[1].start.tie == EdgeTie("v3", "v0", about(0.25 / 0.3))


def reordered(drawing: Drawing, index: int, to: int) -> Drawing:
    """Return the drawing with one fold made at another time."""
    folds = list(drawing.folds)
    folds.insert(to, folds.pop(index))
    return replace(drawing, folds=tuple(folds))


@pytest.mark.parametrize("name", ["t-shirt", "shirt", "skirt", "vest", "jeans", "big-towel"])
def test_folds_may_be_made_in_any_order(name: str) -> None:
    drawing = solve(drawing_of(load_garment(name))).drawing
    for index, to in permutations(range(len(drawing.folds)), 2):
        assert solve(reordered(drawing, index, to)).problems == ()


def test_a_fold_whose_ends_have_come_together_keeps_its_line_and_gets_it_back() -> None:
    drawing = solve(drawing_of(load_garment("t-shirt"))).drawing
    later = solve(reordered(drawing, 2, 4)).drawing
    # The bottom goes up over y = 0.305, and with it the lower half of the line x = 0.1.
    np.testing.assert_allclose([end.point for end in later.folds[4].ends], [(0.1, 0.305), (0.1, 0.61)], atol=1e-6)
    again = solve(reordered(later, 4, 2)).drawing
    np.testing.assert_allclose(
        [end.point for end in again.folds[2].ends], [end.point for end in drawing.folds[2].ends], atol=1e-6
    )
