"""Cloth that one hand drags swings behind it: as predicted, as simulated, and as the fold after it goes."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.physics.physics_world import PhysicsWorld
from app.rehearsal.corrections import carry, corrected
from app.rehearsal.judge import Gate, slide_of
from app.rehearsal.perform import Performer
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.step_motions import step_motions
from app.rehearsal.swing import swung
from app.rehearsal.world import GripMotion
from planner import Plan, Task, load_garment, make_plan
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Pose2
from planner.geometry.ring import evenly_along
from tests.app.rehearsal.test_feedback import NotedWorld
from tests.app.rehearsal.towel import COARSE, FABRIC


@pytest.fixture(scope="module")
def tie() -> Plan:
    return make_plan(Task.of(load_garment("tie")))


def lying(plan: Plan, y_m: float, turn_rad: float) -> Pose2:
    lies = plan.task.start.placement
    return Pose2(lies.x_m, lies.y_m + y_m, lies.yaw_rad + turn_rad)


def turn_of(isometry: Isometry) -> float:
    return math.atan2(isometry.c, isometry.a)


def test_a_rod_dragged_by_its_end_comes_into_line_by_a_power_of_e(tie: Plan):
    # Of a rod of length l dragged by its end along a way s, exp(-1.5 s / l) of its turn is left.
    (drag, *_), table = step_motions(tie), tie.scene.table
    grip = drag.grips[0]
    straight = replace(grip, points=(grip.points[0], (grip.points[0][0] - 0.4, *grip.points[0][1:])))
    lies = lying(tie, 0.0, 0.05)
    pick = grip.points[0][:2]
    about = Isometry.rotation(0.0, *pick).after(Isometry.rotation(0.05)).after(Isometry.rotation(0.0, *pick).inverse)
    left = turn_of(swung([straight], tie.steps[0], tie.sequence, table, about))
    level = turn_of(swung([straight], tie.steps[0], tie.sequence, table, Isometry()))
    length_m = np.ptp(lies.to_outer(tie.garment.pattern.ring)[:, 0])
    assert (left - level) / 0.05 == pytest.approx(math.exp(-1.5 * 0.4 / length_m), abs=0.05)


def test_two_hands_bring_cloth_to_where_it_should_be(tie: Plan):
    grips = [GripMotion(arm, (0.0, 1.0), ((0.0, y, 0.0), (-0.4, y, 0.0))) for arm, y in (("left", 0.1), ("right", 0.0))]
    assert swung(grips, tie.steps[0], tie.sequence, tie.scene.table, Isometry.rotation(0.1)) == Isometry()


@pytest.mark.slow
@pytest.mark.parametrize(("y_m", "turn_rad"), [(0.0, 0.05), (0.02, 0.0)])
def test_simulated_cloth_turns_as_predicted(tie: Plan, y_m: float, turn_rad: float):
    step, planned, table = tie.steps[0], step_motions(tie)[0], tie.scene.table
    lies = lying(tie, y_m, turn_rad)
    carried = carry(step.before.placement, lies)
    motion = corrected(planned, carried)
    world = PhysicsWorld(tie.task, FABRIC, COARSE, 1, lies)
    world.perform(motion)
    truth = world.truth()
    should = planned_positions(tie.sequence, truth.pattern, 0, step.after.placement, table, 0.0)
    is_on = (should[:, 2] >= 0.0) & (truth.positions[:, 2] < 0.005)
    turned_rad = slide_of(should[is_on, :2], truth.positions[is_on, :2]).turned_rad
    expected_rad = turn_of(swung(motion.grips, step, tie.sequence, table, carried))
    assert abs(expected_rad) > 0.015
    assert expected_rad == pytest.approx(turned_rad, rel=0.3)  # cloth bends in its plane too, a rod does not


def test_the_fold_after_a_drag_by_one_hand_goes_over_the_line_as_it_lies_then(tie: Plan):
    lies = lying(tie, 0.0, 0.02)
    world = NotedWorld(evenly_along(lies.to_outer(tie.garment.pattern.ring), 0.01))
    Performer(tie, world, Gate(), lambda _: tie).performed()
    drag, fold = world.asked[:2]
    assert drag.is_drag and fold.is_fold and len(drag.grips) == 1
    (pulled,), (folded,) = drag.grips, fold.grips
    assert folded.points[0] == pytest.approx(pulled.points[-1], abs=1e-6)
    carried = swung(drag.grips, tie.steps[0], tie.sequence, tie.scene.table, carry(tie.task.start.placement, lies))
    line = tie.sequence.folds[tie.steps[1].details["fold"]].line
    ends = carried.apply(tie.steps[1].before.placement.to_outer(np.array([line.start, line.end])))
    along, way = ends[1] - ends[0], np.subtract(folded.points[-1][:2], folded.points[0][:2])
    assert 0.005 < turn_of(carried) < 0.02
    assert float(along @ way) / np.linalg.norm(along) / np.linalg.norm(way) == pytest.approx(0.0, abs=2e-3)
