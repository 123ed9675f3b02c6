from dataclasses import replace

from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.physics_world import PhysicsWorld
from app.rehearsal.step_motions import step_motions
from app.rehearsal.world import Performed, StepMotion
from planner import Task
from tests.app.rehearsal.towel import COARSE, FABRIC, towel_plan, verdict_in
from tests.builders import garment, rectangle_points


def test_while_the_base_drives_with_free_hands_no_time_passes_for_the_cloth() -> None:
    world = PhysicsWorld(Task.of(garment(rectangle_points(0.2, 0.2))), Fabric(), Resolution(0.05))
    assert world.perform(StepMotion(0, "move", 20.0)) == Performed()
    assert world.elapsed_s == 0.0


def test_a_towel_folded_as_planned_holds_and_lies_still_before_the_time_for_that_is_over() -> None:
    # With the tolerance of moving cloth points of the folded towel still move at 2.9 mm/s when it counts as at rest.
    (motion,) = step_motions(towel_plan())
    world = PhysicsWorld(towel_plan().task, FABRIC, replace(COARSE, settle_s=1.0), seed=1)
    verdict = verdict_in(world, towel_plan(), motion)
    assert verdict.held, verdict
    folded_s = motion.grips[0].times_s[-1] - motion.grips[0].times_s[0]
    assert world.elapsed_s < folded_s + 1.0
    assert world.simulation.speeds.max() < 1e-3
