from dataclasses import replace

import pytest

from app.drawing.blank import blank_drawing
from app.drawing.drawing import CornerTie
from app.drawing.edit import Edit
from app.ui.editor.mode import FoldKind, Mode
from tests.app.drawing.drawings import crease, pulled, towel_drawing
from tests.app.editor.hand import PIXEL_M, at, drag, editing

PLAIN = replace(towel_drawing(), folds=())
# The plain towel covers -0.7 <= x <= -0.4, -0.2 <= y <= 0.2 of the table; article (x, y) is table (y - 0.7, 0.2 - x).


def test_a_drag_from_edge_to_edge_is_a_fold() -> None:
    document, editor = editing(PLAIN, Mode.DRAW_FOLD)
    drag(editor, (-0.55, 0.2), (-0.55, -0.2))
    (fold,) = document.state.drawing.folds
    assert fold.start.point == pytest.approx((0.0, 0.15))
    assert fold.end.point == pytest.approx((0.4, 0.15))
    assert (fold.kind, fold.name) == ("blue", "top down")  # what is left of it is further in the article's y: the top
    assert document.state.solution.problems == ()
    assert [step.label for step in document.state.draft.history.past] == ["Draw fold"]


def test_a_second_fold_like_one_before_is_called_otherwise() -> None:
    document, editor = editing(PLAIN, Mode.DRAW_FOLD)
    for x in (-0.45, -0.55, -0.62):
        drag(editor, (x, 0.2), (x, -0.2))
    assert [fold.name for fold in document.state.drawing.folds] == ["top down", "top down 2", "top down 3"]


def test_the_other_way_round_the_other_side_moves() -> None:
    document, editor = editing(PLAIN, Mode.DRAW_FOLD)
    drag(editor, (-0.55, -0.2), (-0.55, 0.2))
    assert document.state.drawing.folds[0].name == "bottom up"
    assert document.state.solution.folded[0].moving.bounds == pytest.approx((0.0, 0.0, 0.4, 0.15))


def test_an_end_near_a_corner_is_tied_to_it() -> None:
    document, editor = editing(PLAIN, Mode.DRAW_FOLD)
    drag(editor, (-0.7 + 9 * PIXEL_M, 0.2), (-0.4, -0.2 - 9 * PIXEL_M))
    (fold,) = document.state.drawing.folds
    assert (fold.start.tie, fold.end.tie) == (CornerTie("v0"), CornerTie("v2"))


def test_an_end_near_the_edge_is_put_onto_it() -> None:
    document, editor = editing(PLAIN, Mode.DRAW_FOLD)
    drag(editor, (-0.6, 0.2 + 7 * PIXEL_M), (-0.5, -0.2 + 7 * PIXEL_M))
    (fold,) = document.state.drawing.folds
    assert fold.start.point == pytest.approx((0.0, 0.1))
    assert fold.end.point == pytest.approx((0.4, 0.2))


def test_ends_well_off_the_cloth_slide_along_the_line() -> None:
    document, editor = editing(PLAIN, Mode.DRAW_FOLD)
    drag(editor, (-0.55, 0.4), (-0.55, -0.4))
    (fold,) = document.state.drawing.folds
    assert fold.start.point == pytest.approx((0.0, 0.15))
    assert fold.end.point == pytest.approx((0.4, 0.15))


def test_two_clicks_are_a_fold_too() -> None:
    document, editor = editing(PLAIN, Mode.DRAW_FOLD)
    editor.tap(at((-0.55, 0.2)))
    editor.tap(at((-0.55, -0.2)))
    assert len(document.state.drawing.folds) == 1


def test_the_ghost_shows_the_line_and_where_the_cloth_will_lie() -> None:
    document, editor = editing(PLAIN, Mode.DRAW_FOLD)
    editor.press(at((-0.5, 0.2)))
    editor.drag(at((-0.5, -0.2)))
    ghost = editor.aids.ghost
    assert ghost is not None
    assert (ghost.line.start, ghost.line.end) == (pytest.approx((-0.5, 0.2)), pytest.approx((-0.5, -0.2)))
    # The far 0.1 m come to lie on the 0.1 m before the line.
    (ring,) = ghost.landed
    assert sorted(x for x, _ in ring) == pytest.approx([-0.6, -0.6, -0.5, -0.5])
    assert document.state.version == 1


def test_a_line_beside_the_cloth_is_refused_and_nothing_is_lost() -> None:
    document, editor = editing(towel_drawing(), Mode.DRAW_FOLD)
    drag(editor, (0.2, 0.2), (0.2, -0.2))
    assert document.state.version == 1
    assert editor.says == "The line does not cross the cloth."


def test_off_the_table_the_line_is_dropped() -> None:
    document, editor = editing(PLAIN, Mode.DRAW_FOLD)
    drag(editor, (-0.55, 0.2), (-0.55, -0.2), (-0.55, -0.6))
    assert document.state.version == 1
    assert "off the table" in editor.says
    assert editor.aids.ghost is None


def test_without_cloth_there_is_nothing_to_fold() -> None:
    _, editor = editing(blank_drawing(), Mode.DRAW_FOLD)
    drag(editor, (-0.5, 0.2), (-0.5, -0.2))
    assert "no cloth yet" in editor.says


def test_the_first_fold_cannot_be_red() -> None:
    document, editor = editing(PLAIN, Mode.DRAW_FOLD)
    editor.choose_kind(FoldKind.RED)
    drag(editor, (-0.55, 0.2), (-0.55, -0.2))
    assert document.state.version == 1
    assert "first fold cannot be red" in editor.says


def test_the_next_fold_is_drawn_on_the_folded_cloth() -> None:
    # The towel's near half has gone up over y = 0.15: what is left covers -0.55 <= x <= -0.4 of the table.
    document, editor = editing(towel_drawing(), Mode.DRAW_FOLD)
    assert editor.aids.pile is not None and len(editor.aids.pile.cloth.layers) == 2
    (outline,) = editor.aids.lines
    assert min(x for x, _ in outline) == pytest.approx(-0.55)
    drag(editor, (-0.58, 0.0), (-0.4, 0.0))
    fold = document.state.drawing.folds[1]
    assert fold.start.point == pytest.approx((0.2, 0.15))
    assert fold.end.point == pytest.approx((0.2, 0.3))
    assert document.state.solution.problems == ()


def test_a_red_fold_takes_the_flap_of_the_fold_before() -> None:
    # First the near 0.1 m go up over y = 0.1, onto 0.1 <= y <= 0.2; the flap lies at -0.6 <= x <= -0.5.
    once = replace(PLAIN, folds=(crease("f0", (0.4, 0.1), (0.0, 0.1)),))
    document, editor = editing(once, Mode.DRAW_FOLD)
    editor.choose_kind(FoldKind.RED)
    (flap,) = editor.aids.lines
    assert {round(x, 6) for x, _ in flap} == {-0.6, -0.5}
    drag(editor, (-0.55, 0.2), (-0.55, -0.2))
    assert document.state.drawing.folds[1].kind == "red"
    assert document.state.solution.problems == ()


def test_a_fold_that_is_not_legal_has_to_be_fixed_first() -> None:
    broken = replace(PLAIN, folds=(crease("f0", (0.1, 0.1), (0.3, 0.1)),))
    document, editor = editing(broken, Mode.DRAW_FOLD)
    drag(editor, (-0.55, 0.2), (-0.55, -0.2))
    assert len(document.state.drawing.folds) == 1
    assert editor.says.startswith("Fix fold 1 \N{LEFT DOUBLE QUOTATION MARK}f0\N{RIGHT DOUBLE QUOTATION MARK} first: ")


def test_a_fold_is_made_on_the_cloth_as_it_is_by_then() -> None:
    document, editor = editing(PLAIN, Mode.DRAW_FOLD)
    editor.press(at((-0.55, 0.2)))
    editor.drag(at((-0.55, -0.2)))
    document.edit(Edit("Elsewhere", pulled(document.state.drawing, 1, 0.05, 0.0)))
    editor.release(at((-0.55, -0.2)))
    assert document.state.drawing.outline[1].point == pytest.approx((0.45, 0.0))
    assert document.state.solution.problems == ()
    assert len(document.state.drawing.folds) == 1
