"""What a stage shows, asked of its own scene and, for the robot, of a second opinion on kinematics."""

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

from app.ui.cloth_view import outlines
from app.ui.colours import DARK, LIGHT, Palette
from app.ui.dashes import dash_dot, solid, split_at
from app.ui.lighting import ink, paint, seen
from app.ui.lying_cloth import lying_cloth
from app.ui.private_viser import LOOPBACK, SECRET_HEADER
from app.ui.progress import stints
from app.ui.relief import Relief
from app.ui.robot_model import load_robot_model
from app.ui.rotation import from_matrix, product, turn
from app.ui.stage import Stage
from planner import Plan, Scene, load_garment, make_plan
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.geometry.table_top import TableTop
from planner.plan.cloth_surface import LAYER_GAP_M
from planner.plan.frame import ClothSurface
from planner.robot.pr2 import load_robot

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


def matrix(position: object, wxyz: object) -> NDArray[np.float64]:
    w, x, y, z = np.asarray(wxyz, dtype=float)
    placed = np.eye(4)
    placed[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    placed[:3, 3] = np.asarray(position, dtype=float)
    return placed


def shown_pose(stage: Stage, node: str) -> NDArray[np.float64]:
    """A node's pose in the table frame, from the poses of all nodes above it."""
    placed = np.eye(4)
    parts = node.strip("/").split("/")
    for depth in range(1, len(parts) + 1):
        handle = stage._server.scene.get_handle_by_name("/" + "/".join(parts[:depth]))
        if handle is not None:
            placed = placed @ matrix(handle.position, handle.wxyz)
    return placed


def test_every_link_stands_where_forward_kinematics_says(stage: Stage, plan: Plan) -> None:
    urdf = yourdfpy.URDF.load(str(CARD.urdf_path), load_meshes=False, build_collision_scene_graph=False)
    stage.show_plan(plan)
    for t_s in np.linspace(0.0, plan.timeline().duration_s, 5):
        frame = plan.timeline().at(float(t_s))
        stage.show(frame)
        urdf.update_cfg(frame.joints)
        root = shown_pose(stage, "/robot")
        np.testing.assert_allclose(root[:3, 3], [frame.base.x_m, frame.base.y_m, -0.79], atol=1e-9)
        for link in load_robot_model(CARD.urdf_path, CARD.package_dir):
            expected = root @ urdf.get_transform(link.name)
            np.testing.assert_allclose(shown_pose(stage, "/robot" + link.node), expected, atol=1e-6)


def test_all_parts_of_the_scene_have_their_nodes(stage: Stage, plan: Plan) -> None:
    stage.show_plan(plan)
    stage.show(plan.timeline().at(0.0))
    for node in ("/floor", "/table/top", "/stations/front", "/cloth/front", "/cloth/back", "/folds/4", "/robot"):
        assert stage._server.scene.get_handle_by_name(node) is not None, node


def test_fold_lines_go_as_folds_are_done(stage: Stage, plan: Plan) -> None:
    stage.show_plan(plan)
    lines = [stage._server.scene.get_handle_by_name(f"/folds/{i}") for i in range(len(plan.garment.folds))]
    stage.show(plan.timeline().at(0.0))
    assert all(line is not None and line.visible for line in lines)
    stage.show(plan.timeline().at(plan.timeline().duration_s))
    assert not any(line is None or line.visible for line in lines)


def line_points(stage: Stage, index: int) -> NDArray[np.float64]:
    line = stage._server.scene.get_handle_by_name(f"/folds/{index}")
    assert line is not None
    return np.asarray(line.points, dtype=float) if line.visible else np.zeros((0, 2, 3))


def test_fold_lines_are_where_they_are_however_one_came_there(stage: Stage, plan: Plan) -> None:
    timeline = plan.timeline()
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
    timeline = plan.timeline()
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
    stage.show(plan.timeline().at(plan.timeline().duration_s / 2))
    assert stage._server.scene.get_handle_by_name("/primitive/left/path") is not None
    stage.show(plan.timeline().at(plan.timeline().duration_s))
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


@pytest.mark.parametrize("palette", [LIGHT, DARK])
def test_what_lies_level_looks_like_the_colour_asked_for(palette: Palette) -> None:
    for wanted in (palette.cloth_front, palette.cloth_back, palette.table, palette.robot_light, palette.robot_grey):
        assert np.abs(np.subtract(seen(paint(wanted)), wanted)).max() <= 2


def sheet(*layers: tuple[float, float, float]) -> ClothSurface:
    """Squares of cloth on the table, each with its near and far x and its height, from y = 0 to y = 1."""
    corners = []
    for low, high, z in layers:
        a, b, c, d = (low, 0.0, z), (high, 0.0, z), (high, 1.0, z), (low, 1.0, z)
        corners.extend([a, b, c, a, c, d])
    triangles = np.arange(len(corners)).reshape(-1, 3)
    return ClothSurface(np.array(corners), triangles, np.repeat(np.arange(len(layers)), 2))


TOP = TableTop((-1.0, -1.0), (1.0, 1.0))


def test_cloth_is_as_high_as_its_topmost_layer_there() -> None:
    relief = Relief.of(sheet((0.0, 0.8, 0.0015), (0.5, 0.9, 0.003)), TOP)
    points = np.array([[0.2, 0.5], [0.6, 0.5], [0.85, 0.5], [0.95, 0.5]])
    np.testing.assert_array_equal(relief.heights_at(points), [0.0015, 0.003, 0.003, -np.inf])


def test_cloth_in_the_air_does_not_lie() -> None:
    standing = ClothSurface(
        np.array([[0.0, 0.0, 0.0015], [0.0, 1.0, 0.0015], [0.0, 0.0, 0.5]]),
        np.array([[0, 1, 2]]),
        np.zeros(1, dtype=np.int64),
    )
    assert Relief.of(standing, TOP).heights_at(np.array([[0.0, 0.5]]))[0] == -np.inf


def test_hanging_cloth_is_rolled_back_into_the_plane() -> None:
    garment = load_garment("big-towel")
    top = TableTop.of(Scene().table)
    relief = Relief.of(lying_cloth(garment, Scene().table), top)
    a, b, c = (relief.triangles[:, i] for i in range(3))
    sides = b - a, c - a
    area = float((sides[0][:, 0] * sides[1][:, 1] - sides[0][:, 1] * sides[1][:, 0]).sum() / 2)
    assert area == pytest.approx(garment.pattern.area, rel=1e-3)


def test_a_line_is_cut_where_it_crosses_and_nowhere_else() -> None:
    segments = np.array([[[0.0, 0.0], [1.0, 1.0]], [[0.0, 0.0], [0.2, 0.0]]])
    cut = split_at(segments, 0, 0.5)
    assert len(cut) == 3
    lengths = np.linalg.norm(cut[:, 1] - cut[:, 0], axis=1)
    assert lengths.sum() == pytest.approx(np.sqrt(2.0) + 0.2)
    assert np.all((cut[..., 0].max(axis=1) <= 0.5) | (cut[..., 0].min(axis=1) >= 0.5))


def test_drags_and_folds_lead_to_the_plans_own_end(plan: Plan) -> None:
    last = stints(plan.garment.placement, [p.to_dict() for p in plan.primitives])[-1]
    end = plan.final_placement
    assert end is not None
    assert last.done_after == frozenset(range(len(plan.garment.folds)))
    after = last.placement_after
    np.testing.assert_allclose([after.x_m, after.y_m], [end.x_m, end.y_m], atol=1e-9)


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


def test_a_quaternion_from_a_matrix_is_the_same_rotation() -> None:
    random = np.random.default_rng(1)
    for _ in range(50):
        axes = [vector / np.linalg.norm(vector) for vector in random.normal(size=(2, 3))]
        angles = random.uniform(-3.0, 3.0, size=2)
        wxyz = product(turn(axes[0], angles[0]), turn(axes[1], angles[1]))
        whole = matrix((0, 0, 0), turn(axes[0], angles[0])) @ matrix((0, 0, 0), turn(axes[1], angles[1]))
        np.testing.assert_allclose(matrix((0, 0, 0), wxyz), whole, atol=1e-12)
        np.testing.assert_allclose(matrix((0, 0, 0), from_matrix(whole)), whole, atol=1e-12)


def test_a_squares_outline_leaves_out_the_diagonal() -> None:
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    square = ClothSurface(corners, np.arange(6).reshape(-1, 3), np.zeros(2, dtype=np.int64))
    segments = outlines(square)
    assert len(segments) == 4
    np.testing.assert_allclose(np.linalg.norm(segments[:, 0] - segments[:, 1], axis=1), 1.0)


def test_a_garment_beyond_the_edge_hangs() -> None:
    garment = load_garment("big-towel")
    hanging = lying_cloth(garment, Scene().table)
    flat = garment.pattern.area
    a, b, c = (hanging.vertices[hanging.triangles[:, i]] for i in range(3))
    area = float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)
    assert area == pytest.approx(flat, rel=1e-3)
    assert np.abs(hanging.vertices[:, 0]).max() <= 0.8 + 0.01


def test_a_solid_line_has_no_gaps_and_a_dashed_one_has() -> None:
    start, end = np.array([0.0, 0.0]), np.array([0.3, 0.4])
    whole, dashed = solid(start, end), dash_dot(start, end)
    length = np.linalg.norm(whole[:, 1] - whole[:, 0], axis=1).sum()
    assert length == pytest.approx(0.5)
    assert np.linalg.norm(dashed[:, 1] - dashed[:, 0], axis=1).sum() < 0.45
    np.testing.assert_allclose(whole[-1, 1], end)
