"""Hands that have taken cloth inside of its edges."""

from app.rehearsal.corrections import beside, reflection_in
from app.rehearsal.grasp_points import inside, inwards_at
from app.rehearsal.step_motions import step_motions
from app.rehearsal.world import StepMotion
from planner import Plan
from planner.geometry.isometry import Isometry


def taken_inside(plan: Plan, number: int, closed: int | None = None) -> StepMotion:
    """Return a step's motion by hands that have taken cloth inside of its edges, in that step or in one before."""
    step = plan.steps[number]
    inwards = inwards_at(step if closed is None else plan.steps[closed], plan.sequence, Isometry())
    fold = reflection_in(step, plan.sequence, Isometry())
    return beside(step_motions(plan)[number], inside({}, inwards, plan.task.limits.comfort_radius_m), fold)
