import pytest

from app.document import Document
from app.drawing.draft import draft_of
from app.drawing.edit import Edit
from app.ui.editor.aids import NO_AIDS
from app.ui.editor.document_writer import DocumentWriter
from app.ui.editor.editor import Editor
from app.ui.editor.mode import Mode
from planner import Plan, make_plan
from planner.cloth.garment import Garment
from tests.app.drawing.drawings import pulled, towel_drawing
from tests.app.editor.hand import at, drag, editing
from tests.app.samples import towel

FAR_CORNER = (-0.4, -0.2)


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(Garment.from_dict(towel()))


def playing(plan: Plan) -> Document:
    """Open a document and start its playback."""
    document = Document(draft_of(towel_drawing()))
    task = document.state.task
    assert task is not None
    document.settle(document.state.version, task, plan, "id")
    document.seek(2.0)
    document.play()
    return document


def test_to_look_changes_nothing(plan: Plan) -> None:
    document = playing(plan)
    editor = Editor(document, "hand")
    drag(editor, FAR_CORNER, (-0.3, -0.3))
    editor.tap(at(FAR_CORNER))
    assert document.state.version == 1
    assert document.state.playback.is_playing
    assert not editor.is_drawing
    assert editor.aids == NO_AIDS


@pytest.mark.parametrize("mode", [Mode.MOVE_POINTS, Mode.DRAW_OUTLINE, Mode.DRAW_FOLD])
def test_to_draw_time_stops_at_its_beginning(plan: Plan, mode: Mode) -> None:
    document = playing(plan)
    editor = Editor(document, "hand")
    editor.choose(mode)
    assert document.t_s == 0.0
    assert not document.state.playback.is_playing


def test_while_a_film_runs_no_aids_are_seen_and_a_drag_only_goes_back_to_the_beginning(plan: Plan) -> None:
    document = playing(plan)
    editor = Editor(document, "hand")
    editor.choose(Mode.MOVE_POINTS)
    document.seek(2.0)
    assert editor.aids == NO_AIDS
    drag(editor, FAR_CORNER, (-0.3, -0.3))
    assert document.state.version == 1
    assert document.t_s == 0.0
    assert "spread again" in editor.says
    drag(editor, FAR_CORNER, (-0.3, -0.3))
    assert document.state.version > 1


def test_undo_and_redo_say_what_they_do() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    before = document.state.drawing
    assert (editor.undo_label, editor.redo_label) == ("Undo", "Redo")
    drag(editor, FAR_CORNER, (-0.3, -0.3))
    after = document.state.drawing
    assert editor.undo_label == "Undo: Move vertex"
    editor.undo()
    assert document.state.drawing == before
    assert (editor.undo_label, editor.redo_label) == ("Undo", "Redo: Move vertex")
    editor.redo()
    assert document.state.drawing == after


def test_undo_takes_back_what_was_done_elsewhere_too() -> None:
    document, editor = editing(towel_drawing(), Mode.LOOK)
    before = document.state.drawing
    document.edit(Edit("Elsewhere", pulled(before, 0, -0.1, 0.0)))
    assert editor.undo_label == "Undo: Elsewhere"
    editor.undo()
    assert document.state.drawing == before


def test_a_refusal_stays_until_the_next_thing_is_done() -> None:
    _, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    drag(editor, (0.3, 0.3), (0.2, 0.2))
    assert "no corner there" in editor.says
    editor.press(at(FAR_CORNER))
    assert "Let go" in editor.says


def test_pointing_past_the_table_is_told_of() -> None:
    _, editor = editing(towel_drawing(), Mode.DRAW_OUTLINE)
    editor.tap(None)
    assert "off the table" in editor.says


def test_a_document_that_has_been_closed_is_told_of() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    document.end()
    drag(editor, FAR_CORNER, (-0.3, -0.3))
    assert editor.says == "The document has been closed."


def test_who_leaves_in_the_middle_of_a_drag_leaves_nothing_behind() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    before = document.state.drawing
    editor.press(at(FAR_CORNER))
    editor.drag(at((-0.3, -0.3)))
    editor.leave()
    assert document.state.drawing == before
    assert document.state.draft.gesture is None


def test_a_change_that_comes_too_late_is_made_once_more_to_what_is_there() -> None:
    document = Document(draft_of(towel_drawing()))
    writer = DocumentWriter(document, "hand")
    seen: list[int] = []

    def change(state):
        if not seen:
            document.edit(Edit("Elsewhere", pulled(state.drawing, 0, -0.1, 0.0)))
        seen.append(state.version)
        return pulled(state.drawing, 2, 0.1, 0.0)

    state = writer.commit("Mine", change)
    assert seen == [1, 2]
    assert state.drawing.outline[0].point == pytest.approx((-0.1, 0.0))
    assert state.drawing.outline[2].point == pytest.approx((0.5, 0.3))
