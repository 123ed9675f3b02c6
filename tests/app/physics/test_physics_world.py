from app.physics.fabric import Fabric, Resolution
from app.physics.physics_world import PhysicsWorld
from app.rehearsal.world import Performed, StepMotion
from planner import Task
from tests.builders import garment, rectangle_points


def test_while_the_base_drives_with_free_hands_no_time_passes_for_the_cloth():
    world = PhysicsWorld(Task.of(garment(rectangle_points(0.2, 0.2))), Fabric(), Resolution(0.05))
    assert world.perform(StepMotion(0, "move", 20.0)) == Performed()
    assert world.elapsed_s == 0.0
