"""Where exactly hands take the cloth, and which edges they lay upon the stack."""

import math

import numpy as np

from app.vision.seen_stack import SeenStack
from planner.cloth.cloth_state import ClothState
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point2, Pose2
from planner.geometry.region import Region
from planner.geometry.table_top import TableTop
from planner.geometry.tolerance import LENGTH_M
from planner.task.grip import Holding
from planner.task.plan import Plan
from planner.task.plan_step import PlanStep

INWARDS_M = 0.012
"""How far inside of the outline hands take a corner of several layers (m).

Layers end up to a centimetre or two inside of each other; fingers that close at the outermost corner miss the others.
"""

_CORNER_M = 0.02
"""A hand whose vertices are all nearer holds a corner (m): of a longer edge, what is beyond the hand would crumple."""

_AHEAD_M = 0.02
"""With so much of the stack ahead of it, an edge laid down is not at the outline (m)."""


def inwards(
    plan: Plan, step: PlanStep, carried: Isometry, seen: SeenStack | None, radius_m: float
) -> dict[str, Point2]:
    """Return how far beside their grips hands take the cloth, table frame (m).

    Corners of several layers are taken some way inside of the outline, and a part that moved last where it lies. Cloth
    beside the table is taken at its edge, and so is a part that is lifted again from where it is laid down: the edge
    ahead of the fingers would hang down there, and hook into what it lies on.

    Args:
        plan: the plan.
        step: the step in which hands close.
        carried: from where the stack should lie to where it lies, table frame.
        seen: how the stack was seen; None where it was not.
        radius_m: how far at most (m).
    """
    if step.fold is not None and step.details.get("holds"):
        return {}
    lies, top = step.before.placement, TableTop.of(plan.scene.table)
    piece = plan.sequence.cloth(step.before.done).silhouette if step.fold is None else plan.sequence.moving(step.fold)
    turned = Pose2(0.0, 0.0, lies.yaw_rad + math.atan2(carried.c, carried.a))
    found: dict[str, Point2] = {}
    for one in step.holdings:
        if top.covers(lies.to_outer(np.array([one.point]))):
            deep_m = INWARDS_M if _is_corner_of_layers(one, plan.sequence.cloth(step.before.done)) else 0.0
            x, y = turned.to_outer(_inwards(one.point, deep_m, piece, seen, radius_m)[None])[0].tolist()
            found[one.arm] = (x, y)
    return found


def laid_upon(plan: Plan, step: PlanStep) -> frozenset[str]:
    """Return the arms whose edge of the cloth a fold lays upon the stack, well inside of the outline ahead."""
    if step.fold is None or not step.holdings:
        return frozenset()
    line = plan.sequence.folds[step.fold].line
    landed = Isometry.reflection(line).apply(np.array([one.point for one in step.holdings]))
    gaps = plan.sequence.cloth(step.after.done).silhouette.distances_to(landed - _AHEAD_M * np.array(line.left))
    return frozenset(one.arm for one, gap_m in zip(step.holdings, gaps.tolist(), strict=True) if gap_m <= LENGTH_M)


def _is_corner_of_layers(holding: Holding, stack: ClothState) -> bool:
    at = np.array([holding.point])
    layers = sum(float(layer.region.distances_to(at)[0]) <= LENGTH_M for layer in stack.layers)
    return layers > 1 and all(math.dist(vertex, holding.point) <= _CORNER_M for vertex in holding.vertices)


def _inwards(point: Point2, deep_m: float, piece: Region, seen: SeenStack | None, radius_m: float) -> FloatArray:
    offset = deep_m * np.array(piece.inward_bisector(point) or (0.0, 0.0))
    if seen is not None:
        offset = offset + seen.beside(np.array([point]))[0]
    return np.asarray(offset * min(1.0, radius_m / max(float(np.hypot(*offset)), 1e-9)))
