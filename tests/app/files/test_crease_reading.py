"""Fold lines as people draw them: beyond the outline, a little short of it, or all on the flat cloth."""

import pytest

from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from app.files.crease_reading import ReadCreases, read_creases
from app.files.import_file import import_file
from planner.cloth.garment import DrawnFold
from planner.geometry.pose import Point2

TOWEL: list[Point2] = [(0.0, 0.0), (0.6, 0.0), (0.6, 0.4), (0.0, 0.4)]
HALVED = ("blue", (0.3, 0.0), (0.3, 0.4))
"""A fold by which the left half moves, so that the cloth lies from x = 0.3 to 0.6."""


def drawn(*lines: tuple[str, Point2, Point2]) -> list[DrawnFold]:
    return [DrawnFold(f"fold {number + 1}", *line) for number, line in enumerate(lines)]


def ends(read: ReadCreases) -> list[tuple[Point2, Point2]]:
    def rounded(point: Point2) -> Point2:
        return (round(point[0], 4), round(point[1], 4))

    return [(rounded(fold.start), rounded(fold.end)) for fold in read.folds]


def test_lines_that_overhang_the_outline_are_cut_to_it_all_of_them_and_by_how_much_is_told() -> None:
    lines = drawn(("blue", (0.3, -0.015), (0.3, 0.42)), ("blue", (0.28, 0.2), (0.61, 0.2)))
    read = read_creases(TOWEL, lines, "folded")
    assert ends(read) == [((0.3, 0.0), (0.3, 0.4)), ((0.3, 0.2), (0.6, 0.2))]
    assert (read.legal, read.problem) == (2, None)
    assert read.cut_m == pytest.approx({0: 0.02, 1: 0.02})


def test_an_oblique_line_that_overhangs_keeps_its_direction() -> None:
    # Through (0.1, 0.1) at 45 degrees, 1 cm too long at each end: it meets the left edge at the corner (0, 0).
    read = read_creases(TOWEL, drawn(("blue", (0.19, -0.01), (0.61, 0.41))), "folded")
    assert ends(read) == [((0.2, 0.0), (0.6, 0.4))]


def test_lines_that_nearly_reach_the_edge_are_drawn_on_to_it() -> None:
    read = read_creases(TOWEL, drawn(("blue", (0.3, 0.012), (0.3, 0.39))), "folded")
    assert ends(read) == [((0.3, 0.0), (0.3, 0.4))]
    assert read.cut_m == pytest.approx({0: 0.012})


def test_a_line_that_is_good_stays_as_it_is_drawn_to_the_last_digit() -> None:
    lines = drawn(("blue", (0.3, 0.001), (0.3, 0.4)))
    assert read_creases(TOWEL, lines, "folded").folds == tuple(lines)


def test_a_line_that_ends_in_the_middle_of_the_cloth_is_left_alone_and_said_to_be_wrong() -> None:
    lines = drawn(("blue", (0.3, 0.0), (0.3, 0.2)), HALVED)
    read = read_creases(TOWEL, lines, "folded")
    assert read.folds == tuple(lines)
    assert read.legal == 0
    assert read.problem is not None
    assert "from the silhouette's boundary" in read.problem.text


def test_a_line_over_the_whole_flat_cloth_is_too_long_for_the_folded_and_right_on_the_flat() -> None:
    lines = drawn(HALVED, ("blue", (0.0, 0.1), (0.6, 0.1)))
    assert read_creases(TOWEL, lines, "folded").legal == 1
    flat = read_creases(TOWEL, lines, "flat")
    assert (flat.legal, ends(flat)[1]) == (2, ((0.3, 0.1), (0.6, 0.1)))


def test_a_line_on_the_part_that_has_moved_goes_with_it_and_the_same_part_of_it_moves() -> None:
    # On the flat cloth x = 0.1 comes to lie at 0.5. What is left of the line as drawn, upwards, is x < 0.1: it comes to
    # lie beyond 0.5, which is left of the line downwards.
    flat = read_creases(TOWEL, drawn(HALVED, ("blue", (0.1, 0.0), (0.1, 0.4))), "flat")
    assert (flat.legal, ends(flat)[1]) == (2, ((0.5, 0.4), (0.5, 0.0)))


def test_lines_are_carried_through_all_folds_before_them() -> None:
    # y = 0.35 comes to lie at 0.05 when the upper half is folded down, wherever the first fold has carried it.
    lines = drawn(HALVED, ("blue", (0.6, 0.2), (0.0, 0.2)), ("blue", (0.0, 0.35), (0.6, 0.35)))
    lines[1] = DrawnFold("down", "blue", (0.0, 0.2), (0.6, 0.2))
    flat = read_creases(TOWEL, lines, "flat")
    # The upper half moves first, then what was above 0.35 and now lies below 0.05.
    assert (flat.legal, ends(flat)[1:]) == (3, [((0.3, 0.2), (0.6, 0.2)), ((0.6, 0.05), (0.3, 0.05))])


def test_a_red_line_is_carried_with_the_flap() -> None:
    flat = read_creases(TOWEL, drawn(HALVED, ("red", (0.1, 0.0), (0.1, 0.4))), "flat")
    assert (flat.legal, ends(flat)[1]) == (2, ((0.5, 0.4), (0.5, 0.0)))


@pytest.mark.parametrize("creases", ["folded", "flat"])
def test_lines_in_a_row_overhang_on_either_cloth(creases: str) -> None:
    lines = drawn(*(("blue", (0.1 * n, -0.02), (0.1 * n, 0.415)) for n in range(1, 6)))
    read = read_creases(TOWEL, lines, "flat" if creases == "flat" else "folded")
    assert read.legal == 5
    assert set(read.cut_m) == {0, 1, 2, 3, 4}


SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="60cm" height="40cm" viewBox="0 0 60 40">'
    '<rect width="60" height="40"/>{}</svg>'
)
BLUE = '<line x1="{}" y1="{}" x2="{}" y2="{}" stroke="blue"/>'


def test_an_import_takes_the_cloth_on_which_more_lines_fit_and_says_so() -> None:
    data = SVG.format(BLUE.format(30, 40, 30, 0) + BLUE.format(0, 30, 60, 30)).encode()
    found = import_file("towel.svg", data)
    assert found.creases == "flat"
    assert any("read on the flat cloth" in note.text and "1 of 2" in note.text for note in found.notes)
    assert solve(drawing_of(found.garment)).problems == ()
    other = import_file("towel.svg", data, creases="folded")
    assert other.creases == "folded"
    assert any("'fold 2' does not fit" in note.text for note in other.notes)
    assert solve(drawing_of(other.garment)).problems[0].fold == 1


def test_an_import_says_nothing_of_creases_that_mean_the_same_on_both() -> None:
    data = SVG.format(BLUE.format(30, 41.5, 30, -1)).encode()
    found = import_file("towel.svg", data)
    assert found.creases is None
    assert any("'fold 1' by 15 mm" in note.text for note in found.notes)
    assert solve(drawing_of(found.garment)).problems == ()
