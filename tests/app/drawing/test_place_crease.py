"""Folds by grab and drop, and along a line, on a towel of 0.4 x 0.3 m."""

import pytest

from app.drawing.drawing import CornerTie, CreaseTie, EdgeTie
from app.drawing.place_crease import PlacedCrease, along_line, grab_and_drop
from app.drawing.solution import Solution
from app.drawing.solve import solve
from planner.errors import RequestError
from planner.geometry.pose import Point2
from planner.geometry.segment import Segment
from tests.app.drawing.drawings import about, crease, outlined, towel_drawing

TOWEL = solve(towel_drawing(folds=[]))
CUFF = crease("cuff", (0.3, 0.3), (0.3, 0.0))
MISSED = "the line crosses the cloth, but not the flap of 'cuff', which is all that a red fold takes"
HALVED = solve(towel_drawing(crease("half", (0.4, 0.15), (0.0, 0.15))))
# A body 0.2 m wide and two sleeves of 0.1 x 0.1 m.
SHIRT = solve(
    outlined(
        towel_drawing(folds=[]),
        *((0.0, 0.0), (0.2, 0.0), (0.2, 0.3), (0.3, 0.3), (0.3, 0.4), (-0.1, 0.4), (-0.1, 0.3), (0.0, 0.3)),
    )
)


def near(*point: float) -> object:
    return pytest.approx(point, abs=1e-9)


def ends(placed: PlacedCrease) -> tuple[Point2, Point2]:
    return placed.start.point, placed.end.point


def landed(placed: PlacedCrease) -> list[tuple[float, ...]]:
    return sorted(tuple(point) for point in placed.to_dict()["landed"][0])


def test_a_corner_dropped_on_another_halves_the_towel_and_its_side_moves() -> None:
    """The near left corner onto the far left one: over y = 0.15, the near half on the left of the line."""
    placed = grab_and_drop(TOWEL, None, (0.0, 0.0), (0.0, 0.3), "blue")
    assert ends(placed) == (near(0.4, 0.15), near(0.0, 0.15))
    assert placed.start.tie == EdgeTie("v1", "v2", about(0.5))
    assert landed(placed) == [near(0.0, 0.15), near(0.0, 0.3), near(0.4, 0.15), near(0.4, 0.3)]


def test_the_other_way_round_the_other_half_moves() -> None:
    placed = grab_and_drop(TOWEL, None, (0.0, 0.3), (0.0, 0.0), "blue")
    assert ends(placed) == (near(0.0, 0.15), near(0.4, 0.15))


def test_a_diagonal_ends_at_corners() -> None:
    """In the square of 0.3 m at the left, (0, 0) onto (0.3, 0.3) is over the line from (0.3, 0) to (0, 0.3)."""
    placed = grab_and_drop(TOWEL, None, (0.0, 0.0), (0.3, 0.3), "blue")
    assert ends(placed) == (near(0.3, 0.0), near(0.0, 0.3))
    assert placed.end.tie == CornerTie("v3")


def test_a_sleeve_is_folded_alone_though_the_line_crosses_more() -> None:
    """The left cuff 0.1 m to the right: over x = -0.05 through the sleeve alone. 0.3 m to the right: over x = 0.05."""
    cuff = grab_and_drop(SHIRT, None, (-0.1, 0.35), (0.0, 0.35), "blue")
    assert ends(cuff) == (near(-0.05, 0.3), near(-0.05, 0.4))
    side = grab_and_drop(SHIRT, None, (-0.1, 0.35), (0.2, 0.35), "blue")
    assert ends(side) == (near(0.05, 0.0), near(0.05, 0.4))


def test_of_several_chords_the_one_that_has_the_point_behind_it_is_taken() -> None:
    """Both sleeves hang down to y = 0.3; the tip of the right one, 0.02 m up, is over y = 0.31 through that sleeve."""
    hanging = solve(
        outlined(
            towel_drawing(folds=[]),
            *((0.0, 0.2), (0.1, 0.2), (0.1, 0.4), (0.2, 0.4), (0.2, 0.2), (0.3, 0.2), (0.3, 0.5), (0.0, 0.5)),
        )
    )
    placed = grab_and_drop(hanging, None, (0.25, 0.2), (0.25, 0.24), "blue")
    assert ends(placed) == (near(0.3, 0.22), near(0.2, 0.22))


def test_it_is_asked_of_the_cloth_as_it_is_after_some_folds() -> None:
    """After the half the towel is 0.15 m high: its left side onto its right is over x = 0.2 from crease to edge."""
    placed = grab_and_drop(HALVED, 1, (0.0, 0.2), (0.4, 0.2), "blue")
    assert ends(placed) == (near(0.2, 0.15), near(0.2, 0.3))
    assert placed.start.tie == CreaseTie("half", about(0.5))
    before = grab_and_drop(HALVED, 0, (0.0, 0.2), (0.4, 0.2), "blue")
    assert ends(before) == (near(0.2, 0.0), near(0.2, 0.3))


def test_a_red_fold_takes_the_flap_alone() -> None:
    placed = grab_and_drop(HALVED, None, (0.2, 0.3), (0.2, 0.2), "red")
    assert ends(placed) == (near(0.0, 0.25), near(0.4, 0.25))
    assert len(placed.folded.layers) == 1


@pytest.mark.parametrize(
    ("solution", "after", "grabbed", "dropped", "kind", "field"),
    [
        (TOWEL, None, (0.2, 0.2), (0.2, 0.2), "blue", "grab.to"),
        (TOWEL, None, (0.5, 0.2), (0.2, 0.2), "blue", "grab.from"),
        (TOWEL, None, (0.2, 0.2), (3.0, 0.2), "blue", "grab.to"),
        (TOWEL, 1, (0.0, 0.0), (0.0, 0.3), "blue", "after"),
        (TOWEL, None, (0.0, 0.0), (0.0, 0.3), "red", "kind"),
        (HALVED, 1, (0.2, 0.2), (0.2, 0.3), "red", "grab.to"),
        (solve(outlined(towel_drawing())), None, (0.0, 0.0), (0.0, 0.3), "blue", "after"),
    ],
)
def test_why_there_is_no_such_fold(
    solution: Solution, after: int | None, grabbed: Point2, dropped: Point2, kind: str, field: str
) -> None:
    with pytest.raises(RequestError) as refused:
        grab_and_drop(solution, after, grabbed, dropped, kind)
    assert refused.value.field == field


def test_a_line_drawn_short_or_long_ends_on_the_boundary() -> None:
    for start, end in (((0.2, 0.1), (0.2, 0.2)), ((0.2, -1.0), (0.2, 1.0))):
        placed = along_line(TOWEL, None, Segment(start, end), "blue")
        assert ends(placed) == (near(0.2, 0.0), near(0.2, 0.3))


def test_a_line_beside_the_cloth_is_no_fold() -> None:
    with pytest.raises(RequestError) as refused:
        along_line(TOWEL, None, Segment((0.0, 0.4), (0.4, 0.4)), "blue")
    assert refused.value.field == "line"


def test_a_red_line_that_misses_the_flap_is_told_so_by_the_flaps_name() -> None:
    """The last 0.1 m of the towel have gone over x = 0.3 and cover 0.2 to 0.3; x = 0.1 is cloth that lies still."""
    cuffed = solve(towel_drawing(CUFF))
    with pytest.raises(RequestError) as refused:
        along_line(cuffed, None, Segment((0.1, 0.0), (0.1, 0.3)), "red")
    assert (refused.value.field, refused.value.message) == ("line", MISSED)
    with pytest.raises(RequestError) as grabbed:
        grab_and_drop(cuffed, None, (0.1, 0.1), (0.2, 0.1), "red")
    assert grabbed.value.field == "grab.from"
    assert "on cloth that a red fold leaves where it is" in grabbed.value.message
    with pytest.raises(RequestError) as beside:
        along_line(cuffed, None, Segment((0.5, 0.0), (0.5, 0.3)), "red")
    assert beside.value.message == "does not cross the cloth"


def test_a_red_fold_drawn_beside_the_flap_is_a_problem_that_says_so() -> None:
    solution = solve(towel_drawing(CUFF, crease("over", (0.1, 0.0), (0.1, 0.3), "red")))
    (problem,) = solution.problems
    assert (problem.fold, problem.message) == (1, MISSED)


def test_a_line_drawn_beside_an_edge_turns_all_of_the_cloth_about_it() -> None:
    placed = along_line(TOWEL, None, Segment((0.3, -0.02), (0.1, 0.01)), "turn")
    # The near edge, its corners tied, and the cloth to its left, whichever way the line was drawn.
    assert (placed.line.start, placed.line.end) == ((0.0, 0.0), (0.4, 0.0))
    assert [end.tie for end in (placed.start, placed.end)] == [CornerTie("v0"), CornerTie("v1")]
    assert landed(placed) == [near(0.0, -0.3), near(0.0, 0.0), near(0.4, -0.3), near(0.4, 0.0)]


def test_cloth_dropped_beyond_its_edge_is_turned_about_that_edge() -> None:
    placed = grab_and_drop(TOWEL, None, (0.2, 0.28), (0.2, -0.28), "turn")
    assert (placed.line.start, placed.line.end) == ((0.0, 0.0), (0.4, 0.0))
