"""Where exactly hands take the cloth, and which edges they lay down short of their place."""

import math

import numpy as np

from app.vision.seen_stack import SeenStack
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2, Pose2
from planner.geometry.tolerance import LENGTH_M
from planner.task.plan import Plan
from planner.task.plan_step import PlanStep


def on_the_flap(step: PlanStep, carried: Isometry, seen: SeenStack | None, radius_m: float) -> dict[str, Point2]:
    """Return how far beside their grips hands take a part that moved last, because it lies there, table frame (m).

    Args:
        step: the step in which hands close.
        carried: from where the stack should lie to where it lies, table frame.
        seen: how the stack was seen; None where it was not.
        radius_m: how far at most (m).
    """
    if seen is None or not step.holdings:
        return {}
    offsets = seen.beside(np.array([one.point for one in step.holdings]))
    offsets *= np.minimum(1.0, radius_m / np.maximum(np.hypot(*offsets.T), LENGTH_M))[:, None]
    turned = Pose2(0.0, 0.0, step.before.placement.yaw_rad + math.atan2(carried.c, carried.a)).to_outer(offsets)
    return {one.arm: (x, y) for one, (x, y) in zip(step.holdings, turned.tolist(), strict=True)}


def laid_short(plan: Plan, step: PlanStep) -> frozenset[str]:
    """Return the arms that a fold has lay their edge of the cloth down short of its place.

    That is where the same hands lift it again: beyond the edge below it would hang down, and hook that one. A red fold
    goes on from where the one before has ended.
    """
    if step.fold is None or plan.sequence.folds[step.fold].is_red or not step.details.get("holds"):
        return frozenset()
    return frozenset(one.arm for one in step.holdings)
