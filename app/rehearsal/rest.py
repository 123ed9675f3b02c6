"""The rest of a plan as tasks to plan anew."""

import math
from dataclasses import replace

from planner.cloth import grips
from planner.cloth.garment import Garment
from planner.geometry.tolerance import LENGTH_M
from planner.robots.load_robot import load_robot
from planner.task.plan_step import PlanStep
from planner.task.task import TIME_LIMIT_S, Task
from planner.task.world_state import WorldState

FIRM = 0.8
"""The fraction of its radius within which a grip holds firmly, also beside its place: of .127 m, 10.2 cm.

Of plans that take equally long those are preferred that hold within 7/8 of it (`planner.cloth.grips`); corners 10.5 cm
from a hand that was a few millimetres beside its place folded under (docs/rehearsal.md).
"""


def is_loose(step: PlanStep, task: Task) -> bool:
    """Return whether a fold holds something loosely, near the end of a grip's radius, and the robot has a hand more.

    Args:
        step: a step of a plan.
        task: the task as it was at first.
    """
    if step.fold is None or len(step.holdings) == len(load_robot(task.robot).card.arms):
        return False
    firm_m = FIRM * task.garment.folds[step.fold].grip_radius_m + LENGTH_M
    return any(math.dist(one.point, vertex) > firm_m for one in step.holdings for vertex in one.vertices)


def rest_tasks(task: Task, start: WorldState) -> tuple[Task, ...]:
    """Return the tasks of the rest from a state, each for where those before it have no plan.

    In all but the last, grips hold firmly what they must: within `FIRM` of their radius, then within the planner's own
    share, beyond which corners fold under. A plan that saves half a second with one hand in the middle of a wide edge
    loses the edge's corners. The work ends all searches, on any machine and under any load, so that a run twice is the
    same.

    Args:
        task: the task as it was at first.
        start: the state as it is.
    """
    limits = task.limits
    work_s = limits.work_limit_s or limits.time_limit_s
    rest = replace(task, start=start, limits=replace(limits, work_limit_s=work_s, time_limit_s=TIME_LIMIT_S[1]))
    firm = tuple(replace(rest, garment=_gripped_within(share, task.garment)) for share in (FIRM, grips.FIRM))
    return *firm, rest


def _gripped_within(share: float, garment: Garment) -> Garment:
    """Return a garment of which each grip holds what is within a share of its radius."""
    folds = tuple(replace(fold, grip_radius_m=share * fold.grip_radius_m) for fold in garment.folds)
    return replace(garment, grip_radius_m=share * garment.grip_radius_m, folds=folds)
