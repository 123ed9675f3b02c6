"""The base's way round the table. Default scene: 1.6 x 0.98 m, grown by 0.47 m to 2.54 x 1.92 m.

The base drives at 0.25 m/s and turns at 0.5 rad/s; it comes to these speeds with 0.5 m/s2 and 1 rad/s2, in 0.5 s each.
So every leg of more than 0.125 m and every turn of more than 0.25 rad takes 0.5 s more than at top speed throughout.
"""

import itertools
import math
import random

import pytest

from planner.geometry.pose import Point2, Pose2
from planner.geometry.table import Table
from planner.primitives.base_move import BaseMove, MoveStep, Route, clear_of_table, route_along, shortest_way
from planner.primitives.drive_time import DriveTime
from planner.primitives.state import Held, State
from planner.task.scene import Scene
from tests.builders import CIRCLE_M, context, garment, rectangle_points
from tests.replay.way_round import require_way_round

TABLE = Table(1.6, 0.98, 0.79)
HALF_X, HALF_Y = 0.8 + CIRCLE_M, 0.49 + CIRCLE_M
QUARTER = math.pi / 2
RISE_S = 0.5
TIME = DriveTime(0.25, 0.5)
TOWEL = garment(rectangle_points(0.4, 0.3))


def move(start: str, goal: str, standoff: int = 0, scene: Scene | None = None) -> MoveStep:
    scene = scene or Scene()
    names = [name for name, _ in scene.stations]
    state = State(0, (0.0, 0.0), names.index(start), standoff)
    found = {s.details["to"]: s for s in BaseMove(context(TOWEL, scene)).successors(state)}
    return found[goal]


def test_from_front_to_left_by_hand() -> None:
    # Back from x = -0.95 to the grown edge at -1.27 (0.32 m), turn to +y (90 deg), along it to the corner
    # (-1.27, 0.96) (0.96 m), turn to +x (90), along the long side to x = 0.45 (1.72 m), turn to -y (90), drive in
    # from y = 0.96 to 0.64 (0.32 m): 3.32 m and 270 degrees, 13.28 s + 3 x 3.1416 s; 4 legs and 3 turns, 7 x 0.5 s.
    step = move("front", "left")
    assert step.duration_s == pytest.approx(3.32 / 0.25 + 3 * QUARTER / 0.5 + 7 * RISE_S)
    expected = [
        (-0.95, 0.0, 0.0),
        (-1.27, 0.0, 0.0),
        (-1.27, 0.0, QUARTER),
        (-1.27, 0.96, QUARTER),
        (-1.27, 0.96, 0.0),
        (0.45, 0.96, 0.0),
        (0.45, 0.96, -QUARTER),
        (0.45, 0.64, -QUARTER),
    ]
    for point, wanted in zip(step.details["waypoints"], expected, strict=True):
        assert point == pytest.approx(list(wanted), abs=1e-9)


def test_along_one_side_the_base_backs_out_drives_by_and_drives_in() -> None:
    # front_left to left: 0.32 out, 0.55 along, 0.32 in; a quarter turn before and one after.
    assert move("front_left", "left").duration_s == pytest.approx(1.19 / 0.25 + 2 * QUARTER / 0.5 + 5 * RISE_S)


def test_a_base_that_has_backed_off_has_less_to_go_out() -> None:
    # 0.32 m take 1.28 s + 0.5 s; the 0.12 m that are left are too short for the top speed: 2 sqrt(0.12 / 0.5) s.
    saved_s = 0.32 / 0.25 + RISE_S - 2.0 * math.sqrt(0.12 / 0.5)
    assert move("front", "left").duration_s - move("front", "left", standoff=4).duration_s == pytest.approx(saved_s)


def test_a_base_backed_off_beyond_the_grown_table_need_not_back_out() -> None:
    # 0.4 m back: x = -1.35, already clear; straight to the corner (-1.27, 0.96) is hypot(0.08, 0.96).
    step = move("front", "left", standoff=8)
    driven = math.hypot(0.08, 0.96) + 1.72 + 0.32
    turned = math.atan2(0.96, 0.08) + math.atan2(0.96, 0.08) + QUARTER
    assert step.duration_s == pytest.approx(driven / 0.25 + turned / 0.5 + 6 * RISE_S)


def test_there_is_one_move_to_each_other_station_and_it_ends_not_backed_off() -> None:
    steps = list(BaseMove(context(TOWEL)).successors(State(0, (0.0, 0.0), 1, 3)))
    assert [s.after.station for s in steps] == [0, 2, 3, 4]
    assert all(s.after.standoff == 0 and not s.after.held for s in steps)


def test_the_base_does_not_move_with_cloth_in_its_hands() -> None:
    holding = State(0, (0.0, 0.0), 0, 0, (Held(0, (0.0, 0.0)),), dragged=1)
    assert list(BaseMove(context(TOWEL)).successors(holding)) == []


def test_between_any_two_stations_the_way_is_legal_and_shortest_from_every_standoff() -> None:
    scene = Scene()
    for start, goal in itertools.permutations(dict(scene.stations), 2):
        for standoff in (0, 5, 9, 16):
            step = move(start, goal, standoff)
            pose = dict(scene.stations)[start].ahead(-0.05 * standoff)
            goal_pose = dict(scene.stations)[goal]
            primitive = {"waypoints": step.details["waypoints"], "duration_s": step.duration_s}
            require_way_round(
                primitive,
                (pose.x_m, pose.y_m, pose.yaw_rad),
                (goal_pose.x_m, goal_pose.y_m, goal_pose.yaw_rad),
                scene.to_dict(),
            )
            assert sum(phase.duration_s for phase in step.phases) == pytest.approx(step.duration_s)


def test_a_station_that_stands_slanting_is_left_along_its_own_axis() -> None:
    slanting = Pose2(-0.9, -0.3, math.radians(30))
    scene = Scene(stations=(("slanting", slanting), ("left", Pose2(0.45, 0.64, -QUARTER))))
    step = move("slanting", "left", scene=scene)
    primitive = {"waypoints": step.details["waypoints"], "duration_s": step.duration_s}
    require_way_round(primitive, (-0.9, -0.3, math.radians(30)), (0.45, 0.64, -QUARTER), scene.to_dict())


def test_the_base_backs_out_no_further_than_it_must() -> None:
    assert clear_of_table(Pose2(-0.95, 0.0, 0.0), TABLE, CIRCLE_M).x_m == pytest.approx(-HALF_X)
    assert clear_of_table(Pose2(0.45, 0.64, -QUARTER), TABLE, CIRCLE_M).y_m == pytest.approx(HALF_Y)
    assert clear_of_table(Pose2(-2.0, 0.0, 1.0), TABLE, CIRCLE_M) == Pose2(-2.0, 0.0, 1.0)


def test_a_base_that_faces_away_backs_out_over_the_nearer_side_behind_it() -> None:
    # At (-0.95, 0) facing -x it backs towards +x, right through the table, to x = +1.27.
    assert clear_of_table(Pose2(-0.95, 0.0, math.pi), TABLE, CIRCLE_M).x_m == pytest.approx(HALF_X)


def test_a_free_view_is_one_straight_leg() -> None:
    assert shortest_way((-1.5, -0.5), (-1.5, 0.5), TABLE, CIRCLE_M) == ((-1.5, -0.5), (-1.5, 0.5))


def test_a_way_along_the_grown_edge_is_not_through_it() -> None:
    assert len(shortest_way((-HALF_X, 0.0), (-HALF_X, HALF_Y), TABLE, CIRCLE_M)) == 2


def test_from_a_place_to_itself_there_is_nothing_to_drive() -> None:
    assert shortest_way((2.0, 0.0), (2.0, 0.0), TABLE, CIRCLE_M) == ((2.0, 0.0),)
    pose = Pose2(2.0, 0.0, 0.3)
    assert route_along(pose, pose, ((2.0, 0.0),), pose, pose).durations_s(TIME) == (0.0,)


def test_ways_are_as_long_there_as_back() -> None:
    rng = random.Random(17)
    for _ in range(100):
        ends: list[Point2] = []
        while len(ends) < 2:
            x, y = rng.uniform(-2.5, 2.5), rng.uniform(-2.0, 2.0)
            if abs(x) > HALF_X or abs(y) > HALF_Y:
                ends.append((x, y))
        lengths = [
            sum(math.dist(a, b) for a, b in itertools.pairwise(shortest_way(start, goal, TABLE, CIRCLE_M)))
            for start, goal in (ends, ends[::-1])
        ]
        assert lengths[0] == pytest.approx(lengths[1])
        assert lengths[0] >= math.dist(*ends) - 1e-9


def test_driving_and_turning_take_their_time() -> None:
    route = Route((Pose2(0, 0, 0), Pose2(1, 0, 0), Pose2(1, 0, -QUARTER)))
    assert route.durations_s(TIME) == pytest.approx((4.0 + RISE_S, math.pi + RISE_S))
