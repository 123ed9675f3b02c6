"""The first picture shows the whole table and robot, whatever its shape."""

import math

import numpy as np
import pytest

from app.ui.opening import bench, opening, whole
from app.ui.robot_model import waiting_box
from app.ui.viewpoint import FOV_RAD, Viewpoint
from planner import Scene
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.planning.robot_task import default_scene
from planner.robots.load_robot import load_robot

FRONT = Pose2(-0.95, 0.0, 0.0)
ASPECTS = [0.46, 0.57, 0.85, 1.0, 1.6, 2.2]


def in_picture(viewpoint: Viewpoint, points: FloatArray, aspect: float) -> FloatArray:
    """Return points as fractions of the way from the middle of the picture to its edges, shape (n, 2)."""
    middle, eye = np.array(viewpoint.look_at), np.array(viewpoint.position)
    ahead = (middle - eye) / np.linalg.norm(middle - eye)
    right = np.cross(ahead, (0.0, 0.0, 1.0)) / np.hypot(*ahead[:2])
    depth = (points - eye) @ ahead
    assert (depth > 0.0).all()
    half = math.tan(viewpoint.fov_rad / 2)
    across, upwards = (points - eye) @ right / depth, (points - eye) @ np.cross(right, ahead) / depth
    return np.column_stack([across / (aspect * half), upwards / half])


@pytest.mark.parametrize("aspect", ASPECTS)
def test_at_first_table_and_robot_are_seen_whole(aspect: float) -> None:
    table = Table()
    corners = [(x, y, z) for x, y in table.corners for z in (0.0, -table.height_m)]
    # The PR2's base is 0.67 m square; with the torso up its head reaches 1.65 m above the floor.
    away_m = Scene().back_off_max_m
    base = [(x, y, -table.height_m) for x in (-0.95 - away_m - 0.34, -0.95 + 0.34) for y in (-0.34, 0.34)]
    head = [(-0.95 - back_m, 0.0, 1.65 - table.height_m) for back_m in (0.0, away_m)]
    # Its arms wait 0.64 m to each side, the elbows out.
    arms = [(-0.95 + ahead_m, y, 0.6) for ahead_m in (0.0, 0.35) for y in (-0.63, 0.63)]
    seen = in_picture(opening(Scene(), aspect), np.array([*corners, *base, *head, *arms]), aspect)
    assert np.abs(seen).max() < 1.0


@pytest.mark.parametrize("aspect", ASPECTS)
def test_nothing_is_seen_from_further_off_than_it_must_be(aspect: float) -> None:
    points = whole(Scene(), FRONT)
    seen = in_picture(opening(Scene(), aspect), points, aspect)
    assert np.abs(seen).max() > 0.95


@pytest.mark.parametrize("aspect", [0.46, 1.6])
def test_a_larger_table_is_seen_whole_too(aspect: float) -> None:
    scene = Scene(table=Table(depth_m=2.4, width_m=1.6), stations=(("front", Pose2(-1.35, 0.0, 0.0)),))
    corners = np.array([(x, y, z) for x, y in scene.table.corners for z in (0.0, -scene.table.height_m)])
    assert np.abs(in_picture(opening(scene, aspect), corners, aspect)).max() < 1.0


def test_a_picture_without_a_width_does_not_send_the_camera_away() -> None:
    assert opening(Scene(), 0.0) == opening(Scene(), 0.2)


def test_wide_pictures_all_look_from_the_same_place() -> None:
    assert opening(Scene(), 1.0) == opening(Scene(), 2.2)
    assert opening(Scene(), 1.6).fov_rad == FOV_RAD


def test_the_robot_is_in_the_picture_where_it_waits() -> None:
    base = dict(Scene().stations)["left"]
    seen = in_picture(opening(Scene(), 0.46, base), whole(Scene(), base), 0.46)
    assert np.abs(seen).max() < 1.0


@pytest.mark.parametrize("robot", [pytest.param("so101-pair", marks=pytest.mark.long), "ur5e-pair"])
@pytest.mark.parametrize("aspect", [0.46, 1.6])
def test_arms_at_a_bench_fill_the_picture_with_all_of_its_top(robot: str, aspect: float) -> None:
    card, scene = load_robot(robot).card, default_scene(robot)
    base = scene.stations[0][1]
    seen = in_picture(opening(scene, aspect, base, card=card), bench(scene, base, card), aspect)
    assert 0.9 < np.abs(seen).max() < 1.0


def test_the_box_of_a_robot_that_waits_is_the_one_of_its_meshes() -> None:
    card, torso_m = load_robot("pr2").card, 0.29
    (x0, y0, z0), (x1, y1, z1) = waiting_box(card, torso_m)
    assert -0.4 < x0 < -0.3 and 0.3 < x1 < 1.0  # its base is 0.67 m square
    assert y0 == pytest.approx(-y1, abs=0.05) and 0.5 < y1 < 1.0
    assert abs(z0) < 0.06 and 1.55 < z1 < 1.75
