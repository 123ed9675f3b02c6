"""The vertices of a piece of cloth that must be held (paper, Theorems 1 and 2).

Hanging cloth stays as it is when every vertex that is also a vertex of the convex hull is held, lies on
the baseline, or has cloth straight above it. Cloth that is dragged keeps its shape under the same rule, with "up" as
the direction of the drag; cloth that is being folded hangs from the grips, and "up" leads away from the fold line.

Outlines that were traced, and curves, have many vertices; those without which the outline keeps its shape to within
`TRACED_M` are left out first. Cloth at such a vertex sags no further than that.
"""

import math

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.ring import after, before, feet, hull_of
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from planner.geometry.traced import traced


def must_hold(piece: Region, up: Point2, baseline: tuple[Segment, ...], support_angle_rad: float) -> FloatArray:
    """Return the vertices of a piece of cloth that must be held.

    Args:
        piece: the cloth; if it has several parts, the hull is that of all; a sliver need not be held.
        up: the unit vector against which the cloth pulls.
        baseline: the lines along which the piece is held already; vertices on them need no grip.
        support_angle_rad: a vertex counts as supported when any direction within this angle of `up` leads
            into the cloth (rad); a direction along an edge leads into it.

    Returns:
        Shape (n, 2), counter-clockwise, in the frame of `piece` (m).
    """
    if piece.is_sliver:
        return np.empty((0, 2))
    shapes = [_shape(ring, baseline) for ring in piece.rings]
    loose = np.concatenate([ring[free & ~_is_supported(ring, up, support_angle_rad)] for ring, free in shapes])
    if not len(loose):
        return loose
    is_whole = sum(len(ring) for ring, _ in shapes) == sum(len(ring) for ring in piece.rings)
    hull = piece.hull if is_whole else hull_of(np.concatenate([ring for ring, _ in shapes]))
    return loose[_is_on_hull(loose, hull)]


def _shape(ring: FloatArray, baseline: tuple[Segment, ...]) -> tuple[FloatArray, BoolArray]:
    """Return the vertices that make a ring's shape, the baseline's among them, and which of them it does not hold."""
    is_held = np.zeros(len(ring), dtype=bool)
    for segment in baseline:
        is_held |= _is_on(ring, segment)
    stays = traced(ring, is_held)
    return ring[stays], ~is_held[stays]


def _is_on(ring: FloatArray, segment: Segment) -> BoolArray:
    """Return whether each vertex lies on a baseline, or is the tip of a hair-thin wedge that leaves one of its ends.

    Such a tip arises where a fold's line meets the boundary at a sharp angle; its length depends on rounding alone.
    """
    is_on = segment.distances(ring) <= LENGTH_M
    beyond = ~is_on & (np.abs(segment.left_distances(ring)) <= LENGTH_M)
    if beyond.any():
        ends = np.array([segment.start, segment.end])
        gaps = np.hypot(*(feet(ends, ring, after(ring)) - ends[:, None]).transpose(2, 0, 1))
        leaves_there = gaps <= 2 * LENGTH_M
        is_on |= beyond & (leaves_there & np.roll(leaves_there, 1, axis=1)).any(axis=0)
    return np.asarray(is_on)


def _is_on_hull(points: FloatArray, hull: FloatArray) -> BoolArray:
    gaps = np.abs(points[:, None, :] - hull[None, :, :]).max(axis=2)
    return np.asarray(gaps.min(axis=1) <= LENGTH_M)


def _is_supported(ring: FloatArray, up: Point2, support_angle_rad: float) -> BoolArray:
    """Return whether some direction within the support angle of `up` leads into the ring at each vertex.

    At a vertex the cloth fills the directions from the edge that leaves it, counter-clockwise, to the edge
    that arrives. Directions are compared by how far the neighbouring vertex is from them.
    """
    leaving = after(ring) - ring
    arriving = before(ring) - ring
    slack = LENGTH_M / np.minimum(np.hypot(*leaving.T), np.hypot(*arriving.T))
    first = _angle_from(up, leaving)
    width = np.mod(_angle_from(up, arriving) - first, math.tau)
    reach = support_angle_rad + slack
    meets_before = (first <= reach) & (first + width >= -reach)
    meets_after = first + width - math.tau >= -reach
    return np.asarray(meets_before | meets_after)


def _angle_from(up: Point2, vectors: FloatArray) -> FloatArray:
    """Return the angles of vectors from `up`, counter-clockwise, in (-pi, pi]."""
    x, y = vectors.T
    ux, uy = up
    return np.asarray(np.arctan2(ux * y - uy * x, ux * x + uy * y))
