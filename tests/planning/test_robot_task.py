"""Tasks that take scene and placement from the robot's card."""

import math
from typing import Any

import numpy as np
import pytest

from planner import Scene, load_garment
from planner.errors import RequestError
from planner.planning.robot_task import default_placement, default_scene, task_for, with_robots_scene
from planner.robots.load_robot import robot_card_file
from tests.builders import garment


def test_the_default_robot_has_the_default_scene() -> None:
    assert default_scene() == Scene()


def test_the_card_of_the_default_robot_says_the_same_scene() -> None:
    suits = default_scene("pr2")
    assert (suits.table, suits.stations, suits.torso_m) == (Scene().table, Scene().stations, Scene().torso_m)


def test_a_robot_whose_base_is_fixed_has_one_station_and_no_standoff() -> None:
    scene = default_scene("ur5e-pair")
    assert [name for name, _ in scene.stations] == ["edge"]
    assert scene.back_off_max_m == 0.0
    assert (scene.table.depth_m, scene.table.width_m, scene.table.height_m) == (0.8, 1.0, 0.75)


def test_a_garment_lies_where_another_robots_card_says_turned_as_drawn() -> None:
    towel = load_garment("hand-towel")
    placed, suits = default_placement(towel, "ur5e-pair"), robot_card_file("ur5e-pair").scene.placement
    corners = placed.to_outer(np.array(towel.outline))
    np.testing.assert_allclose((corners.min(axis=0) + corners.max(axis=0)) / 2, [suits.x_m, suits.y_m], atol=1e-12)
    assert placed.yaw_rad == towel.placement.yaw_rad


def test_a_garment_that_the_table_has_room_for_lies_on_it() -> None:
    shirt, table = load_garment("t-shirt"), default_scene("ur5e-pair").table
    corners = np.abs(default_placement(shirt, "ur5e-pair").to_outer(np.array(shirt.outline))).max(axis=0)
    assert (corners <= [table.depth_m / 2 + 1e-9, table.width_m / 2 + 1e-9]).all()


def test_a_garment_that_is_longer_than_the_table_is_deep_lies_across_it() -> None:
    tie = garment([(0.0, 0.0), (0.1, 0.0), (0.1, 0.95), (0.0, 0.95)])
    corners = default_placement(tie, "ur5e-pair").to_outer(np.array(tie.outline))
    assert np.ptp(corners[:, 1]) == pytest.approx(0.95)


def test_a_garment_lies_for_the_default_robot_where_its_file_says() -> None:
    shirt = load_garment("t-shirt")
    assert task_for(shirt).start.placement == shirt.placement


def test_a_task_for_another_robot_starts_at_its_first_station() -> None:
    task = task_for(load_garment("hand-towel"), robot="tiago-pro")
    assert task.start.base.station == "front"
    assert task.scene == default_scene("tiago-pro")


def test_a_scene_given_in_part_is_filled_up_by_the_robots() -> None:
    request = {"garment": "tie", "robot": "ur5e-pair", "scene": {"friction": 0.5, "table": {"depth_m": 0.7}}}
    scene = Scene.from_dict(with_robots_scene(request)["scene"])
    assert (scene.friction, scene.table.depth_m, scene.table.width_m, scene.torso_m) == (0.5, 0.7, 1.0, 0.0)


@pytest.mark.parametrize(
    "request_", [{"scene": {"friction": 0.5}}, {"robot": "nobody", "scene": {}}, {"robot": 3, "scene": {}}, [], None]
)
def test_what_is_for_the_default_robot_or_wrong_is_left_as_it_is(request_: Any) -> None:
    assert with_robots_scene(request_) == request_


def test_there_is_no_task_for_a_robot_that_nobody_described() -> None:
    with pytest.raises(RequestError, match="no robot 'nobody', only baxter"):
        task_for(load_garment("tie"), robot="nobody")


def test_a_placement_turns_with_the_card(monkeypatch: pytest.MonkeyPatch) -> None:
    towel = load_garment("hand-towel")
    assert default_placement(towel, "so101-pair").yaw_rad == pytest.approx(-math.pi / 2)
