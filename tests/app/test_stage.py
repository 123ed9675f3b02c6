"""The stage's scene, with a second implementation of kinematics as reference for the robot."""

import http
import urllib.error
import urllib.request
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
import yourdfpy
from numpy.typing import NDArray
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from app.ui.colours import DARK, LIGHT
from app.ui.lighting import ink, paint
from app.ui.lying_cloth import lying_cloth
from app.ui.robot_model import load_robot_model
from app.ui.stage import Stage
from app.ui.viser_patches import LOOPBACK, SECRET_HEADER
from planner import Plan, Scene, load_garment, make_plan
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.motion.cloth_surface import LAYER_GAP_M
from planner.motion.timeline import Timeline
from planner.robots.load_robot import load_robot
from tests.app.pose_matrix import matrix

CARD = load_robot("pr2").card
SUBPROTOCOL = "viser-v1.1.1"


@pytest.fixture(scope="module")
def stage() -> Iterator[Stage]:
    made = Stage(CARD, Scene())
    yield made
    made.close()


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(load_garment("t-shirt"))


def shown_pose(stage: Stage, node: str) -> NDArray[np.float64]:
    """Return a node's pose in the table frame, from the poses of all nodes above it."""
    placed = np.eye(4)
    parts = node.strip("/").split("/")
    for depth in range(1, len(parts) + 1):
        handle = stage._server.scene.get_handle_by_name("/" + "/".join(parts[:depth]))
        if handle is not None:
            placed = placed @ matrix(handle.position, handle.wxyz)
    return placed


def test_without_cloth_the_robot_waits_as_it_does_with_cloth(stage: Stage, plan: Plan) -> None:
    garment, scene = load_garment("t-shirt"), Scene()
    base = dict(scene.stations)["front"]
    stage.show_plan(plan)
    stage.show(Timeline.of(plan).at(Timeline.of(plan).duration_s))
    stage.show_bare(base)
    handle = stage._server.scene.get_handle_by_name
    assert [handle(f"/cloth/{part}").visible for part in ("front", "back", "edges")] == [False] * 3
    assert handle("/folds/0") is None
    waiting = shown_pose(stage, "/robot/l_gripper_tool_frame")
    stage.show_garment(garment, lying_cloth(garment, scene.table), base)
    assert [handle(f"/cloth/{part}").visible for part in ("front", "back", "edges")] == [True] * 3
    assert handle("/folds/0") is not None
    np.testing.assert_allclose(shown_pose(stage, "/robot/l_gripper_tool_frame"), waiting, atol=1e-9)


def test_every_link_stands_where_forward_kinematics_says(stage: Stage, plan: Plan) -> None:
    urdf = yourdfpy.URDF.load(str(CARD.urdf_path), load_meshes=False, build_collision_scene_graph=False)
    stage.show_plan(plan)
    for t_s in np.linspace(0.0, Timeline.of(plan).duration_s, 5):
        frame = Timeline.of(plan).at(float(t_s))
        stage.show(frame)
        urdf.update_cfg(frame.joints)
        root = shown_pose(stage, "/robot")
        np.testing.assert_allclose(root[:3, 3], [frame.base.x_m, frame.base.y_m, -0.79], atol=1e-9)
        for link in load_robot_model(CARD.urdf_path, CARD.package_dir):
            expected = root @ urdf.get_transform(link.name)
            np.testing.assert_allclose(shown_pose(stage, "/robot" + link.node), expected, atol=1e-6)


def test_all_parts_of_the_scene_have_their_nodes(stage: Stage, plan: Plan) -> None:
    stage.show_plan(plan)
    stage.show(Timeline.of(plan).at(0.0))
    for node in ("/floor", "/table/top", "/stations/front", "/cloth/front", "/cloth/back", "/folds/4", "/robot"):
        assert stage._server.scene.get_handle_by_name(node) is not None, node


def test_fold_lines_go_as_folds_are_done(stage: Stage, plan: Plan) -> None:
    stage.show_plan(plan)
    lines = [stage._server.scene.get_handle_by_name(f"/folds/{i}") for i in range(len(plan.garment.folds))]
    stage.show(Timeline.of(plan).at(0.0))
    assert all(line is not None and line.visible for line in lines)
    stage.show(Timeline.of(plan).at(Timeline.of(plan).duration_s))
    assert not any(line is None or line.visible for line in lines)


def line_points(stage: Stage, index: int) -> NDArray[np.float64]:
    line = stage._server.scene.get_handle_by_name(f"/folds/{index}")
    assert line is not None
    return np.asarray(line.points, dtype=float) if line.visible else np.zeros((0, 2, 3))


def test_fold_lines_are_where_they_are_however_one_came_there(stage: Stage, plan: Plan) -> None:
    timeline = Timeline.of(plan)
    folds = range(len(plan.garment.folds))
    for t_s in np.linspace(0.0, timeline.duration_s, 12):
        stage.show_plan(plan)
        stage.show(timeline.at(float(t_s)))
        jumped = [line_points(stage, i) for i in folds]
        stage.show_plan(plan)
        stage.show(timeline.at(0.0))
        stage.show(timeline.at(float(t_s)))
        for before, after in zip(jumped, (line_points(stage, i) for i in folds), strict=True):
            np.testing.assert_array_equal(before, after)


def test_fold_lines_lie_on_the_cloth_all_through(stage: Stage, plan: Plan) -> None:
    timeline = Timeline.of(plan)
    stage.show_plan(plan)
    for t_s in np.linspace(0.0, timeline.duration_s, 40):
        frame = timeline.at(float(t_s))
        stage.show(frame)
        layers = int(frame.cloth.layers.max()) + 1
        for i in range(len(plan.garment.folds)):
            points = line_points(stage, i)
            heights = points[..., 2][frame.top.beyond(points) == 0.0]
            assert np.all(heights <= layers * LAYER_GAP_M + 0.003 + 1e-6)


@pytest.mark.parametrize("name", ["t-shirt", "letter-towel", "big-towel", "vest"])
def test_nothing_is_left_to_see_but_robot_and_cloth_at_the_end(stage: Stage, name: str) -> None:
    plan = make_plan(load_garment(name))
    stage.show_plan(plan)
    stage.show(Timeline.of(plan).at(Timeline.of(plan).duration_s / 2))
    assert stage._server.scene.get_handle_by_name("/primitive/left/path") is not None
    stage.show(Timeline.of(plan).at(Timeline.of(plan).duration_s))
    assert not any(len(line_points(stage, i)) for i in range(len(plan.garment.folds)))
    marks = [f"/primitive/{arm.name}/{part}" for arm in CARD.arms for part in ("pick", "place", "path")]
    for mark in (*marks, *(f"{node}/name" for node in stage._robot.hands.values()), "/primitive/route"):
        handle = stage._server.scene.get_handle_by_name(mark)
        assert handle is not None
        assert not handle.visible, mark


def test_a_fold_that_is_moved_keeps_its_line_so_that_it_does_not_flicker(stage: Stage, plan: Plan) -> None:
    garment, base = plan.garment, Scene().stations[0][1]
    cloth = lying_cloth(garment, Scene().table)
    stage.show_garment(garment, cloth, base)
    line, before = stage._server.scene.get_handle_by_name("/folds/0"), line_points(stage, 0)
    first, *others = garment.folds
    moved = replace(first, start=(first.start[0], first.start[1] + 0.05))
    stage.show_garment(replace(garment, folds=(moved, *others)), cloth, base)
    assert stage._server.scene.get_handle_by_name("/folds/0") is line
    assert len(line_points(stage, 0)) < len(before)  # 0.05 m shorter, in steps of 0.01 m
    stage.show_garment(replace(garment, folds=(first, *others[:-1], replace(others[-1], kind="red"))), cloth, base)
    assert stage._server.scene.get_handle_by_name("/folds/0") is not line


def test_a_hands_letter_goes_along_with_it(stage: Stage, plan: Plan) -> None:
    for arm in CARD.arms:
        assert stage._robot.hands[arm.name].endswith(arm.tool_frame)


def test_a_theme_colours_the_whole_stage(stage: Stage, plan: Plan) -> None:
    stage.show_plan(plan)
    scene = stage._server.scene
    for is_dark, palette in ((True, DARK), (False, LIGHT)):
        stage.set_theme(is_dark=is_dark)
        front, line = scene.get_handle_by_name("/cloth/front"), scene.get_handle_by_name("/folds/0")
        assert front is not None and line is not None
        assert tuple(front.color) == paint(palette.cloth_front)
        assert tuple(line.colors) == tuple(ink(palette.fold_blue))


def test_stations_are_named_in_the_readers_language_whatever_robot_comes(stage: Stage) -> None:
    def label(station: str) -> str:
        found = stage._server.scene.get_handle_by_name(f"/stations/{station}/name")
        assert found is not None
        return str(found.text)

    own = replace(Scene(), stations=(*Scene().stations, ("by_the_door", Pose2(-0.8, 0.3, 0.0))))
    try:
        assert label("front_left") == "front left"
        stage.set_language("de")
        assert label("front_left") == "vorn links"
        stage.show_scene(own)
        assert label("front_left") == "vorn links"
        assert label("by_the_door") == "by the door"
        stage.set_language("es")
        assert label("front_left") == "frente izquierda"
    finally:
        stage.show_scene(Scene())
        stage.set_language("en")


def test_drags_and_folds_lead_to_the_plans_own_end(plan: Plan) -> None:
    timeline, end = Timeline.of(plan), plan.final_placement
    assert end is not None
    assert plan.end.done == (1 << len(plan.garment.folds)) - 1
    last = timeline.at(timeline.duration_s).placement
    np.testing.assert_allclose([last.x_m, last.y_m], [end.x_m, end.y_m], atol=1e-9)


def test_another_scene_has_another_table_other_stations_and_another_floor(stage: Stage, plan: Plan) -> None:
    scene = stage._server.scene
    other = replace(Scene(), table=Table(1.0, 0.8, 0.9), stations=(("corner", Pose2(-0.8, 0.3, 0.0)),))
    try:
        stage.show_scene(other)
        stage.show_garment(plan.garment, lying_cloth(plan.garment, other.table), other.stations[0][1])
        top = scene.get_handle_by_name("/table/top")
        assert top is not None and tuple(top.dimensions[:2]) == (1.0, 0.8)
        assert scene.get_handle_by_name("/stations/corner") is not None
        assert scene.get_handle_by_name("/stations/front") is None
        assert shown_pose(stage, "/robot")[2, 3] == pytest.approx(-0.9)
    finally:
        stage.show_scene(Scene())
    assert scene.get_handle_by_name("/stations/front") is not None


def test_the_stages_own_port_answers_nobody_without_the_secret(stage: Stage) -> None:
    address = f"{LOOPBACK}:{stage.port}"
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(f"http://{address}/")
    assert refused.value.code == http.HTTPStatus.FORBIDDEN
    refused.value.close()
    for headers in ({}, {SECRET_HEADER: "guess"}, {"Origin": f"http://{address}"}):
        with pytest.raises(InvalidStatus) as denied:
            connect(f"ws://{address}", subprotocols=[SUBPROTOCOL], additional_headers=headers, proxy=None)
        assert denied.value.response.status_code == http.HTTPStatus.FORBIDDEN


def test_the_stages_own_port_opens_with_the_secret(stage: Stage) -> None:
    address = f"ws://{LOOPBACK}:{stage.port}"
    headers = {SECRET_HEADER: stage.secret}
    with connect(address, subprotocols=[SUBPROTOCOL], additional_headers=headers, proxy=None, max_size=None) as opened:
        assert isinstance(opened.recv(timeout=5.0), bytes)


def test_two_stages_stand_side_by_side(stage: Stage) -> None:
    other = Stage(CARD, Scene())
    try:
        assert other.port != stage.port
        assert other.secret != stage.secret
    finally:
        other.close()


def test_stations_are_marked_for_a_robot_that_drives_alone(stage: Stage) -> None:
    handle = stage._server.scene.get_handle_by_name
    assert handle("/stations/front") is not None
    try:
        stage.show_robot(load_robot("so101-pair").card)
        assert handle("/stations/front") is None
        assert handle("/table/top") is not None
    finally:
        stage.show_robot(load_robot("pr2").card)
    assert handle("/stations/front") is not None
