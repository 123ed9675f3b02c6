import pytest

from app.drawing.blank import blank_drawing
from app.ui.editor.editor import Editor
from app.ui.editor.mode import Mode
from tests.app.drawing.drawings import towel_drawing
from tests.app.editor.hand import PIXEL_M, at, drag, editing

SQUARE = [(-0.5, -0.3), (-0.1, -0.3), (-0.1, 0.1), (-0.5, 0.1)]


def click(editor: Editor, *points: tuple[float, float]) -> None:
    for point in points:
        editor.tap(at(point))


def test_clicks_put_corners_and_a_click_on_the_first_closes() -> None:
    document, editor = editing(blank_drawing(), Mode.DRAW_OUTLINE)
    click(editor, *SQUARE, SQUARE[0])
    # A blank board's article frame lies in the middle of the table, turned by -90 degrees: (x, y) is (-y, x) there.
    expected = [(0.3, -0.5), (0.3, -0.1), (-0.1, -0.1), (-0.1, -0.5)]
    for corner, point in zip(document.state.drawing.outline, expected, strict=True):
        assert corner.point == pytest.approx(point)
    assert document.state.solution.problems == ()
    assert [step.label for step in document.state.draft.history.past] == ["Draw outline"]


def test_a_new_outline_takes_the_place_of_the_old_one_and_its_folds_in_one_step() -> None:
    document, editor = editing(towel_drawing(), Mode.DRAW_OUTLINE)
    before = document.state.drawing
    click(editor, *SQUARE, SQUARE[0])
    assert document.state.drawing.folds == ()
    assert document.state.drawing.placement == before.placement
    assert len(document.state.drawing.outline) == 4
    editor.undo()
    assert document.state.drawing == before


def test_until_it_is_closed_the_document_is_as_it_was_and_the_corners_are_seen() -> None:
    document, editor = editing(towel_drawing(), Mode.DRAW_OUTLINE)
    click(editor, *SQUARE[:3])
    assert document.state.version == 1
    assert editor.aids.handles == tuple(SQUARE[:3])
    assert editor.aids.lines == (tuple(SQUARE[:3]),)
    assert editor.aids.chosen == 0


def test_undo_takes_one_corner_back_and_then_the_documents_steps() -> None:
    document, editor = editing(towel_drawing(), Mode.DRAW_OUTLINE)
    click(editor, *SQUARE, SQUARE[0])
    click(editor, SQUARE[0], SQUARE[1])
    assert editor.undo_label == "Undo: corner 2"
    editor.undo()
    editor.undo()
    assert editor.aids.handles == ()
    assert editor.undo_label == "Undo: Draw outline"
    editor.undo()
    assert len(document.state.drawing.folds) == 1


def test_a_click_that_trembles_is_a_click() -> None:
    _, editor = editing(blank_drawing(), Mode.DRAW_OUTLINE)
    drag(editor, (-0.5, -0.3), (-0.49, -0.3))
    assert editor.aids.handles == ((-0.49, -0.3),)


def test_near_the_first_corner_is_on_it() -> None:
    document, editor = editing(blank_drawing(), Mode.DRAW_OUTLINE)
    x, y = SQUARE[0]
    click(editor, *SQUARE, (x + 11 * PIXEL_M, y))
    assert len(document.state.drawing.outline) == 4


def test_two_corners_do_not_close() -> None:
    document, editor = editing(blank_drawing(), Mode.DRAW_OUTLINE)
    x, y = SQUARE[0]
    click(editor, *SQUARE[:2], (x + 5 * PIXEL_M, y))
    assert document.state.version == 1
    assert len(editor.aids.handles) == 2
    assert editor.says == "There is a corner already."


def test_an_outline_that_crosses_itself_is_not_closed_and_nothing_is_lost() -> None:
    document, editor = editing(towel_drawing(), Mode.DRAW_OUTLINE)
    bow = [SQUARE[0], SQUARE[2], SQUARE[1], SQUARE[3]]
    click(editor, *bow, bow[0])
    assert document.state.version == 1
    assert "cross" in editor.says
    assert editor.aids.handles == tuple(bow)


@pytest.mark.parametrize("point", [(-0.9, 0.0), (0.0, 0.6)])
def test_there_are_no_corners_off_the_table(point: tuple[float, float]) -> None:
    _, editor = editing(blank_drawing(), Mode.DRAW_OUTLINE)
    click(editor, point)
    assert editor.aids.handles == ()
    assert "off the table" in editor.says


def test_there_are_no_two_corners_in_one_place() -> None:
    _, editor = editing(blank_drawing(), Mode.DRAW_OUTLINE)
    click(editor, SQUARE[0], SQUARE[0])
    assert len(editor.aids.handles) == 1


def test_another_mode_forgets_the_corners() -> None:
    document, editor = editing(towel_drawing(), Mode.DRAW_OUTLINE)
    click(editor, *SQUARE)
    editor.choose(Mode.LOOK)
    editor.choose(Mode.DRAW_OUTLINE)
    assert editor.aids.handles == ()
    assert document.state.version == 1
