"""Scenes: defaults, JSON, and refusals of invalid ones."""

import math

import pytest

from planner.errors import SceneError
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.task.scene import Scene


def test_the_default_scene_is_the_one_in_which_the_nine_plan() -> None:
    data = Scene().to_dict()
    assert data["table"] == {"depth_m": 1.6, "width_m": 0.98, "height_m": 0.79}
    assert list(data["stations"]) == ["front", "front_left", "left", "front_right", "right"]
    assert data["stations"]["front"] == {"x_m": -0.95, "y_m": 0.0, "yaw_rad": 0.0}
    assert (data["torso_m"], data["friction"], data["back_off_max_m"]) == (0.29, 1.0, 0.8)
    assert math.degrees(data["support_angle_rad"]) == pytest.approx(5.0)
    assert math.degrees(data["approach_cone_rad"]) == pytest.approx(75.0)
    assert (data["arm_motion_s"], data["base_speed_m_s"], data["base_turn_rad_s"]) == (3.0, 0.25, 0.5)


def test_the_right_stations_mirror_the_left_ones() -> None:
    stations = dict(Scene().stations)
    for left, right in (("front_left", "front_right"), ("left", "right")):
        one, other = stations[left], stations[right]
        assert (other.x_m, other.y_m, other.yaw_rad) == (one.x_m, -one.y_m, -one.yaw_rad)


def test_a_scene_as_json_is_read_back_the_same() -> None:
    assert Scene.from_dict(Scene().to_dict()) == Scene()
    assert Scene.from_dict({}) == Scene()
    assert Scene.from_dict({"table": None, "friction": None}) == Scene()


def test_given_stations_replace_the_five() -> None:
    scene = Scene.from_dict({"stations": {"here": {"x_m": -1, "y_m": 0, "yaw_rad": 0}}})
    assert scene.stations == (("here", Pose2(-1.0, 0.0, 0.0)),)


def test_a_table_given_in_part_keeps_the_rest() -> None:
    table = Scene.from_dict({"table": {"width_m": 1.2}}).table
    assert (table.depth_m, table.width_m, table.height_m) == (1.6, 1.2, 0.79)


@pytest.mark.parametrize(
    ("data", "field"),
    [
        ({"colour": 1}, "colour"),
        ({"table": {"size_m": 1}}, "table.size_m"),
        ({"table": {"depth_m": 0.0}}, "table.depth_m"),
        ({"table": {"width_m": "1"}}, "table.width_m"),
        ({"table": 3}, "table"),
        ({"stations": {}}, "stations"),
        ({"stations": {"a": {"x_m": 0, "y_m": 0}}}, "stations.a.yaw_rad"),
        ({"stations": {"a": {"x_m": 11, "y_m": 0, "yaw_rad": 0}}}, "stations.a.x_m"),
        ({"stations": {"a": {"x_m": True, "y_m": 0, "yaw_rad": 0}}}, "stations.a.x_m"),
        ({"stations": {"a": {"x_m": "0.5", "y_m": 0, "yaw_rad": 0}}}, "stations.a.x_m"),
        ({"stations": {f"s{i}": {"x_m": 0, "y_m": 0, "yaw_rad": 0} for i in range(65)}}, "stations"),
        ({"friction": -0.1}, "friction"),
        ({"friction": True}, "friction"),
        ({"friction": math.nan}, "friction"),
        ({"torso_m": 1.5}, "torso_m"),
        ({"support_angle_rad": math.radians(86)}, "support_angle_rad"),
        ({"support_angle_rad": -0.01}, "support_angle_rad"),
        ({"approach_cone_rad": 4.0}, "approach_cone_rad"),
        ({"back_off_max_m": -0.05}, "back_off_max_m"),
        ({"edge_clear_m": -0.01}, "edge_clear_m"),
        ({"edge_clear_m": 0.11}, "edge_clear_m"),
        ({"arm_motion_s": 0.0}, "arm_motion_s"),
        ({"grip_dwell_s": -0.1}, "grip_dwell_s"),
        ({"base_speed_m_s": 0.0}, "base_speed_m_s"),
        ({"base_turn_rad_s": -1.0}, "base_turn_rad_s"),
    ],
)
def test_what_is_no_scene_is_refused_by_its_field(data: dict[str, object], field: str) -> None:
    with pytest.raises(SceneError) as caught:
        Scene.from_dict(data)
    assert caught.value.field == field


def test_a_table_built_directly_is_held_to_the_same() -> None:
    with pytest.raises(SceneError, match=r"width_m: 11\.0 is not between 0\.1 and 10"):
        Table(width_m=11.0)


@pytest.mark.parametrize("value", ["1", True, [1.0]])
def test_a_scene_built_directly_of_what_is_no_number_is_refused_by_its_field(value: object) -> None:
    with pytest.raises(SceneError) as caught:
        Scene(torso_m=value)  # type: ignore[arg-type]
    assert caught.value.field == "torso_m" and "is no number" in caught.value.message
