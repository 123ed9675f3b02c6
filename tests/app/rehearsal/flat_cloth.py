"""A towel that lies flat, seen by a camera beside a robot at home."""

from app.rehearsal.camera.posture import Posture
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.step_motions import posture_at
from app.rehearsal.world import Observation, Performed, StepMotion, Truth
from planner import Plan, Task
from planner.geometry.woven_mesh import woven_mesh
from tests.app.rehearsal.towel import towel_plan


class FlatCloth:
    """A towel that lies flat somewhere, notes what it is asked for, and is out of sight once it is folded."""

    def __init__(self, dx_m: float, dy_m: float) -> None:
        plan = towel_plan()
        lies = plan.task.start.placement.moved(dx_m, dy_m)
        pattern, triangles = woven_mesh(plan.garment.pattern, 0.03, 1)
        positions = planned_positions(plan.sequence, pattern, 0, lies, plan.scene.table, 0.002)
        self.asked: list[StepMotion] = []
        self._truth = Truth(pattern, positions, triangles)

    def observe(self) -> Observation:
        return Observation()

    def perform(self, motion: StepMotion) -> Performed:
        self.asked.append(motion)
        return Performed({grip.arm: True for grip in motion.grips})

    def truth(self) -> Truth | None:
        return None if any(motion.is_fold for motion in self.asked) else self._truth


def home(plan: Plan | None = None) -> Posture:
    path = (plan or towel_plan()).trajectory
    assert path is not None
    return posture_at(path, 0.0)


def no_plan(task: Task) -> Plan:
    raise AssertionError(f"nobody should plan again from {task.start}")
