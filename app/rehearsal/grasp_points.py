"""Find at which offsets from its grips a step takes the cloth."""

import math
from collections.abc import Mapping

import numpy as np

from app.rehearsal.step_seen import StepSeen
from app.rehearsal.vision.seen_stack import SeenStack
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Point2
from planner.geometry.tolerance import LENGTH_M
from planner.task.plan import PlanStep
from planner.task.world_state import Holding

INSIDE_M = 0.01
"""How far inside of the corners of several layers the middle of the fingers takes them (m).

Layers that should end upon each other end up to 2 cm apart, the lower ones unseen; fingers hold what is within 11 mm of
their middle. All else is taken at its edge: beyond the fingers cloth crumples.
"""


def taken_at(seen: StepSeen) -> dict[str, Point2]:
    """Return the offsets from their grips at which hands take the cloth, by arm, table frame (m).

    Edges, and the part that moved last, are taken where they are seen, corners of several layers inside of that.
    """
    inwards = inwards_at(seen)
    corners = {arm: inwards[arm] for arm in at_layered_corners(seen.step, seen.sequence) & inwards.keys()}
    return inside(where_seen(seen), corners, seen.spare_m)


def where_seen(seen: StepSeen) -> dict[str, Point2]:
    """Return the offsets from their grips at which the cloth is seen, as far as is in reach, by arm, table frame (m).

    That is the part that moved last, and an edge: with the finger's tip beyond a crease that lies inside of its line a
    hand held only what stuck out of it, and laid what it held down as far beyond its place.
    """
    holdings = seen.step.holdings
    if seen.stack is None or not holdings:
        return {}
    points = np.array([one.point for one in holdings])
    offsets = seen.stack.beside(points) + seen.stack.edge_beside(points)
    offsets *= np.minimum(1.0, seen.spare_m / np.maximum(np.hypot(*offsets.T), LENGTH_M))[:, None]
    return {one.arm: seen.to_table((x, y)) for one, (x, y) in zip(holdings, offsets.tolist(), strict=True)}


def are_edges_hidden(step: PlanStep, seen: SeenStack | None) -> bool:
    """Return whether nothing was seen of an edge that hands are to take."""
    points = [one.point for one in step.holdings]
    return bool(seen is not None and points and seen.is_edge_hidden(np.array(points)))


def inwards_at(seen: StepSeen) -> dict[str, Point2]:
    """Return the direction from each grip on the outline into the cloth, table frame."""
    outline = seen.sequence.cloth(seen.step.before.done).silhouette
    found = {one.arm: outline.inward_bisector(one.point) for one in seen.step.holdings}
    return {arm: seen.to_table(inwards) for arm, inwards in found.items() if inwards is not None}


def at_layered_corners(step: PlanStep, sequence: FoldSequence) -> frozenset[str]:
    """Return the arms that take nothing but a corner of several layers that lie on one another.

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
    """Return the offsets at which hands take the cloth further inside, to hold edges that lie further in too (m).

    Args:
        offsets: the offsets of the edges from the grips, for some arms, table frame (m).
        inwards: the direction into the cloth of those at an edge, table frame.
        radius_m: how far at most (m).
    """
    moved = {
        arm: np.array(offsets.get(arm, (0.0, 0.0))) + INSIDE_M * np.array(inwards.get(arm, (0.0, 0.0)))
        for arm in {*offsets, *inwards}
    }
    shares = {arm: min(1.0, radius_m / max(math.hypot(*gone), LENGTH_M)) for arm, gone in moved.items()}
    return {arm: (float(share * moved[arm][0]), float(share * moved[arm][1])) for arm, share in shares.items()}
