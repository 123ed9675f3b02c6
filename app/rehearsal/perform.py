"""Perform a plan in a world, step after step, and judge each."""

from collections.abc import Callable

from app.rehearsal.judge import Gate, StepVerdict, judged
from app.rehearsal.step_motions import step_motions
from app.rehearsal.world import World
from planner.task.plan import Plan


def performed(plan: Plan, world: World, gate: Gate, progress: Callable[[float], None]) -> tuple[StepVerdict, ...]:
    """Perform a plan as it is; return the verdicts on the steps after which all hands are free.

    Args:
        plan: a solved plan.
        world: the world.
        gate: what counts as held.
        progress: told the fraction that is done.
    """
    verdicts = []
    for motion, step in zip(step_motions(plan), plan.steps, strict=True):
        answer = world.perform(motion)
        empty = tuple(arm for arm, has in answer.has_cloth.items() if not has)
        truth = world.truth()
        if truth is not None and all(grip.opens for grip in motion.grips):
            verdicts.append(judged(truth, motion.step, plan.sequence, step.after, plan.scene.table, gate, empty))
        progress((motion.step + 1) / len(plan.steps))
    return tuple(verdicts)
