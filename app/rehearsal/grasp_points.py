"""Where exactly hands take the cloth and seek it, and which edges they lay down short of their place."""

import math
from collections.abc import Mapping

import numpy as np

from app.rehearsal.vision.seen_stack import SeenStack
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.tolerance import LENGTH_M
from planner.task.grip import Holding
from planner.task.plan import Plan
from planner.task.plan_step import PlanStep

INSIDE_M = 0.01
"""How far inside of the corners of several layers the middle of the fingers takes them (m).

Layers that should end upon each other end up to 2 cm apart, the lower ones unseen; fingers hold what is within 11 mm of
their middle. All else is taken at its edge: beyond the fingers cloth crumples.
"""


def where_seen(step: PlanStep, carried: Isometry, seen: SeenStack | None, radius_m: float) -> dict[str, Point2]:
    """Return how far beside their grips hands take the cloth, because it is seen there, table frame (m).

    That is the part that moved last, and an edge: with the finger's tip beyond a crease that lies inside of its line a
    hand held only what stuck out of it, and laid what it held down as far beyond its place.

    Args:
        step: the step in which hands close.
        carried: from where the stack should lie to where it lies, table frame.
        seen: how the stack was seen; None where it was not.
        radius_m: how far at most (m).
    """
    if seen is None or not step.holdings:
        return {}
    points = np.array([one.point for one in step.holdings])
    offsets = seen.beside(points) + seen.edge_beside(points)
    offsets *= np.minimum(1.0, radius_m / np.maximum(np.hypot(*offsets.T), LENGTH_M))[:, None]
    return {
        one.arm: _turned(step, carried, (x, y)) for one, (x, y) in zip(step.holdings, offsets.tolist(), strict=True)
    }


def are_edges_hidden(step: PlanStep, seen: SeenStack | None) -> bool:
    """Return whether nothing was seen of an edge that hands are to take."""
    points = [one.point for one in step.holdings]
    return bool(seen is not None and points and seen.is_edge_hidden(np.array(points)))


def inwards_at(step: PlanStep, sequence: FoldSequence, carried: Isometry) -> dict[str, Point2]:
    """Return the direction from each grip on the outline into the cloth, table frame.

    Args:
        step: the step in which hands close.
        sequence: the garment's folds.
        carried: from where the stack should lie to where it lies, table frame.
    """
    outline = sequence.cloth(step.before.done).silhouette
    found = {one.arm: outline.inward_bisector(one.point) for one in step.holdings}
    return {arm: _turned(step, carried, inwards) for arm, inwards in found.items() if inwards is not None}


def at_layered_corners(step: PlanStep, sequence: FoldSequence) -> frozenset[str]:
    """Return the arms that take a corner at which several layers lie upon each other, and nothing else.

    Args:
        step: the step in which hands close.
        sequence: the garment's folds.
    """
    points = np.array([one.point for one in step.holdings]).reshape(-1, 2)
    layers = sequence.cloth(step.before.done).layers
    counts = np.sum([layer.region.distances_to(points) <= INSIDE_M for layer in layers], axis=0)
    return frozenset(
        one.arm for one, count in zip(step.holdings, counts, strict=True) if count > 1 and _is_at_corner(one)
    )


def _is_at_corner(one: Holding) -> bool:
    """Return whether what a hand holds is a corner, rather than an edge with corners at its ends."""
    return bool(one.vertices) and all(math.dist(one.point, vertex) <= INSIDE_M for vertex in one.vertices)


def inside(offsets: Mapping[str, Point2], inwards: Mapping[str, Point2], radius_m: float) -> dict[str, Point2]:
    """Return how far beside their grips hands take the cloth so that edges that lie further in are held too (m).

    Args:
        offsets: how far beside their grips the edges are, for some arms, table frame (m).
        inwards: the direction into the cloth of those at an edge, table frame.
        radius_m: how far at most (m).
    """
    moved = {
        arm: np.array(offsets.get(arm, (0.0, 0.0))) + INSIDE_M * np.array(inwards.get(arm, (0.0, 0.0)))
        for arm in {*offsets, *inwards}
    }
    shares = {arm: min(1.0, radius_m / max(math.hypot(*gone), LENGTH_M)) for arm, gone in moved.items()}
    return {arm: (float(share * moved[arm][0]), float(share * moved[arm][1])) for arm, share in shares.items()}


def laid_short(plan: Plan, step: PlanStep) -> frozenset[str]:
    """Return the arms that a fold has lay their edge of the cloth down short of its place.

    That is where the same hands lift it again: beyond the edge below it would hang down, and hook that one. A red fold
    goes on from where the one before has ended.
    """
    if step.fold is None or plan.sequence.folds[step.fold].is_red or not step.details.get("holds"):
        return frozenset()
    return frozenset(one.arm for one in step.holdings)


def _turned(step: PlanStep, carried: Isometry, vector: Point2) -> Point2:
    """Return a vector of the article frame in the table frame, as the cloth lies."""
    yaw_rad = step.before.placement.yaw_rad + math.atan2(carried.c, carried.a)
    x, y = Isometry.rotation(yaw_rad).apply_point(vector)
    return x, y
