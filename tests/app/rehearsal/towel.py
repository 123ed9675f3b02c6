"""A towel folded in half by two hands, its plan, and worlds in which it is performed at a coarse mesh."""

from functools import cache

from app.rehearsal.judge import Gate, StepVerdict, judged
from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.physics_world import PhysicsWorld
from app.rehearsal.world import StepMotion
from planner import Plan, Task, make_plan
from planner.cloth.garment import Garment
from planner.geometry.isometry import Isometry

COARSE = Resolution(edge_m=0.035, step_s=0.012, settle_s=0.5)
"""As coarse as the fold still holds at: it has an edge of the mesh on its line."""

COARSER = Resolution(edge_m=0.05, settle_s=0.1)
"""Quicker yet; no fold holds at it."""

FABRIC = Fabric(density_kg_m2=0.3)


@cache
def towel_plan() -> Plan:
    return make_plan(
        Task.of(
            Garment.from_dict(
                {
                    "name": "towel",
                    "outline": [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]],
                    "folds": [{"name": "half", "kind": "blue", "start": [0.4, 0.15], "end": [0.0, 0.15]}],
                    "placement": {"x_m": -0.75, "y_m": 0.2, "yaw_rad": -1.5707963267948966},
                }
            )
        )
    )


def verdict_on(plan: Plan, motion: StepMotion, resolution: Resolution = COARSE) -> StepVerdict:
    """Perform one motion in a fresh world, and judge it as the plan's step."""
    return verdict_in(PhysicsWorld(plan.task, FABRIC, resolution, seed=1), plan, motion)


def verdict_in(world: PhysicsWorld, plan: Plan, motion: StepMotion) -> StepVerdict:
    """Perform one motion in a world, and judge it as the plan's step."""
    answer = world.perform(motion)
    empty = tuple(arm for arm, has in answer.has_cloth.items() if not has)
    state = plan.steps[motion.step].after
    return judged(world.truth(), motion.step, plan.sequence, state, Isometry(), plan.scene.table, Gate(), empty)
