"""What of a card is allowed but probably not meant."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import trimesh

from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.robots.card_doubts import (
    ArmsCrossed,
    ArmsTogether,
    MountFacesAway,
    OddPart,
    StationFacesAway,
    StationInTable,
    card_doubts,
    stations_in_table,
)
from planner.robots.described_robot import DescribedRobot, read_described, read_robot
from planner.robots.known_robots import shipped_path, shipped_robots
from planner.robots.load_robot import load_robot
from planner.task.scene import DEFAULT_STATIONS, Scene
from tests.sweep import sweep


def changed(folder: Path, change: Callable[[dict[str, Any]], None], name: str = "panda-pair") -> DescribedRobot:
    card = json.loads(shipped_path(name).read_text())
    change(card)
    (folder / "mine.json").write_text(json.dumps(card))
    return read_described(folder / "mine.json")


@pytest.mark.parametrize("name", ["panda-pair", "so101-pair", "tiago-pro", "ur5e-pair", "ur5e-single"])
def test_a_shipped_card_leaves_no_doubt(name: str) -> None:
    assert name in shipped_robots()
    assert card_doubts(read_robot(name)) == ()


def test_arms_that_are_mounted_in_one_place_are_told(tmp_path: Path) -> None:
    def change(card: dict[str, Any]) -> None:
        card["mounts"][1] = card["mounts"][0] | {"name": card["mounts"][1]["name"]}

    assert card_doubts(changed(tmp_path, change)) == (ArmsTogether(("left", "right"), 0.0),)


@pytest.mark.parametrize(("apart_m", "is_told"), [(0.08, True), (0.12, True), (0.4, False)])
def test_arms_whose_first_links_lie_inside_each_other_are_told(tmp_path: Path, apart_m: float, is_told: bool) -> None:
    def change(card: dict[str, Any]) -> None:
        for mount, side in zip(card["mounts"], (0.5, -0.5), strict=True):
            mount["y_m"] = side * apart_m

    doubts = card_doubts(changed(tmp_path, change))
    told = [(doubt.arms, round(doubt.apart_m, 9)) for doubt in doubts if isinstance(doubt, ArmsTogether)]
    assert told == ([(("left", "right"), apart_m)] if is_told else [])


def test_arms_that_are_not_named_from_left_to_right_are_told(tmp_path: Path) -> None:
    def change(card: dict[str, Any]) -> None:
        for mount in card["mounts"]:
            mount["y_m"] *= -1.0

    [doubt] = card_doubts(changed(tmp_path, change))
    assert isinstance(doubt, ArmsCrossed)
    assert doubt.arms == ("left", "right")
    assert doubt.left_m == pytest.approx(0.7)


@pytest.mark.parametrize("yaw_rad", [math.pi, -2.0, 1.8, 0.5 * math.pi, -1.571])
def test_a_base_that_turns_its_back_or_its_side_to_the_table_is_told(tmp_path: Path, yaw_rad: float) -> None:
    def change(card: dict[str, Any]) -> None:
        card["scene"]["stations"]["edge"]["yaw_rad"] = yaw_rad

    [doubt] = card_doubts(changed(tmp_path, change))
    assert isinstance(doubt, StationFacesAway)
    assert doubt.station == "edge"
    assert doubt.away_rad == pytest.approx(abs(yaw_rad))


@pytest.mark.parametrize(("name", "mount"), [("ur5e-single", ""), ("panda-pair", "left"), ("panda-pair", "right")])
@pytest.mark.parametrize("yaw_rad", [math.pi, -math.pi, 3.0])
def test_a_mount_that_is_turned_away_from_the_table_is_told(
    tmp_path: Path, name: str, mount: str, yaw_rad: float
) -> None:
    def change(card: dict[str, Any]) -> None:
        [turned] = [one for one in card["mounts"] if one["name"] == mount]
        turned["yaw_rad"] = yaw_rad

    [doubt] = card_doubts(changed(tmp_path, change, name))
    assert isinstance(doubt, MountFacesAway)
    assert doubt.mount == mount
    assert doubt.away_rad > 2.09


@pytest.mark.parametrize("name", ["panda-pair", "so101-pair", "ur5e-pair"])
def test_each_mount_is_told_where_all_are_turned_away(tmp_path: Path, name: str) -> None:
    def change(card: dict[str, Any]) -> None:
        for mount in card["mounts"]:
            mount["yaw_rad"] = math.pi

    told = [doubt.mount for doubt in card_doubts(changed(tmp_path, change, name)) if isinstance(doubt, MountFacesAway)]
    assert told == ["left", "right"]


def test_arms_that_face_each_other_are_not(tmp_path: Path) -> None:
    def change(card: dict[str, Any]) -> None:
        for mount, yaw_rad in zip(card["mounts"], (-0.5 * math.pi, 0.5 * math.pi), strict=True):
            mount["yaw_rad"] = yaw_rad

    assert card_doubts(changed(tmp_path, change, "ur5e-pair")) == ()


@pytest.mark.parametrize("yaw_rad", [0.8, -0.8, 1.3])
def test_a_mount_that_is_turned_a_little_is_not(tmp_path: Path, yaw_rad: float) -> None:
    def change(card: dict[str, Any]) -> None:
        card["mounts"][0]["yaw_rad"] = yaw_rad

    assert card_doubts(changed(tmp_path, change)) == ()


def test_arms_that_stand_on_both_sides_of_the_table_face_it(tmp_path: Path) -> None:
    def change(card: dict[str, Any]) -> None:
        near, far = card["mounts"]
        [base] = card["scene"]["stations"].values()
        near["y_m"] = far["y_m"] = 0.0
        far |= {"x_m": -2.0 * base["x_m"], "yaw_rad": math.pi}

    assert card_doubts(changed(tmp_path, change)) == ()


ARM = """<robot name="arm">
  <link name="base"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="forearm"><collision><geometry><mesh filename="forearm.stl" scale="{scale}"/></geometry></collision></link>
  <link name="finger"><collision><geometry><box size="0.01 0.01 0.05"/></geometry></collision></link>
  <joint name="elbow" type="revolute"><parent link="base"/><child link="forearm"/><origin xyz="0 0 0.3"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="grip" type="prismatic"><parent link="forearm"/><child link="finger"/><origin xyz="0 0 0.4"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.04" velocity="1" effort="1"/></joint>
</robot>"""


@pytest.mark.parametrize(
    ("scale", "size_m"), [("1 1 1", 360.0), ("0.1 0.1 0.1", 36.0), ("0.000001 " * 3, 0.00036), ("0.00001 " * 3, 0.0036)]
)
def test_a_part_in_another_unit_is_told_with_its_size(tmp_path: Path, scale: str, size_m: float) -> None:
    [doubt] = card_doubts(bench(tmp_path, scale))
    assert isinstance(doubt, OddPart)
    assert doubt.link == "forearm"
    assert doubt.size_m == pytest.approx(size_m)
    assert doubt.most_m == pytest.approx(0.4, abs=0.2)


def test_a_part_in_its_own_unit_is_not(tmp_path: Path) -> None:
    assert card_doubts(bench(tmp_path, "0.001 0.001 0.001")) == ()


def bench(folder: Path, scale: str) -> DescribedRobot:
    trimesh.creation.box((60.0, 60.0, 360.0)).export(folder / "forearm.stl")
    (folder / "arm.urdf").write_text(ARM.format(scale=scale.strip()))
    card = json.loads(shipped_path("ur5e-single").read_text())
    [arm] = card["arms"]
    arm |= {"joints": ["elbow"], "home": [0.0], "speeds": None, "accelerations": None, "lifting": []}
    arm["tool"] = {"link": "forearm", "offset_m": [0.0, 0.0, 0.45], "approach": [0, 0, 1], "closing": [1, 0, 0]}
    arm["gripper"]["drive"] = {"kind": "linear", "joint": "grip", "closed": 0.0, "opened": 0.04}
    card |= {"urdf": {"path": "arm.urdf"}, "mounts": [{"z_m": 0.75}], "tools": [], "resting": {}}
    (folder / "mine.json").write_text(json.dumps(card))
    return read_described(folder / "mine.json")


def test_only_stations_in_the_table_are_found_and_from_where_they_are_free() -> None:
    front = DEFAULT_STATIONS["front"]
    table = load_robot("pr2").collisions(Table(), Scene().torso_m)
    assert stations_in_table(tuple(DEFAULT_STATIONS.items()), table) == ()
    [found] = stations_in_table((("front", front), ("nearer", front.ahead(0.3))), table)
    assert found.station == "nearer"
    assert found.back_m is not None and 0.0 < found.back_m < 0.3
    assert table.body_free(front.ahead(0.3 - found.back_m))
    assert not table.body_free(front.ahead(0.3 - found.back_m + 0.01))


def test_a_base_that_is_not_free_within_a_metre_has_no_way_back() -> None:
    class Everywhere:
        def body_free(self, base_in_table: Pose2) -> bool:
            return False

    assert stations_in_table((("here", Pose2(0.0, 0.0, 0.0)),), Everywhere()) == (StationInTable("here", None),)


@sweep("name", ["tiago-pro", "pr2"], quick=["pr2"])
def test_no_shipped_robot_that_drives_has_a_station_in_its_table(name: str) -> None:
    robot, scene = load_robot(name), read_robot(name).card.scene
    assert stations_in_table(scene.stations, robot.collisions(scene.table, scene.torso_m)) == ()
