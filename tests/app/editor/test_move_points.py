import math
from dataclasses import replace

import pytest

from app.document import Document
from app.drawing.curve import Curve
from app.drawing.edit import Edit
from app.ui.editor.mode import Mode
from tests.app.drawing.drawings import outlined, pulled, towel_drawing
from tests.app.editor.hand import PIXEL_M, at, drag, editing

# The corners of the towel on the table: it lies at (-0.7, 0.2), turned by -90 degrees.
CORNERS = [(-0.7, 0.2), (-0.7, -0.2), (-0.4, -0.2), (-0.4, 0.2)]


def test_there_is_a_handle_at_each_corner() -> None:
    _, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    for handle, corner in zip(editor.aids.handles, CORNERS, strict=True):
        assert handle == pytest.approx(corner)


def test_a_corner_goes_where_it_is_dragged_as_one_step() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    drag(editor, CORNERS[2], (-0.35, -0.3))
    # 0.05 m further in the table's x is 0.05 m in the article's y, 0.1 m less in its y 0.1 m more in the article's x.
    assert document.state.drawing.outline[2].point == pytest.approx((0.5, 0.35))
    assert [step.label for step in document.state.draft.history.past] == ["Move vertex"]
    assert document.state.draft.gesture is None


def test_the_document_follows_while_the_corner_is_dragged() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    editor.press(at(CORNERS[2]))
    editor.drag(at((-0.35, -0.2)))
    assert document.state.draft.gesture is not None
    assert document.state.drawing.outline[2].point == pytest.approx((0.4, 0.35))
    assert editor.aids.chosen == 2
    assert document.state.draft.history.past == ()


def test_a_corner_that_is_grabbed_beside_its_middle_does_not_jump() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    x, y = CORNERS[2]
    drag(editor, (x + 0.01, y), (x + 0.06, y))
    assert document.state.drawing.outline[2].point == pytest.approx((0.4, 0.35))


def test_of_two_corners_the_nearer_one_is_taken() -> None:
    close = outlined(towel_drawing(), (0.0, 0.0), (0.4, 0.0), (0.4, 0.27), (0.4, 0.3), (0.0, 0.3))
    document, editor = editing(close, Mode.MOVE_POINTS)
    x, y = -0.4, -0.2  # of the fourth corner; the third is 0.03 m nearer to the front
    drag(editor, (x - 0.01, y), (x + 0.04, y))
    assert [corner.point[1] for corner in document.state.drawing.outline[2:4]] == pytest.approx([0.27, 0.35])


def test_a_handle_can_be_grabbed_22_pixels_off_and_no_further() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    x, y = CORNERS[2]
    drag(editor, (x + 23 * PIXEL_M, y), (x + 0.2, y))
    assert document.state.version == 1
    assert "no corner there" in editor.says
    drag(editor, (x + 21 * PIXEL_M, y), (x + 21 * PIXEL_M + 0.05, y))
    assert document.state.drawing.outline[2].point == pytest.approx((0.4, 0.35))


def test_off_the_table_the_corner_goes_back_without_a_step() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    before = document.state.drawing
    drag(editor, CORNERS[2], (-0.3, -0.3), (-0.3, -0.8))
    assert document.state.drawing == before
    assert document.state.draft.history.past == ()
    assert "off the table" in editor.says


def test_beside_the_picture_the_corner_goes_back_too() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    before = document.state.drawing
    editor.press(at(CORNERS[2]))
    editor.drag(at((-0.3, -0.3)))
    editor.drag(None)
    editor.release(None)
    assert document.state.drawing == before


def test_a_corner_that_hangs_over_the_edge_can_be_moved_along_there() -> None:
    hanging = towel_drawing(placement={"x_m": -1.0, "y_m": 0.2, "yaw_rad": -math.pi / 2})
    document, editor = editing(hanging, Mode.MOVE_POINTS)
    drag(editor, (-1.0, 0.2), (-0.95, 0.2))
    assert document.state.drawing.outline[0].point == pytest.approx((0.0, 0.05))


def test_a_crossing_outline_is_kept_and_told_of() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    drag(editor, CORNERS[0], (-0.3, 0.0))  # through the far edge
    assert document.state.solution.problems[0].code == "outline_crosses"
    assert "cross" in editor.says
    editor.undo()
    assert document.state.solution.problems == ()


def test_what_somebody_else_changes_during_a_drag_is_kept() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    editor.press(at(CORNERS[2]))
    editor.drag(at((-0.35, -0.2)))
    document.edit(Edit("Elsewhere", pulled(document.state.drawing, 0, -0.1, 0.0)))
    editor.release(at((-0.35, -0.3)))
    points = [corner.point for corner in document.state.drawing.outline]
    assert points[0] == pytest.approx((-0.1, 0.0))
    assert points[2] == pytest.approx((0.5, 0.35))


def test_a_corner_that_somebody_takes_away_is_told_of() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    editor.press(at(CORNERS[2]))
    drawing = document.state.drawing
    document.edit(Edit("Elsewhere", replace(drawing, outline=(*drawing.outline[:2], *drawing.outline[3:]))))
    editor.release(at((-0.35, -0.3)))
    assert len(document.state.drawing.outline) == 3
    assert "taken this corner away" in editor.says


def test_another_mode_in_the_middle_of_a_drag_drops_it() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    before = document.state.drawing
    editor.press(at(CORNERS[2]))
    editor.drag(at((-0.35, -0.2)))
    editor.choose(Mode.LOOK)
    assert document.state.drawing == before
    assert document.state.draft.gesture is None


def test_somebody_elses_gesture_is_not_cancelled() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    editor.press(at(CORNERS[2]))
    editor.drag(at((-0.35, -0.2)))
    theirs = pulled(document.state.drawing, 0, -0.1, 0.0)
    document.edit(Edit("Theirs", theirs, gesture="theirs"))
    editor.release(None)
    assert document.state.drawing.outline[0].point == pytest.approx((-0.1, 0.0))


# The middle of the second edge, from (0.4, 0) to (0.4, 0.3) of the article, on the table.
RIGHT = (-0.55, -0.2)


def bent(document: Document) -> list[tuple[int, float, float]]:
    """Return which edges are curved, and how far along and across."""
    curves = [corner.curve for corner in document.state.drawing.outline]
    return [(index, curve.along, curve.across) for index, curve in enumerate(curves) if curve is not None]


def test_the_middle_of_an_edge_is_pulled_into_an_arc_pulled_again_and_straightened() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    assert editor.aids.middles[1] == pytest.approx(RIGHT)
    drag(editor, RIGHT, (-0.56, -0.26))  # 1 cm aside of 15 px: the arc of a circle is near
    assert bent(document) == [(1, pytest.approx(0.0, abs=1e-12), pytest.approx(-0.2))]
    assert [step.label for step in document.state.draft.history.past] == ["Bend edge"]
    assert editor.aids.middles[1] == pytest.approx((-0.55, -0.26))
    drag(editor, (-0.55, -0.26), (-0.475, -0.26))
    assert bent(document) == [(1, pytest.approx(0.25), pytest.approx(-0.2))]
    drag(editor, (-0.475, -0.26), (-0.5, -0.21))
    assert bent(document) == []
    editor.undo()
    assert [index for index, *_ in bent(document)] == [1]


def test_half_a_circle_is_met_from_near() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    drag(editor, RIGHT, (-0.54, -0.34))
    assert bent(document) == [(1, pytest.approx(0.0, abs=1e-12), pytest.approx(-0.5))]


def test_the_edge_that_is_bent_is_highlighted_and_goes_back_off_the_table() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    editor.press(at(RIGHT))
    assert "middle of the edge" in editor.says
    editor.drag(at((-0.55, -0.3)))
    assert editor.aids.chosen == len(CORNERS) + 1
    editor.release(at((-0.55, -0.8)))
    assert bent(document) == []
    assert "the edge is as it was" in editor.says


def test_a_short_edge_has_a_middle_only_once_it_is_curved() -> None:
    short = outlined(towel_drawing(), (0.0, 0.0), (0.4, 0.0), (0.4, 0.21), (0.4, 0.3), (0.0, 0.3))
    document, editor = editing(short, Mode.MOVE_POINTS)
    assert len(editor.aids.middles) == 4
    outline = tuple(replace(corner, curve=Curve(0.0, -0.2)) for corner in document.state.drawing.outline)
    document.edit(Edit("Bend", replace(document.state.drawing, outline=outline)))
    assert len(editor.aids.middles) == 5


def test_an_edge_that_somebody_takes_away_is_told_of() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    editor.press(at(RIGHT))
    drawing = document.state.drawing
    document.edit(Edit("Elsewhere", replace(drawing, outline=(drawing.outline[0], *drawing.outline[2:]))))
    editor.release(at((-0.55, -0.3)))
    assert len(document.state.drawing.outline) == 3
    assert "taken this edge away" in editor.says


def test_a_bent_edge_is_a_step_in_the_readers_language() -> None:
    document, editor = editing(towel_drawing(), Mode.MOVE_POINTS)
    drag(editor, RIGHT, (-0.55, -0.3))
    document.set_language("de")
    assert "Kante wölben" in editor.undo_label
