"""Hands that keep a flap from landing open beneath what they turn over."""

from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.corrections import carried_along
from app.rehearsal.judge import Gate, judged
from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.physics_world import PhysicsWorld
from app.rehearsal.step_seen import StepSeen
from app.rehearsal.trailing_flaps import INWARDS_M, flaps_beside, trailing
from app.rehearsal.world import GripMotion, StepMotion
from planner import Task
from planner.folds.fold_path import FoldPath
from planner.folds.fold_sequence import replayed
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.segment import Segment
from planner.geometry.table import Table, TableTop
from planner.task.plan import PlanStep
from planner.task.world_state import Holding, WorldState
from tests.app.rehearsal.towel import towel_plan
from tests.builders import fold, garment, rectangle_points

WIDE, LONG, FLAP = 0.3, 0.5, 0.1
SIDE = WIDE - FLAP
CLOTH = garment(
    rectangle_points(WIDE, LONG),
    fold((SIDE, LONG), (SIDE, 0.0), name="side"),
    fold((0.0, LONG / 2.0), (SIDE, LONG / 2.0), name="half"),
)
SEQUENCE = replayed(CLOTH)
SPREAD_OUT = Task.of(CLOTH)
TASK = replace(SPREAD_OUT, start=replace(SPREAD_OUT.start, folds_done=(0,)))
CREASED, OPEN = (SIDE, LONG), (0.0, LONG)
DURATION_S, RADIUS_M = 2.5, TASK.limits.comfort_radius_m


def half_by(*points: Point2) -> PlanStep:
    """Return the step in which the cloth, its side folded in, is folded in half by hands at some points."""
    before = TASK.start
    after = WorldState((0, 1), before.placement, before.base)
    holdings = tuple(Holding(("left", "right")[i], point, (point,)) for i, point in enumerate(points))
    return PlanStep("fold", 0.0, DURATION_S, {"fold": 1}, before.base, (), before, after, holdings)


def motion_of(step: PlanStep) -> StepMotion:
    """Return the motion of a step, as a plan would make it."""
    lies, line = TASK.start.placement, SEQUENCE.folds[1].line
    ends = lies.to_outer(np.array([line.start, line.end])).tolist()
    grips = lies.to_outer(np.array([one.point for one in step.holdings]))
    on_table, top = Segment(tuple(ends[0]), tuple(ends[1])), TableTop.of(Table())
    path = FoldPath(on_table, float(on_table.left_distances(grips).max()), top, top)
    points = path.tool_paths(grips, np.linspace(0.0, 2.0, 11))
    times_s = tuple(np.linspace(0.0, DURATION_S, 11).tolist())
    hands = (GripMotion(("left", "right")[i], times_s, tuple(map(tuple, one.tolist()))) for i, one in enumerate(points))
    return StepMotion(0, "fold", DURATION_S, tuple(hands))


def seen(step: PlanStep) -> StepSeen:
    """Return a step before which the cloth is seen where it should be."""
    return StepSeen(replace(towel_plan(), task=TASK, steps=(step,)), step, motion_of(step))


def inwards_m(made: StepMotion, planned: StepMotion, way: Point2) -> list[float]:
    """Return how far inwards of its path the first hand of a step is at its points (m)."""
    one, other = (np.array(motion.grips[0].points) for motion in (made, planned))
    inwards: list[float] = ((one - other)[:, :2] @ np.array(way)).tolist()
    return inwards


def test_a_flap_hangs_beside_the_hand_at_its_crease_and_not_beside_the_other() -> None:
    found = flaps_beside(seen(half_by(CREASED, OPEN)))
    ways = TASK.start.placement.to_outer(np.array([(0.0, 0.0), (-1.0, 0.0)]))
    assert found == {"left": pytest.approx(tuple(ways[1] - ways[0]))}


def test_no_flap_hangs_open_that_another_hand_holds_too() -> None:
    assert not flaps_beside(seen(half_by(CREASED, (SIDE - FLAP, LONG))))


def test_a_hand_alone_which_would_carry_all_the_cloth_along_stays_on_its_path() -> None:
    assert not flaps_beside(seen(half_by(CREASED)))


def test_no_flap_hangs_from_cloth_that_is_spread_out_or_that_is_dragged() -> None:
    step = half_by(CREASED, OPEN)
    spread_out = replace(step, before=SPREAD_OUT.start, details={"fold": 0})
    assert not flaps_beside(seen(spread_out))
    assert not flaps_beside(seen(replace(step, kind="drag", details={})))


def test_a_hand_beside_a_flap_begins_and_ends_as_planned_and_is_inwards_while_it_hangs() -> None:
    step = half_by(CREASED, OPEN)
    planned, flaps = motion_of(step), flaps_beside(seen(step))
    made = trailing(planned, seen(step))
    apart = inwards_m(made, planned, flaps["left"])
    assert apart[0] == apart[-1] == pytest.approx(0.0, abs=1e-9)
    assert max(apart) == pytest.approx(INWARDS_M)
    assert made.grips[1] == planned.grips[1]


@pytest.mark.parametrize("shift_m", [0.02, 0.04])
def test_hands_go_inwards_no_further_than_is_in_reach(shift_m: float) -> None:
    step = half_by(CREASED, OPEN)
    (x, y), planned = flaps_beside(seen(step))["left"], motion_of(step)
    carried = Isometry.rotation(0.0, shift_m * x, shift_m * y)  # it lies that far inwards of where it should
    there = replace(seen(step), carried=carried)
    along = carried_along(planned, there)
    apart = inwards_m(trailing(along, there), along, (x, y))
    assert max(apart) == pytest.approx(max(0.0, RADIUS_M - shift_m), abs=1e-6)


def outline_mm(step: PlanStep, motion: StepMotion) -> float:
    """Return how far the outline of springy cloth is from where a step should leave it, once a motion was made (mm)."""
    world = PhysicsWorld(TASK, Fabric(bend_friction_per_m=0.0), Resolution(), seed=1)
    world.perform(motion)
    return judged(world.truth(), 0, SEQUENCE, step.after, Isometry(), TASK.scene.table, Gate(), ()).outline_mm


@pytest.mark.long
def test_a_flap_that_trails_behind_its_crease_does_not_land_open() -> None:
    step = half_by(CREASED, OPEN)
    assert outline_mm(step, trailing(motion_of(step), seen(step))) < Gate().outline_mm


@pytest.mark.long
def test_on_the_planned_path_its_crease_stands_up_on_its_free_edge_and_falls_out_of_the_stack_by_2_cm() -> None:
    step = half_by(CREASED, OPEN)
    assert outline_mm(step, motion_of(step)) > Gate().outline_mm
