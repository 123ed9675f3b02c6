"""Blocking contacts: waypoints whose answer geometry gives, and a request in which arms would have to cross."""

import numpy as np
import pytest

from planner import Garment, Scene, make_plan
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.motion.blocking_contacts import BlockingContacts
from planner.motion.waypoints import Waypoints
from planner.robots.load_robot import load_robot
from planner.task.reason import Code
from tests.builders import fold, garment
from tests.required import required

ROBOT, TORSO_M, TABLE = load_robot("pr2"), 0.29, Table()
EDGE_M = -TABLE.depth_m / 2
SNAGS = BlockingContacts(ROBOT, ROBOT.collisions(TABLE, TORSO_M), TORSO_M, TABLE.height_m)
BASE = (-0.95, 0.0, 0.0)
AHEAD = np.eye(3)


def waypoints(
    *tools: tuple[float, float, float], arm: int = 0, other: tuple[float, float, float] | None = None
) -> Waypoints:
    """Return waypoints of hands that point ahead, level; tools in the table frame."""
    count = len(tools)
    positions, rotations = np.full((2, count, 3), np.nan), np.full((2, count, 3, 3), np.nan)
    for number, places in ((arm, tools), (1 - arm, () if other is None else (other,) * count)):
        if places:
            positions[number] = np.array(places) - [BASE[0], BASE[1], -TABLE.height_m]
            rotations[number] = AHEAD
    return Waypoints(
        np.zeros(count, dtype=np.int64),
        np.linspace(0.0, 1.0, count),
        np.tile(BASE, (count, 1)),
        positions,
        rotations,
        np.zeros(count),
        np.zeros(count, dtype=bool),
    )


@pytest.mark.parametrize("arm", [0, 1])
def test_fingers_in_the_table_top_are_in_it_by_their_own_half_and_its(arm: int) -> None:
    # The top is 3 cm thick and the hand's axis in its middle, 45 cm inside the edge: to be outside it must go up or
    # down by 1.5 cm and half the height of what is in there, which is that of the fingers or more, of the palm at most.
    side = 0.3 if arm == 0 else -0.3
    contact = SNAGS.of(waypoints((EDGE_M + 0.45, side, 0.10), (EDGE_M + 0.45, side, -0.015), arm=arm))
    assert contact is not None
    assert (contact.arm, contact.cause) == (("left", "right")[arm], "table")
    assert contact.point == pytest.approx((EDGE_M + 0.45, side, -0.015))
    assert 0.015 + 0.005 < contact.depth_m < 0.015 + 0.06
    assert contact.parts[1] == "table top"


def test_where_every_moment_has_a_free_posture_nothing_is_said() -> None:
    assert SNAGS.of(waypoints((EDGE_M + 0.45, 0.3, 0.10), (EDGE_M + 0.50, 0.3, 0.20))) is None


def test_two_hands_in_one_place_are_in_each_others_way() -> None:
    place = (EDGE_M + 0.45, 0.0, 0.25)
    contact = SNAGS.of(waypoints(place, other=place))
    assert contact is not None
    assert contact.cause == "arms"
    assert contact.point == pytest.approx(place)


def test_arms_that_would_have_to_cross_are_the_reason_and_further_to_the_middle_they_need_not() -> None:
    # Both grips lie on a line straight ahead, far to the right: the left arm comes to one of them over the right one's
    # shoulder. Still further right its pan limit, 0.565 rad to the right, leaves it too little comfort as well. Ahead
    # of the robot's middle the arms come from both sides. The hands rise by no more than 0.1 m: within its limits an
    # elbow leaves little more over places that are 0.4 m apart.
    def towel(y_m: float) -> Garment:
        side_over = fold((0.4, 0.1), (0.0, 0.1), name="side over", radius_m=0.05)
        points = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.2), (0.0, 0.2)]
        return garment(points, side_over, placement=Pose2(-0.45, y_m, 0.0))

    scene = Scene(stations=(("front", Pose2(*BASE)),), back_off_max_m=0.1)
    refused = make_plan(towel(-0.35), scene, time_limit_s=60.0)
    (reason,) = refused.reasons
    assert (reason.fold, reason.code, reason.cause, reason.station) == (0, Code.COLLISION, "arms", "front")
    assert required(reason.short_by_m) > 0.0
    assert "the left " in reason.message and "the right " in reason.message
    assert make_plan(towel(-0.1), scene, time_limit_s=60.0).is_solved
