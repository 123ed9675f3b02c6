"""Editing over the wire: messages of viser's page, through the 3D view's own thread, to the document and back."""

import math
import time
from collections.abc import Iterator

import pytest

from app.document import Document
from app.drawing.draft import draft_of
from app.drawing.drawing import Drawing
from app.drawing.garment_drawing import drawing_of
from app.player import Player
from app.ui.editor.camera_panel import CHANNEL
from app.ui.editor.pointer_capture import NODE
from app.ui.editor.sessions import Sessions
from app.ui.opening import opening
from app.ui.view_3d import View3D
from app.ui.viser_patches import start_private_viser
from planner import Scene
from planner.robots.load_robot import load_robot
from tests.app.drawing.drawings import towel_drawing
from tests.app.editor.visitor import EYE, Visitor
from tests.replay.planned import planned

CARD = load_robot("pr2").card
FAR_CORNER = (-0.4, -0.2)
ELSEWHERE = (-0.35, -0.3)


@pytest.fixture(scope="module")
def opened() -> Iterator[tuple[Document, View3D]]:
    document, view = Document(draft_of(towel_drawing())), View3D(CARD, Scene())
    player = Player(document, view, Sessions(document, view.server, view.opening))
    yield document, view
    player.close()
    view.close()


@pytest.fixture
def document(opened: tuple[Document, View3D]) -> Iterator[Document]:
    document, _ = opened
    yield document
    while document.state.draft.closed().history.can_undo:
        document.undo()


@pytest.fixture
def visitor(opened: tuple[Document, View3D], document: Document) -> Iterator[Visitor]:
    with Visitor(opened[1]) as visitor:
        visitor.until(lambda: NODE in visitor.nodes)
        yield visitor


def grown(drawing: Drawing) -> bool:
    """Return whether the far corner is where the drags below take it."""
    return drawing.outline[2].point == pytest.approx((0.5, 0.35))


def test_who_only_looks_has_no_pointer_capture_and_no_handles(visitor: Visitor) -> None:
    visitor.until(lambda: "Mode" in visitor.controls)
    assert not visitor.is_shown(NODE)
    assert "/editor/handles" not in visitor.nodes


def test_a_corner_is_dragged_and_undone(visitor: Visitor, document: Document) -> None:
    before = document.state.drawing
    visitor.choose("Mode", "Move points")
    visitor.until(lambda: visitor.is_shown(NODE) and visitor.is_shown("/editor/handles"))
    visitor.touch("start", FAR_CORNER, FAR_CORNER)
    visitor.touch("update", FAR_CORNER, (-0.35, -0.2))
    visitor.until(lambda: document.state.draft.gesture is not None)
    visitor.touch("end", FAR_CORNER, ELSEWHERE)
    visitor.until(lambda: grown(document.state.drawing) and document.state.draft.gesture is None)
    visitor.until(lambda: visitor.controls["Undo"]["props"]["label"] == "Undo: Move vertex")
    visitor.push("Undo")
    visitor.until(lambda: visitor.controls["Redo"]["props"]["label"] == "Redo: Move vertex")
    assert document.state.drawing == before


def test_a_key_that_goes_down_in_the_middle_of_a_drag_does_not_end_it(visitor: Visitor, document: Document) -> None:
    visitor.choose("Mode", "Move points")
    visitor.until(lambda: visitor.is_shown(NODE))
    visitor.touch("start", FAR_CORNER, FAR_CORNER)
    visitor.touch("update", FAR_CORNER, (-0.35, -0.2))
    visitor.touch("end", FAR_CORNER, (-0.35, -0.2))  # Shift goes down: viser parts the drag there
    visitor.touch("start", FAR_CORNER, (-0.35, -0.22), "shift")
    visitor.touch("update", FAR_CORNER, (-0.35, -0.25), "shift")
    visitor.touch("end", FAR_CORNER, (-0.35, -0.25), "shift")  # and up again
    visitor.touch("start", FAR_CORNER, (-0.35, -0.28))
    visitor.touch("end", FAR_CORNER, ELSEWHERE)
    visitor.until(lambda: grown(document.state.drawing) and document.state.draft.gesture is None)
    history = document.state.draft.history
    assert history.can_undo == "Move vertex"
    document.undo()
    assert document.state.draft.history.can_undo is None  # all of it was one step


def test_two_drags_in_quick_succession_are_two(visitor: Visitor, document: Document) -> None:
    visitor.choose("Mode", "Move points")
    visitor.until(lambda: visitor.is_shown(NODE))
    between = (-0.35, -0.2)
    visitor.touch("start", FAR_CORNER, FAR_CORNER)
    visitor.touch("end", FAR_CORNER, between)
    visitor.touch("start", between, between, "shift")
    visitor.touch("end", between, ELSEWHERE, "shift")
    visitor.until(lambda: grown(document.state.drawing) and document.state.draft.gesture is None)
    for _ in range(2):
        assert document.state.draft.history.can_undo == "Move vertex"
        document.undo()
    assert document.state.draft.history.can_undo is None


def test_an_outline_is_clicked(visitor: Visitor, document: Document) -> None:
    visitor.choose("Mode", "Draw outline")
    visitor.until(lambda: visitor.is_shown(NODE))
    corners = [(-0.5, -0.3), (-0.1, -0.3), (-0.1, 0.1)]
    for corner in [*corners, corners[0]]:
        visitor.click(corner)
    visitor.until(lambda: len(document.state.drawing.outline) == 3)
    assert document.state.drawing.folds == ()


def test_a_drag_past_the_horizon_and_back_is_a_drag(visitor: Visitor, document: Document) -> None:
    visitor.choose("Mode", "Move points")
    visitor.until(lambda: visitor.is_shown(NODE))
    visitor.touch("start", FAR_CORNER, FAR_CORNER)
    visitor.touch("update", FAR_CORNER, (5.0, 5.0))
    visitor.touch("end", FAR_CORNER, ELSEWHERE)
    visitor.until(lambda: grown(document.state.drawing))


def test_each_visitor_has_a_mode_of_its_own(visitor: Visitor, opened: tuple[Document, View3D]) -> None:
    with Visitor(opened[1]) as other:
        visitor.choose("Mode", "Move points")
        visitor.until(lambda: visitor.is_shown(NODE))
        other.until(lambda: NODE in other.nodes)
        other.choose("Mode", "Draw fold")
        other.until(lambda: other.is_shown(NODE))
        assert "/editor/handles" not in other.nodes
        assert visitor.is_shown("/editor/handles")


def test_a_visitor_who_goes_away_in_the_middle_of_a_drag_leaves_no_gesture_open(
    opened: tuple[Document, View3D], document: Document
) -> None:
    with Visitor(opened[1]) as leaving:
        leaving.choose("Mode", "Move points")
        leaving.until(lambda: leaving.is_shown(NODE))
        leaving.touch("start", FAR_CORNER, FAR_CORNER)
        leaving.touch("update", FAR_CORNER, ELSEWHERE)
        leaving.until(lambda: document.state.draft.gesture is not None)
    with Visitor(opened[1]) as staying:
        staying.until(lambda: document.state.draft.gesture is None)


def test_a_button_moves_the_camera_of_the_visitor_who_pressed_it_and_nothing_else_does(
    visitor: Visitor, document: Document, opened: tuple[Document, View3D]
) -> None:
    with Visitor(opened[1]) as other:
        other.until(lambda: NODE in other.nodes)
        opening = [opened[1].opening.position]  # what a new visitor is told
        assert visitor.camera == other.camera == opening
        visitor.choose("Mode", "Move points")
        visitor.until(lambda: visitor.is_shown(NODE))
        visitor.touch("start", FAR_CORNER, FAR_CORNER)
        visitor.touch("end", FAR_CORNER, ELSEWHERE)
        visitor.until(lambda: grown(document.state.drawing))
        visitor.until(lambda: visitor.controls["Undo"]["props"]["label"] == "Undo: Move vertex")
        assert visitor.camera == opening
        visitor.choose("Look from", "Top")
        visitor.until(lambda: len(visitor.camera) == 2)
        assert visitor.camera[1][:2] == pytest.approx((0.0, 0.0), abs=0.01)
        told = f"{CHANNEL}{visitor.controls['Look from']['uuid']}"  # the page asks with that and the preset's own name
        visitor.until(lambda: told in visitor.nodes)
        assert told not in other.nodes
        visitor.choose("Look from", "preset.free")
        visitor.until(lambda: len(visitor.camera) == 3)
        assert visitor.camera[2] == pytest.approx(EYE)
        other.choose("Mode", "Draw fold")
        other.until(lambda: other.is_shown(NODE))
        assert other.camera == opening


def test_in_a_tall_picture_the_camera_begins_further_back_and_follows_its_shape(
    opened: tuple[Document, View3D],
) -> None:
    start, tall, taller = opened[1].opening, (390, 680), (312, 680)
    with Visitor(opened[1], (3.0, 3.0, 3.0), tall) as visitor:  # a browser's own place, before it is told of another
        visitor.until(lambda: "Mode" in visitor.controls)
        visitor.look(start.position, tall)
        visitor.until(lambda: len(visitor.camera) == 2)
        assert visitor.camera[1] == pytest.approx(opening(Scene(), 390 / 680).position)
        visitor.look(visitor.camera[1], taller)
        visitor.until(lambda: len(visitor.camera) == 3)
        assert visitor.camera[2] == pytest.approx(opening(Scene(), 312 / 680).position)


def test_a_camera_that_somebody_has_moved_stays_where_it_is(opened: tuple[Document, View3D]) -> None:
    start = opened[1].opening
    with Visitor(opened[1], start.position, (800, 500)) as visitor:
        visitor.until(lambda: "Mode" in visitor.controls)
        visitor.look(EYE, (800, 500))
        visitor.look(EYE, (390, 680))
        visitor.look(start.position, (390, 680))  # by hand back to where it began
        visitor.choose("Look from", "Top")
        visitor.until(lambda: len(visitor.camera) == 2)
        assert visitor.camera[1][2] > 2.5  # nothing but the button has moved it
        assert visitor.camera[1][:2] == pytest.approx((0.0, 0.0), abs=0.01)


def test_of_a_drag_only_the_latest_place_is_worked_on() -> None:
    server, _ = start_private_viser()
    try:
        sessions = Sessions(Document(draft_of(towel_drawing())), server, opening(Scene(), 1.0))
        done: list[str] = []
        for visitor, name, is_passing in (
            (1, "press", False),
            (1, "drag 1", True),
            (1, "drag 2", True),
            (2, "drag 3", True),
            (2, "release", False),
        ):
            sessions._enqueue(visitor, lambda name=name: done.append(name), is_passing)
        sessions.perform()
        assert done == ["press", "drag 2", "drag 3", "release"]
    finally:
        server.stop()


def test_what_goes_wrong_for_one_visitor_does_not_stop_the_others(caplog: pytest.LogCaptureFixture) -> None:
    server, _ = start_private_viser()
    try:
        sessions = Sessions(Document(draft_of(towel_drawing())), server, opening(Scene(), 1.0))
        done: list[str] = []
        sessions._enqueue(1, lambda: done.append(str(1 // 0)), False)
        sessions._enqueue(2, lambda: done.append("second"), False)
        sessions.perform()
        assert done == ["second"]
        assert "failed" in caplog.text
    finally:
        server.stop()


@pytest.fixture(scope="module")
def driven() -> Iterator[tuple[Document, View3D]]:
    """Open a document with a plan that drives to the table's left, and its 3D view."""
    plan = planned("jeans").answer
    document, view = Document(draft_of(drawing_of(plan.garment))), View3D(CARD, Scene())
    task = document.state.task
    assert task is not None
    document.settle(document.state.version, task, plan, "id")
    player = Player(document, view, Sessions(document, view.server, view.opening))
    yield document, view
    player.close()
    view.close()


def time_at_side(document: Document) -> float:
    """Return a time at which the robot stands beside the table (s)."""
    shown = document.state.shown
    assert shown is not None
    times = (move.start_s + move.duration_s for move in shown.plan.primitives if move.kind == "move")
    return next(t for t in times if abs(shown.timeline.base_at(t).y_m) > 0.6)


def test_the_robots_eye_goes_along_when_the_base_drives_until_somebody_moves_the_camera(
    driven: tuple[Document, View3D],
) -> None:
    document, view = driven
    document.seek(0.0)
    shown = document.state.shown
    assert shown is not None
    with Visitor(view) as visitor:
        visitor.until(lambda: "Look from" in visitor.controls)
        visitor.choose("Look from", "Robot's eye")
        visitor.until(lambda: len(visitor.camera) == 2)
        before = shown.timeline.base_at(0.0)
        assert math.dist(visitor.camera[-1][:2], (before.x_m, before.y_m)) < 0.4
        document.seek(at := time_at_side(document))
        beside = shown.timeline.base_at(at)
        visitor.until(lambda: math.dist(visitor.camera[-1][:2], (beside.x_m, beside.y_m)) < 0.4)
        visitor.look(EYE, (800, 500))
        time.sleep(0.2)
        moves = len(visitor.camera)
        document.seek(0.0)
        time.sleep(0.3)
        assert len(visitor.camera) == moves


def test_a_camera_that_nobody_has_moved_looks_from_the_side_where_the_robot_does_not_stand(
    driven: tuple[Document, View3D],
) -> None:
    document, view = driven
    document.seek(0.0)
    with Visitor(view, view.opening.position) as visitor:
        visitor.until(lambda: "Mode" in visitor.controls)
        visitor.look(visitor.camera[-1], (800, 500))
        document.seek(at := time_at_side(document))
        shown = document.state.shown
        assert shown is not None
        beside = shown.timeline.base_at(at)
        visitor.until(lambda: visitor.camera[-1][1] * beside.y_m < 0.0)


def test_a_camera_that_somebody_has_moved_stays_though_the_robot_stands_before_it(
    driven: tuple[Document, View3D],
) -> None:
    document, view = driven
    document.seek(0.0)
    with Visitor(view) as visitor:
        visitor.until(lambda: "Mode" in visitor.controls)
        moves = len(visitor.camera)
        document.seek(time_at_side(document))
        time.sleep(0.3)
        assert len(visitor.camera) == moves
