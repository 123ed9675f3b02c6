"""Red folds in the 3D view: distinct from blue ones in colour and dashes, drawn on the cloth that they will fold."""

from collections.abc import Iterator

import numpy as np
import pytest
import viser
from numpy.typing import NDArray

from app.ui.colours import DARK, LIGHT
from app.ui.lighting import ink
from app.ui.view_3d import View3D
from planner import Plan, Scene
from planner.motion.timeline import Timeline
from planner.robots.load_robot import load_robot
from planner.task.plan import PlanStep
from tests.replay.planned import shipped_plan

CARD = load_robot("pr2").card
ABOVE_M = 0.003
LAYER_M = 0.002
"""The height of a layer: 1 mm of cloth and 1 mm of air."""
FACE_M = 0.4 * LAYER_M
"""How far a face is from the middle of its layer."""
BLUE, RED = 0, 1


@pytest.fixture(scope="module")
def letter() -> Plan:
    """Return a towel 0.4 x 0.5 m: its near half goes over y = 0.25, then the free edge back over y = 0.39."""
    return shipped_plan("letter-towel")


@pytest.fixture
def view(letter: Plan) -> Iterator[View3D]:
    made = View3D(CARD, Scene())
    made.show_plan(letter)
    yield made
    made.close()


def performed(plan: Plan, index: int) -> PlanStep:
    """Return the step that performs a fold."""
    return next(step for step in plan.steps if step.fold == index)


def line(view: View3D, index: int) -> NDArray[np.float64]:
    """Return a fold's line as drawn: segments, shape (n, 2, 3), m; none if it is hidden."""
    handle = view._server.scene.get_handle_by_name(f"/folds/{index}")
    assert isinstance(handle, viser.LineSegmentsHandle)
    return np.asarray(handle.points, dtype=np.float64) if handle.visible else np.zeros((0, 2, 3))


def length_m(segments: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).sum())


def test_a_blue_line_is_drawn_through_and_a_red_one_as_dashes_and_dots(view: View3D, letter: Plan) -> None:
    view.show(Timeline.of(letter).at(0.0))
    assert length_m(line(view, BLUE)) == pytest.approx(0.4)
    # Dash 0.045, gap 0.012, dot 0.006, gap 0.012: of 0.075 m 0.051 are drawn. 0.4 m are five times that and a
    # last dash of 0.025 m.
    assert length_m(line(view, RED)) == pytest.approx(5 * 0.051 + 0.025)


def test_the_two_kinds_have_the_two_colours_of_the_theme(view: View3D) -> None:
    for is_dark, palette in ((False, LIGHT), (True, DARK)):
        view.set_theme(is_dark=is_dark)
        for index, wanted in ((BLUE, palette.folds["blue"]), (RED, palette.folds["red"])):
            handle = view._server.scene.get_handle_by_name(f"/folds/{index}")
            assert isinstance(handle, viser.LineSegmentsHandle)
            assert tuple(handle.colors) == tuple(ink(wanted))


def test_a_red_line_lies_where_it_will_be_folded_on_the_cloth_as_it_is(view: View3D, letter: Plan) -> None:
    # 0.39 m from the near edge. One layer lies there before the blue fold, two after it.
    blue = performed(letter, BLUE)
    folded_s = blue.end_s - 1e-6
    moments = ((0.0, letter.task.start.placement, 1), (folded_s, blue.after.placement, 2))
    for t_s, placement, layers in moments:
        view.show(Timeline.of(letter).at(t_s))
        drawn = line(view, RED)
        assert drawn[..., 0] == pytest.approx(np.full(drawn.shape[:2], placement.x_m + 0.39), abs=1e-6)
        assert drawn[..., 2] == pytest.approx(np.full(drawn.shape[:2], layers * LAYER_M + ABOVE_M), abs=1e-6)


def test_once_folded_a_line_is_gone(view: View3D, letter: Plan) -> None:
    red = performed(letter, RED)
    view.show(Timeline.of(letter).at(red.start_s + red.duration_s / 2))
    assert len(line(view, BLUE)) == 0 and len(line(view, RED)) > 0
    view.show(Timeline.of(letter).at(Timeline.of(letter).duration_s))
    assert len(line(view, RED)) == 0


def test_while_a_red_fold_is_made_the_cloth_under_its_flap_lies_still(view: View3D, letter: Plan) -> None:
    red = performed(letter, RED)
    shown = []
    # At first the wrists may turn in their grips: then nothing has been folded yet.
    for share in np.linspace(0.2, 0.98, 15):
        view.show(Timeline.of(letter).at(red.start_s + float(share) * red.duration_s))
        handle = view._server.scene.get_handle_by_name("/cloth/front")
        assert isinstance(handle, viser.MeshHandle)
        corners = np.asarray(handle.vertices, dtype=np.float64)
        # Layer 0 lies at one gap over the table, its front up; what of the flap stays, layer 1, at two, its front down.
        shown.append(
            [
                {tuple(c) for c in np.round(corners[np.isclose(corners[:, 2], z, atol=1e-5)], 5).tolist()}
                for z in (LAYER_M + FACE_M, 2 * LAYER_M - FACE_M)
            ]
        )
    assert all(len(layer) >= 4 for layer in shown[0])
    assert all(still == shown[0] for still in shown)
