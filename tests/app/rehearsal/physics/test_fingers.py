"""Fingers with bodies: they lift cloth, lie under it, are drawn out from there, and lose stacks that are too high."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.fingers import Box, FingerSize, Leaving, around, lowest
from app.rehearsal.physics.physics_world import PhysicsWorld
from app.rehearsal.step_motions import step_motions
from app.rehearsal.world import GripMotion, StepMotion
from planner import Task
from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.pose import Pose2
from planner.robots.load_robot import robot_card_file
from tests.app.rehearsal.towel import towel_plan
from tests.builders import garment, rectangle_points

SIZE = FingerSize(0.06, 0.022, 0.012, 0.09)
UP = np.array([0.0, 0.0, 1.0])


def world(layers: int = 1, wide_m: float = 0.24) -> PhysicsWorld:
    """Cloth of 24 cm on the table, its corner at the origin, wide along y; or so many of its layers on one another."""
    task = Task.of(garment(rectangle_points(0.24, wide_m)))
    made = PhysicsWorld(task, Fabric(), Resolution(0.015, settle_s=1.0), placement=Pose2(0.0, 0.0, 0.0))
    if layers > 1:  # pleats as wide as a row: a stack of cloth, however it came about
        points, gap_m = made.simulation.positions, Fabric().layer_m
        rows = np.unique(np.round(points[:, 0], 6), return_inverse=True)[1]
        pleat = np.where(rows % 2 == 0, 0.0, 0.015)
        number = np.minimum(rows, layers - 1)
        made.simulation.put(np.column_stack([pleat, points[:, 1], gap_m * (number + 0.5)]))
    return made


def hold(
    lifted_m: float = 0.0, heading_rad: float | None = 0.0, *, opens: bool = False, wide_m: float = 0.24
) -> StepMotion:
    """A hand that takes the middle of the edge at x = 0, and goes inwards."""
    middle_m = wide_m / 2.0
    points = ((0.0, middle_m, REST_HEIGHT_M), (0.05, middle_m, REST_HEIGHT_M + lifted_m))
    grip = GripMotion("left", (0.0, 0.4), points, opens=opens, heading_rad=heading_rad)
    return StepMotion(0, "drag", 0.4, (grip,))


def test_fingers_lie_on_both_sides_of_the_cloth_and_reach_back_from_it() -> None:
    points = np.array([[0.1, 0.0, 0.02], [0.1, 0.0, 0.026]])
    lower, upper = around(points, UP, math.pi / 2.0, SIZE, 0.0)
    assert lower.middle[2] + SIZE.thickness_m / 2.0 == pytest.approx(0.02, abs=1e-3)
    assert upper.middle[2] - SIZE.thickness_m / 2.0 == pytest.approx(0.026, abs=1e-3)
    assert lower.middle[1] < -0.01 and lower.middle[0] == pytest.approx(0.1)
    assert np.linalg.det(lower.axes) == pytest.approx(1.0)
    assert lowest(around(points, -UP, 0.0, SIZE, 0.0)).middle[2] < 0.02
    assert around(points, np.array([1.0, 0.0, 0.0]), 0.0, SIZE, 0.0) == []


def test_a_finger_under_cloth_lifts_it_by_its_thickness_and_one_beside_it_does_not() -> None:
    thickness_m = robot_card_file("pr2").arms[0].gripper.finger_thickness_m
    heights = []
    for heading_rad in (0.0, None):
        table = world()
        table.perform(hold(heading_rad=heading_rad))
        heights.append(float(table.simulation.positions[list(table.simulation.held), 2].min()))
    assert heights[0] - heights[1] == pytest.approx(thickness_m, abs=1e-3)
    assert heights[1] < 0.003


def test_cloth_that_lies_upon_a_finger_is_held_up_by_it_until_that_is_drawn_out() -> None:
    table = world()
    table.perform(hold(opens=False))
    edge = list(table.simulation.held)
    table._let_go(hold(opens=False).grips)
    for _ in range(5):
        table._step()
    lies_m = table.simulation.positions[edge, 2].min()
    assert lies_m > 0.008
    table._settle()
    assert not table._leaving
    assert table.simulation.positions[edge, 2].max() < 0.005


def test_the_finger_of_an_open_hand_goes_on_and_then_back_until_it_is_out() -> None:
    leaving: Leaving | None = Leaving(Box(np.zeros(3), np.eye(3)), 0.03, 0.1)
    places = []
    while leaving is not None:
        places.append(float(leaving.finger.middle[0]))
        leaving = leaving.after(0.01)
    assert max(places) == pytest.approx(0.03)
    assert places[-1] == pytest.approx(0.03 - 0.1, abs=0.003)
    assert np.argmax(places) > (len(places) - np.argmax(places)) / 2.0  # it is drawn back more quickly


def test_a_stack_higher_than_fingers_hold_slips_out_of_them() -> None:
    # At the edge is every second row: 2 and 9 layers, 4 and 18 mm when they are pressed on one another.
    motion, (few, many) = hold(wide_m=0.06), (world(layers, 0.06) for layers in (3, 17))
    assert few.perform(motion).has_cloth == {"left": True}
    assert many.perform(motion).has_cloth == {"left": False}
    assert not many.simulation.held


def test_the_highest_stack_is_half_of_what_fingers_open_at_a_stack() -> None:
    assert SIZE.stack_max_m == pytest.approx(0.015)
    assert replace(SIZE, opening_m=0.02).stack_max_m == pytest.approx(0.01)


def test_hands_point_where_the_plan_has_them_point() -> None:
    (motion,) = step_motions(towel_plan())
    path = towel_plan().trajectory
    assert path is not None
    for number, grip in enumerate(motion.grips):
        hand = path.of_step(0)[-1].phase.hands[number]
        assert hand is not None and grip.heading_rad is not None
        yaw_rad = path.of_step(0)[-1].phase.base[0].yaw_rad
        assert grip.heading_rad == pytest.approx(hand.approach.heading_rad + yaw_rad)
