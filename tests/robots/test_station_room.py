"""Stations in the table are found, with how much further back the base stands free."""

from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.robots.card_doubts import StationInTable, stations_in_table
from planner.robots.described_robot import read_robot
from planner.robots.load_robot import load_robot
from planner.task.scene import DEFAULT_STATIONS, Scene
from tests.sweep import sweep


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
