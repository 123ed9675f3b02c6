"""Keep flaps that hang beneath what is turned over from landing open.

A layer folded in at the side hangs from its crease once the part it lies on has turned over, opens about the crease
beyond the hand, and comes down on its free edge. What then stands upright between that edge and the crease pushes the
crease out of the stack. So a hand beside such a crease goes a little inwards while the flap hangs and outwards again as
it lays the crease down: the free edge stays behind, and the flap lies down inwards of its crease.
"""

import math
from collections.abc import Iterator

import numpy as np

from app.rehearsal.planned_cloth import creases
from app.rehearsal.step_seen import StepSeen
from app.rehearsal.world import GripMotion, StepMotion, way_done
from planner.cloth.layer import Layer
from planner.geometry.pose import FloatArray, Point2, point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M

INWARDS_M = 0.02
"""How far inwards a hand goes at most (m): a row of the simulated mesh."""

_HELD_M = 0.011
"""A layer nearer to a hand than that is in it (m)."""

_HANDS = 2
"""The fewest hands of a fold in which one goes inwards: another one keeps the rest of the part in place."""

_ALONG = math.sqrt(0.5)
"""The cosine of the angle to a hand's way up to which a crease runs along it."""

_SHARES = ((0.0, 0.1, 0.5, 0.8, 1.0), (0.0, 0.0, 1.0, 1.0, 0.0))
"""The share of its way that a hand has done, and how much of the way inwards it is then."""


def flaps_beside(seen: StepSeen) -> dict[str, Point2]:
    """Return the direction inwards for each hand at a crease from which a flap will hang, table frame, of length 1.

    That is a crease on the outline of what a fold moves, along the hands' way; its flap is held by no other hand. There
    is none for a hand alone: all it carries would go with it, and hardly come back.
    """
    step, sequence = seen.step, seen.sequence
    if step.fold is None or len(step.holdings) < _HANDS:
        return {}
    line, folded = sequence.folds[step.fold].line, sequence.folded(step.before.done, step.fold)
    held = np.array([one.point for one in step.holdings])
    inwards = np.zeros_like(held)
    for layer in folded.layers:
        is_in_hand = layer.region.distances_to(held) <= _HELD_M
        for crease in _creases(layer, sequence.garment.pattern):
            beside = int(crease.distances(held).argmin())
            if _is_at_side(crease, line, folded.moving) and not np.delete(is_in_hand, beside).any():
                inwards[beside] += _inwards(crease, line, folded.moving)
    lengths = np.hypot(*inwards.T)  # of a hand between two such creases 0: it cannot go both ways
    return {
        step.holdings[number].arm: seen.to_table(point2(inwards[number] / lengths[number]))
        for number in np.flatnonzero(lengths > LENGTH_M).tolist()
    }


def trailing(motion: StepMotion, seen: StepSeen) -> StepMotion:
    """Move hands at flaps inwards during a fold, as far as they can reach, and outwards again as they land.

    Args:
        motion: the step as corrected until now.
        seen: the step, and how the cloth was seen.
    """
    flaps = flaps_beside(seen) if seen.takes_cloth else {}
    planned = {grip.arm: grip for grip in seen.motion.grips}

    def moved(grip: GripMotion) -> GripMotion:
        points, way = np.array(grip.points), np.array(flaps[grip.arm])
        path = np.array([planned[grip.arm].at(t_s) for t_s in grip.times_s])
        share = np.interp(way_done(points), *_SHARES)
        points[:, :2] += _reach_m((points - path)[:, :2], way, seen.radius_m) * share[:, None] * way
        return grip.along(points)

    return motion.with_grips(moved, flaps)


def _reach_m(beside: FloatArray, way: FloatArray, radius_m: float) -> float:
    """Return how far a hand can go one way, given its offsets from its planned path, shape (n, 2), m."""
    along = beside @ way
    across = (beside * beside).sum(axis=1) - along * along
    most = np.sqrt(np.maximum(0.0, radius_m * radius_m - across)) - along
    return min(INWARDS_M, max(0.0, float(most.min())))


def _creases(layer: Layer, pattern: Region) -> Iterator[Segment]:
    """Yield the edges of a layer at which its cloth goes on in another one, garment frame."""
    for crease in creases(layer, pattern):
        yield Segment(layer.isometry.apply_point(crease.start), layer.isometry.apply_point(crease.end))


def _is_at_side(crease: Segment, line: Segment, moving: Region) -> bool:
    """Return whether a crease runs away from a fold line at the side of the part that moves."""
    is_along = abs(float(np.dot(crease.direction, line.left))) > _ALONG
    return is_along and moving.boundary_distance(crease.at(crease.length / 2.0)) <= LENGTH_M


def _inwards(crease: Segment, line: Segment, moving: Region) -> FloatArray:
    """Return the direction along a fold line that leads from a crease at the side into the part that moves."""
    across, normal = np.array(line.direction), np.array(crease.left)
    beside = np.array(crease.at(crease.length / 2.0)) + 2.0 * LENGTH_M * normal
    inwards = normal if moving.contains(point2(beside)) else -normal
    return np.asarray(across * np.sign(inwards @ across))
