"""The table's parts, and the robot's body beside and under them."""

import math

import numpy as np
import pytest

from planner.geometry.pose import Pose2
from planner.geometry.table import Table, table_parts
from planner.task.scene import DEFAULT_STATIONS, Scene
from tests.replay import hulls
from tests.robots.collision_samples import CARD, HOME, ROBOT, TORSO_M

STANDOFFS_M = np.arange(0.0, 0.81, 0.05)


def test_the_top_lies_under_its_upper_side_and_legs_stand_on_the_floor() -> None:
    top, *legs = table_parts(Table(1.6, 0.98, 0.79))
    assert top.center[2] + top.size[2] / 2 == pytest.approx(0.0)
    assert top.size[:2] == (1.6, 0.98)
    assert len(legs) == 4
    for leg in legs:
        assert leg.center[2] + leg.size[2] / 2 == pytest.approx(-0.03)
        assert leg.center[2] - leg.size[2] / 2 == pytest.approx(-0.79)
        assert (abs(leg.center[0]), abs(leg.center[1])) == pytest.approx((0.35, 0.24))
    assert {(leg.center[0] > 0, leg.center[1] > 0) for leg in legs} == {(x, y) for x in (0, 1) for y in (0, 1)}


@pytest.mark.parametrize("size", [(0.1, 0.1, 0.1), (0.5, 3.0, 0.4), (10.0, 10.0, 10.0)])
def test_parts_of_any_table_are_within_it(size: tuple[float, float, float]) -> None:
    depth, width, height = size
    for part in table_parts(Table(*size)):
        assert abs(part.center[0]) + part.size[0] / 2 <= depth / 2 + 1e-9
        assert abs(part.center[1]) + part.size[1] / 2 <= width / 2 + 1e-9
        assert -height - 1e-9 <= part.center[2] - part.size[2] / 2 < part.center[2] + part.size[2] / 2 <= 1e-9


@pytest.mark.parametrize("torso_m", [0.2, TORSO_M, 0.31])
@pytest.mark.parametrize("station", DEFAULT_STATIONS)
def test_the_robot_stands_at_every_station_at_every_standoff(station: str, torso_m: float) -> None:
    collisions = ROBOT.collisions(Table(), torso_m)
    for back_off_m in STANDOFFS_M:
        assert collisions.free(DEFAULT_STATIONS[station].ahead(-float(back_off_m)), HOME[None]).all()


@pytest.mark.parametrize("station", DEFAULT_STATIONS)
def test_the_full_meshes_hulls_are_free_at_every_station(station: str) -> None:
    for back_off_m in (0.0, 0.4, 0.8):
        pose = DEFAULT_STATIONS[station].ahead(-back_off_m)
        joints = CARD.joint_values(TORSO_M, list(HOME), [0.06, 0.06])
        assert hulls.contacts(joints, (pose.x_m, pose.y_m, pose.yaw_rad), Table()) == []


def test_the_robot_is_free_on_all_ways_round_the_table_however_it_is_turned() -> None:
    table, radius_m = Scene().table, CARD.base_radius_m
    collisions = ROBOT.collisions(table, TORSO_M)
    x, y = table.depth_m / 2 + radius_m, table.width_m / 2 + radius_m
    way = [(s * x, side * y) for s in np.linspace(-1, 1, 9) for side in (-1, 1)]
    way += [(side * x, s * y) for s in np.linspace(-1, 1, 7) for side in (-1, 1)]
    for place in way:
        for yaw in np.arange(0.0, math.tau, math.radians(10.0)):
            assert collisions.free(Pose2(*place, float(yaw)), HOME[None]).all()


def test_a_base_that_stands_where_a_leg_is_collides_with_it() -> None:
    collisions = ROBOT.collisions(Table(), TORSO_M)
    # The legs' outer sides are .265 m from the table's middle line, the base reaches .334 m ahead of its own middle.
    assert collisions.body_free(Pose2(0.35, 0.265 + 0.334 + 0.01, -math.pi / 2))
    nearer = Pose2(0.35, 0.265 + 0.334 - 0.02, -math.pi / 2)
    assert not collisions.body_free(nearer)
    joints = CARD.joint_values(TORSO_M, list(HOME), [0.0, 0.0])
    found = hulls.contacts(joints, (nearer.x_m, nearer.y_m, nearer.yaw_rad), Table())
    (depth_m,) = (depth_m for *pair, depth_m in found if pair == ["base_link", "far left table leg"])
    assert depth_m == pytest.approx(0.02, abs=0.002)


def test_a_base_does_not_fit_under_a_table_lower_than_itself() -> None:
    # At `front` the base is under the table from .15 m ahead of its middle on, and there its hull is .445 m high.
    # Tables of .50 and .46 m leave .47 and .43 m under their tops.
    high, low = (ROBOT.collisions(Table(height_m=height_m), TORSO_M) for height_m in (0.50, 0.46))
    assert high.body_free(DEFAULT_STATIONS["front"])
    assert not low.body_free(DEFAULT_STATIONS["front"])
    assert low.body_free(DEFAULT_STATIONS["front"].ahead(-0.2))
