"""Hands that land short, since cloth turns over round the ends of their fingers."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.finger_ends import round_finger_ends
from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.physics_world import PhysicsWorld
from app.rehearsal.physics.pinch import PAD_M
from app.rehearsal.world import GripMotion, StepMotion
from planner import Task
from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.pose import Pose2
from planner.robots.load_robot import robot_card_file
from tests.builders import garment, rectangle_points

LINE_M, THICKNESS_M = 0.1, 0.012


def over_the_line(heading_rad: float | None, *, opens: bool = True, rolls: bool = False) -> GripMotion:
    """Return half a circle about the line x = .1 m from the edge at x = 0, in 2 s."""
    angles = np.linspace(0.0, math.pi, 21)
    points = [
        (LINE_M * (1.0 - math.cos(angle)), 0.04, REST_HEIGHT_M + LINE_M * math.sin(angle)) for angle in angles.tolist()
    ]
    times_s = tuple(np.linspace(0.0, 2.0, 21).tolist())
    turned_rad = tuple(angles.tolist()) if rolls else ()
    return GripMotion("left", times_s, tuple(points), opens=opens, turned_rad=turned_rad, heading_rad=heading_rad)


def rounded(grip: GripMotion, most_m: float = 1.0, kind: str = "fold") -> GripMotion:
    (motion,) = round_finger_ends([StepMotion(0, kind, 2.0, (grip,))], {"left": THICKNESS_M}, most_m)
    return motion.grips[0]


def test_the_ends_of_fingers_that_point_along_the_way_turn_about_the_line() -> None:
    planned = over_the_line(0.0)
    made = rounded(planned)
    assert made.points[0] == pytest.approx(planned.points[0])
    # At the apex the fingers' ends are over the line, as high as the cloth from there to the line is long.
    assert made.at(1.0) == pytest.approx([LINE_M - PAD_M, 0.04, REST_HEIGHT_M + LINE_M - PAD_M], abs=1e-6)
    assert made.at(2.0) == pytest.approx([2.0 * (LINE_M - PAD_M) - THICKNESS_M, 0.04, REST_HEIGHT_M], abs=1e-6)


def test_the_less_fingers_point_along_the_way_the_less_hands_land_short() -> None:
    short_m = 2.0 * LINE_M - rounded(over_the_line(math.radians(60.0))).points[-1][0]
    assert short_m == pytest.approx(PAD_M + THICKNESS_M)


def test_hands_land_no_further_short_than_they_may() -> None:
    assert rounded(over_the_line(0.0), 0.01).points[-1][0] == pytest.approx(2.0 * LINE_M - 0.01)


def test_open_they_go_on_past_where_the_plan_has_the_edge() -> None:
    for heading_rad, most_m in ((0.0, 1.0), (math.radians(60.0), 1.0), (0.0, 0.01)):
        made = rounded(over_the_line(heading_rad), most_m)
        assert made.points[-1][0] + made.goes_on_m == pytest.approx(2.0 * LINE_M + 0.02)


def test_hands_that_roll_or_hold_on_or_point_down_or_across_or_drag_keep_their_paths() -> None:
    for grip in (
        over_the_line(math.pi / 2.0, rolls=True),
        over_the_line(0.0, opens=False),
        over_the_line(None),
        over_the_line(math.pi),
    ):
        assert rounded(grip) == grip
    assert rounded(over_the_line(0.0), kind="drag") == over_the_line(0.0)


@pytest.mark.parametrize("kind", ["drag", "fold"])
def test_a_hand_that_holds_on_from_a_drag_lands_short_and_one_that_does_so_from_a_fold_keeps_to_it(kind: str) -> None:
    holds, after = over_the_line(0.0, opens=False), replace(over_the_line(0.0), closes=False)
    steps = [StepMotion(0, kind, 2.0, (holds,)), StepMotion(1, "fold", 2.0, (after,))]
    first, second = round_finger_ends(steps, {"left": THICKNESS_M}, 1.0)
    assert first.grips[0] == holds
    assert (second.grips[0] == after) == (kind == "fold")


def edge_laid_at(motion: StepMotion) -> float:
    """Return where the middle of a strip's edge that a hand takes comes to lie (m)."""
    task = Task.of(garment(rectangle_points(0.24, 0.08)))
    world = PhysicsWorld(task, Fabric(), Resolution(0.015, settle_s=2.0), placement=Pose2(0.0, 0.0, 0.0))
    edge = int(np.linalg.norm(world.truth().positions[:, :2] - [0.0, 0.04], axis=1).argmin())
    assert world.perform(motion).has_cloth == {"left": True}
    return float(world.truth().positions[edge, 0])


def test_an_edge_is_laid_down_beyond_its_place_by_fingers_round_which_it_turned_and_less_if_short() -> None:
    fingers = robot_card_file("pr2").arms[0].gripper
    planned = StepMotion(0, "fold", 2.0, (over_the_line(0.0),))
    beyond_m = edge_laid_at(planned) - 2.0 * LINE_M
    # Round a finger's end cloth lies at least as tight as round a cylinder, at most as wide as a free elastica.
    tight_m, wide_m = (2.0 * PAD_M + turns * fingers.finger_thickness_m for turns in (math.pi / 2.0 - 1.0, 4.38))
    assert tight_m < beyond_m < wide_m
    (made,) = round_finger_ends([planned], {"left": fingers.finger_thickness_m}, 0.03)
    assert abs(edge_laid_at(made) - 2.0 * LINE_M) < 0.6 * beyond_m
