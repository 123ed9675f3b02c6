"""Cameras over the wire: messages of viser's page, through the 3D view's own thread, and back."""

import itertools
import math
from collections.abc import Iterator
from functools import partial

import pytest

from app.document import Document
from app.drawing.draft import draft_of
from app.drawing.garment_drawing import drawing_of
from app.player import Player
from app.ui.opening import opening
from app.ui.view_3d import View3D
from app.ui.viewpoints.following import work_of
from app.ui.viewpoints.presets import Preset
from app.ui.viewpoints.sessions import Sessions
from app.ui.viser_patches import start_private_viser
from planner import Scene
from planner.robots.load_robot import load_robot
from tests.app.drawing.drawings import towel_drawing
from tests.app.viewpoints.viewer import EYE, Viewer
from tests.patience import wait_until
from tests.replay.planned import shipped_plan
from tests.required import required

CARD = load_robot("pr2").card
Opened = tuple[Document, View3D]


@pytest.fixture(scope="module")
def opened() -> Iterator[tuple[Document, View3D]]:
    document, view = Document(draft_of(towel_drawing())), View3D(CARD, Scene())
    player = Player(document, view, Sessions(document, view.server, view.opening))
    yield document, view
    player.close()
    view.close()


def has_channel(viewer: Viewer) -> bool:
    return viewer.channel is not None


def test_a_viewpoint_moves_the_camera_of_the_browser_that_chose_it_alone(opened: tuple[Document, View3D]) -> None:
    _, view = opened
    with Viewer(view) as viewer, Viewer(view) as other:
        for each in (viewer, other):
            each.until(partial(has_channel, each))
        assert viewer.channel != other.channel
        opening = [view.opening.position]  # what a new browser is told
        assert viewer.camera == other.camera == opening
        viewer.choose(Preset.TOP)
        viewer.until(lambda: len(viewer.camera) == 2)
        assert viewer.camera[1][:2] == pytest.approx((0.0, 0.0), abs=0.01)
        viewer.choose(Preset.FREE)
        viewer.until(lambda: len(viewer.camera) == 3)
        assert viewer.camera[2] == pytest.approx(EYE)
        other.choose(Preset.SIDE)
        other.until(lambda: len(other.camera) == 2)
        assert other.camera[0] == opening[0]
        assert len(viewer.camera) == 3


def test_in_a_tall_picture_the_camera_begins_further_back_and_follows_its_shape(
    opened: tuple[Document, View3D],
) -> None:
    start, tall, taller = opened[1].opening, (390, 680), (312, 680)
    with Viewer(opened[1], (3.0, 3.0, 3.0), tall) as viewer:  # a browser's own place, before it is told of another
        viewer.until(lambda: viewer.channel is not None)
        viewer.look(start.position, tall)
        viewer.until(lambda: len(viewer.camera) == 2)
        assert viewer.camera[1][0] > 0.0  # across the table from the robot
        viewer.look(viewer.camera[1], taller)
        viewer.until(lambda: len(viewer.camera) == 3)
        assert viewer.camera[2][2] == pytest.approx(viewer.camera[1][2] * 390 / 312)


def test_a_camera_that_somebody_has_moved_stays_where_it_is(opened: tuple[Document, View3D]) -> None:
    start = opened[1].opening
    with Viewer(opened[1], start.position, (800, 500)) as viewer:
        viewer.until(lambda: viewer.channel is not None)
        viewer.look(EYE, (800, 500))
        viewer.look(EYE, (390, 680))
        viewer.look(start.position, (390, 680))  # by hand back to where it began
        viewer.choose(Preset.TOP)
        viewer.until(lambda: len(viewer.camera) == 3)
        assert viewer.camera[2][2] > 2.5  # since the opening nothing but the button has moved it
        assert viewer.camera[2][:2] == pytest.approx((0.0, 0.0), abs=0.01)


def test_what_goes_wrong_for_one_session_does_not_stop_the_others(caplog: pytest.LogCaptureFixture) -> None:
    server, _ = start_private_viser()
    try:
        sessions = Sessions(Document(draft_of(towel_drawing())), server, opening(Scene(), 1.0))
        done: list[str] = []
        sessions._ask(lambda: done.append(str(1 // 0)))
        sessions._ask(lambda: done.append("second"))
        sessions.work()
        assert done == ["second"]
        assert "failed" in caplog.text
    finally:
        server.stop()


@pytest.fixture(scope="module")
def driven() -> Iterator[tuple[Document, View3D]]:
    """Open a document with a plan that drives to the table's left, and its view."""
    plan = shipped_plan("jeans")
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


def see_robot_at(viewer: Viewer, document: Document, t_s: float) -> None:
    """Go to a time of the plan, and wait until the robot is shown where it stands then."""
    base = required(document.state.shown).timeline.base_at(t_s)
    document.seek(t_s)
    viewer.until(lambda: math.dist(viewer.robot[:2], (base.x_m, base.y_m)) < 0.01)


def assert_next_is_a_button(viewer: Viewer, moves: int) -> None:
    """Assert that after some moves nothing but a button has moved the camera."""
    viewer.choose(Preset.TOP)
    viewer.until(lambda: len(viewer.camera) > moves)
    assert viewer.camera[moves][:2] == pytest.approx((0.0, 0.0), abs=0.01)


def test_the_robots_eye_goes_along_when_the_base_drives_until_somebody_moves_the_camera(
    driven: tuple[Document, View3D],
) -> None:
    document, view = driven
    document.seek(0.0)
    shown = document.state.shown
    assert shown is not None
    with Viewer(view) as viewer:
        viewer.until(lambda: viewer.channel is not None)
        viewer.choose(Preset.ROBOT)
        viewer.until(lambda: len(viewer.camera) == 2)
        before = shown.timeline.base_at(0.0)
        assert math.dist(viewer.camera[-1][:2], (before.x_m, before.y_m)) < 0.4
        document.seek(at := time_at_side(document))
        beside = shown.timeline.base_at(at)
        viewer.until(lambda: math.dist(viewer.camera[-1][:2], (beside.x_m, beside.y_m)) < 0.4)
        moves = len(viewer.camera)
        viewer.look(elsewhere := (0.5, 0.5, 2.0), (800, 500))
        (client,) = view.server.get_clients().values()
        wait_until(lambda: math.dist(client.camera.position, elsewhere) < 1e-6)
        see_robot_at(viewer, document, 0.0)
        assert_next_is_a_button(viewer, moves)


def test_a_camera_that_nobody_has_moved_glides_to_the_side_where_the_robot_does_not_stand(
    driven: tuple[Document, View3D],
) -> None:
    document, view = driven
    document.seek(0.0)
    with Viewer(view, view.opening.position) as viewer:
        viewer.until(lambda: len(viewer.camera) == 2)
        document.seek(at := time_at_side(document))
        shown = document.state.shown
        assert shown is not None
        beside = shown.timeline.base_at(at)
        viewer.glide_until(lambda: viewer.camera[-1][1] * beside.y_m < -0.5)
        steps = [math.dist(before, after) for before, after in itertools.pairwise(viewer.camera[1:])]
        assert max(steps) < 1.0  # all the way is more than 2 m


def test_at_the_end_the_camera_glides_to_the_packet(driven: tuple[Document, View3D]) -> None:
    document, view = driven
    shown = document.state.shown
    assert shown is not None
    document.seek(shown.timeline.duration_s - 0.5)
    with Viewer(view, view.opening.position) as viewer:
        viewer.until(lambda: len(viewer.camera) == 2)
        document.seek(shown.timeline.duration_s)
        x, y = work_of(shown.plan, shown.timeline.duration_s)
        near_m = 0.7 * math.dist(viewer.camera[1], (x, y, 0.1))
        viewer.glide_until(lambda: math.dist(viewer.camera[-1], (x, y, 0.1)) < near_m)


def test_a_camera_that_somebody_has_moved_stays_though_the_robot_stands_before_it(
    driven: tuple[Document, View3D],
) -> None:
    document, view = driven
    with Viewer(view) as viewer:
        viewer.until(lambda: viewer.channel is not None)
        see_robot_at(viewer, document, 0.0)
        moves = len(viewer.camera)
        see_robot_at(viewer, document, time_at_side(document))
        assert_next_is_a_button(viewer, moves)
