"""The 3D view's scene, with a second implementation of kinematics as reference for the robot."""

import http
import urllib.error
import urllib.request
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
import viser
import yourdfpy
from numpy.typing import NDArray
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from app.ui.colours import DARK, LIGHT
from app.ui.lighting import ink, paint
from app.ui.robot_model import load_robot_model
from app.ui.view_3d import View3D
from app.ui.viser_patches import LOOPBACK, SECRET_HEADER
from planner import Plan, Scene, load_garment
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.motion.cloth_surface import spread_cloth
from planner.motion.timeline import Timeline
from planner.robots.load_robot import load_robot
from tests.app.pose_matrix import matrix
from tests.patience import PATIENCE_S
from tests.replay.planned import shipped_plan
from tests.required import required

CARD = load_robot("pr2").card
SUBPROTOCOL = Subprotocol("viser-v1.1.1")


@pytest.fixture(scope="module")
def view() -> Iterator[View3D]:
    made = View3D(CARD, Scene())
    yield made
    made.close()


@pytest.fixture(scope="module")
def plan() -> Plan:
    return shipped_plan("t-shirt")


def shown_pose(view: View3D, node: str) -> NDArray[np.float64]:
    """Return a node's pose in the table frame, from the poses of all nodes above it."""
    placed = np.eye(4)
    parts = node.strip("/").split("/")
    for depth in range(1, len(parts) + 1):
        handle = view._server.scene.get_handle_by_name("/" + "/".join(parts[:depth]))
        if handle is not None:
            placed = placed @ matrix(handle.position, handle.wxyz)
    return placed


def test_without_cloth_the_robot_waits_as_it_does_with_cloth(view: View3D, plan: Plan) -> None:
    garment, scene = load_garment("t-shirt"), Scene()
    base = dict(scene.stations)["front"]
    view.show_plan(plan)
    view.show(Timeline.of(plan).at(Timeline.of(plan).duration_s))
    view.show_bare(base)
    handle = view._server.scene.get_handle_by_name
    assert [required(handle(f"/cloth/{part}")).visible for part in ("front", "back", "shade", "edges")] == [False] * 4
    assert handle("/folds/0") is None
    waiting = shown_pose(view, "/robot/l_gripper_tool_frame")
    view.show_garment(garment, spread_cloth(garment, scene.table), base)
    assert [required(handle(f"/cloth/{part}")).visible for part in ("front", "back", "shade", "edges")] == [True] * 4
    assert handle("/folds/0") is not None
    np.testing.assert_allclose(shown_pose(view, "/robot/l_gripper_tool_frame"), waiting, atol=1e-9)


def test_every_link_stands_where_forward_kinematics_says(view: View3D, plan: Plan) -> None:
    urdf = yourdfpy.URDF.load(str(CARD.urdf_path), load_meshes=False, build_collision_scene_graph=False)
    view.show_plan(plan)
    for t_s in np.linspace(0.0, Timeline.of(plan).duration_s, 5):
        frame = Timeline.of(plan).at(float(t_s))
        view.show(frame)
        urdf.update_cfg(frame.joints)
        root = shown_pose(view, "/robot")
        np.testing.assert_allclose(root[:3, 3], [frame.base.x_m, frame.base.y_m, -0.79], atol=1e-9)
        for link in load_robot_model(CARD.urdf_path, CARD.package_dir):
            expected = root @ urdf.get_transform(link.name)
            np.testing.assert_allclose(shown_pose(view, "/robot" + link.node), expected, atol=1e-6)


def test_all_parts_of_the_scene_have_their_nodes(view: View3D, plan: Plan) -> None:
    view.show_plan(plan)
    view.show(Timeline.of(plan).at(0.0))
    for node in ("/floor", "/table/top", "/cloth/front", "/cloth/back", "/folds/4", "/robot"):
        assert view._server.scene.get_handle_by_name(node) is not None, node


def test_cloth_that_lies_casts_its_shadow_from_inside_the_table_and_raised_cloth_from_the_air(
    view: View3D, plan: Plan
) -> None:
    shade = view._server.scene.get_handle_by_name("/cloth/shade")
    assert isinstance(shade, viser.MeshHandle) and shade.cast_shadow and shade.opacity == 0.0
    fold = next(step for step in plan.steps if step.fold is not None)
    highest_m = []
    view.show_plan(plan)
    for t_s in (0.0, fold.start_s + fold.duration_s / 2):
        view.show(Timeline.of(plan).at(t_s))
        highest_m.append(float(shade.vertices[:, 2].max() + shade.position[2]))
    assert highest_m[0] < 0.0 < highest_m[1]


def test_fold_lines_go_as_folds_are_done(view: View3D, plan: Plan) -> None:
    view.show_plan(plan)
    lines = [view._server.scene.get_handle_by_name(f"/folds/{i}") for i in range(len(plan.garment.folds))]
    view.show(Timeline.of(plan).at(0.0))
    assert all(line is not None and line.visible for line in lines)
    view.show(Timeline.of(plan).at(Timeline.of(plan).duration_s))
    assert not any(line is None or line.visible for line in lines)


def line_points(view: View3D, index: int) -> NDArray[np.float64]:
    line = view._server.scene.get_handle_by_name(f"/folds/{index}")
    assert isinstance(line, viser.LineSegmentsHandle)
    return np.asarray(line.points, dtype=np.float64) if line.visible else np.zeros((0, 2, 3))


def test_fold_lines_are_where_they_are_however_one_came_there(view: View3D, plan: Plan) -> None:
    timeline = Timeline.of(plan)
    folds = range(len(plan.garment.folds))
    for t_s in np.linspace(0.0, timeline.duration_s, 12):
        view.show_plan(plan)
        view.show(timeline.at(float(t_s)))
        jumped = [line_points(view, i) for i in folds]
        view.show_plan(plan)
        view.show(timeline.at(0.0))
        view.show(timeline.at(float(t_s)))
        for before, after in zip(jumped, (line_points(view, i) for i in folds), strict=True):
            np.testing.assert_array_equal(before, after)


def test_fold_lines_lie_on_the_cloth_all_through(view: View3D, plan: Plan) -> None:
    timeline = Timeline.of(plan)
    view.show_plan(plan)
    for t_s in np.linspace(0.0, timeline.duration_s, 40):
        frame = timeline.at(float(t_s))
        view.show(frame)
        layers = int(frame.cloth.layers.max()) + 1
        for i in range(len(plan.garment.folds)):
            points = line_points(view, i)
            heights = points[..., 2][frame.top.beyond(points) == 0.0]
            assert np.all(heights <= layers * plan.garment.layer_m + 0.003 + 1e-6)


@pytest.mark.parametrize("name", ["t-shirt", "letter-towel", "big-towel", "vest"])
def test_nothing_is_left_to_see_but_robot_and_cloth_at_the_end(view: View3D, name: str) -> None:
    plan = shipped_plan(name)
    view.show_plan(plan)
    view.show(Timeline.of(plan).at(Timeline.of(plan).duration_s / 2))
    assert view._server.scene.get_handle_by_name("/primitive/left/path") is not None
    view.show(Timeline.of(plan).at(Timeline.of(plan).duration_s))
    assert not any(len(line_points(view, i)) for i in range(len(plan.garment.folds)))
    marks = [f"/primitive/{arm.name}/{part}" for arm in CARD.arms for part in ("pick", "place", "path")]
    for mark in (*marks, *(f"{node}/name" for node in view._robot.hands.values()), "/primitive/route"):
        handle = view._server.scene.get_handle_by_name(mark)
        assert handle is not None
        assert not handle.visible, mark


def test_a_fold_that_is_moved_keeps_its_line_so_that_it_does_not_flicker(view: View3D, plan: Plan) -> None:
    garment, base = plan.garment, Scene().stations[0][1]
    cloth = spread_cloth(garment, Scene().table)
    view.show_garment(garment, cloth, base)
    line, before = view._server.scene.get_handle_by_name("/folds/0"), line_points(view, 0)
    first, *others = garment.folds
    moved = replace(first, start=(first.start[0], first.start[1] + 0.05))
    view.show_garment(replace(garment, folds=(moved, *others)), cloth, base)
    assert view._server.scene.get_handle_by_name("/folds/0") is line
    assert len(line_points(view, 0)) < len(before)  # 0.05 m shorter, in steps of 0.01 m
    view.show_garment(replace(garment, folds=(first, *others[:-1], replace(others[-1], kind="red"))), cloth, base)
    assert view._server.scene.get_handle_by_name("/folds/0") is not line


def test_a_hands_letter_goes_along_with_it(view: View3D, plan: Plan) -> None:
    for arm in CARD.arms:
        assert view._robot.hands[arm.name].endswith(arm.tool_frame)


def test_a_theme_colours_the_whole_3d_view(view: View3D, plan: Plan) -> None:
    view.show_plan(plan)
    scene = view._server.scene
    for is_dark, palette in ((True, DARK), (False, LIGHT)):
        view.set_theme(is_dark=is_dark)
        front, line = scene.get_handle_by_name("/cloth/front"), scene.get_handle_by_name("/folds/0")
        assert isinstance(front, viser.MeshHandle) and isinstance(line, viser.LineSegmentsHandle)
        assert tuple(front.color) == paint(palette.cloth_front)
        assert tuple(line.colors) == tuple(ink(palette.folds["blue"]))


def test_drags_and_folds_lead_to_the_plans_own_end(plan: Plan) -> None:
    timeline, end = Timeline.of(plan), plan.final_placement
    assert end is not None
    assert plan.end.done == (1 << len(plan.garment.folds)) - 1
    last = timeline.at(timeline.duration_s).placement
    np.testing.assert_allclose([last.x_m, last.y_m], [end.x_m, end.y_m], atol=1e-9)


def test_another_scene_has_another_table_and_another_floor(view: View3D, plan: Plan) -> None:
    scene = view._server.scene
    other = replace(Scene(), table=Table(1.0, 0.8, 0.9), stations=(("corner", Pose2(-0.8, 0.3, 0.0)),))
    try:
        view.show_scene(other)
        view.show_garment(plan.garment, spread_cloth(plan.garment, other.table), other.stations[0][1])
        top = scene.get_handle_by_name("/table/top")
        assert isinstance(top, viser.BoxHandle) and tuple(top.dimensions[:2]) == (1.0, 0.8)
        assert shown_pose(view, "/robot")[2, 3] == pytest.approx(-0.9)
    finally:
        view.show_scene(Scene())


def test_the_3d_views_own_port_answers_nobody_without_the_secret(view: View3D) -> None:
    address = f"{LOOPBACK}:{view.port}"
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(f"http://{address}/")
    assert refused.value.code == http.HTTPStatus.FORBIDDEN
    refused.value.close()
    for headers in ({}, {SECRET_HEADER: "guess"}, {"Origin": f"http://{address}"}):
        with pytest.raises(InvalidStatus) as denied:
            connect(f"ws://{address}", subprotocols=[SUBPROTOCOL], additional_headers=headers, proxy=None)
        assert denied.value.response.status_code == http.HTTPStatus.FORBIDDEN


def test_the_3d_views_own_port_opens_with_the_secret(view: View3D) -> None:
    address = f"ws://{LOOPBACK}:{view.port}"
    headers = {SECRET_HEADER: view.secret}
    with connect(address, subprotocols=[SUBPROTOCOL], additional_headers=headers, proxy=None, max_size=None) as opened:
        assert isinstance(opened.recv(timeout=PATIENCE_S), bytes)


def test_two_3d_views_stand_side_by_side(view: View3D) -> None:
    other = View3D(CARD, Scene())
    try:
        assert other.port != view.port
        assert other.secret != view.secret
    finally:
        other.close()
