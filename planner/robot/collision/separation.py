"""Which pairs of convex parts are certainly apart? Compiled, for many postures at once.

Nearly all pairs are far apart in nearly all postures, and to be asked one by one costs far more than to be computed.
So this finds, for every posture, the first pair that is *not* certainly apart; only those are put to the exact
algorithm. A pair is certainly apart if

- the sphere round one does not reach the box round the other, or
- some plane has one on this side and the other on that (`planner.robot.collision.plane`).

Postures mostly follow one another along a path. So it is remembered by how much a pair was apart, and until its two
parts have gone as far, it is not looked at again.

Arrays are handed on one by one: to take them out of a tuple in the inner loop costs more than the loop does.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from planner.geometry.pose import FloatArray
from planner.robot.arm import ArmShape
from planner.robot.collision.part_poses import EACH, MIDDLE, Index, pose_arm, pose_table, set_middles
from planner.robot.collision.plane import room_at_plane

HALF, RADIUS, ROUNDING = 3, 6, 7
"""Columns of bounds: after the bounding box's middle, half its extents, the sphere's radius, the rounding (m)."""


class Parts(NamedTuple):
    """All parts: those of the arms first, left before right, then those that stand still while arms move.

    Attributes:
        corners: of all hulls, each in its part's frame (m), shape (c, 3).
        spans: the number of each part's first corner, and of the one after its last, shape (p, 2).
        bounds: of each part its bounding box's middle, in its frame, half the box's extents, the radius of the
            sphere about that middle which holds the part, and how far it reaches beyond its hull (m), shape (p, 8).
    """

    corners: FloatArray
    spans: Index
    bounds: FloatArray


@njit(cache=True, nogil=True)
def _towards(bounds: FloatArray, poses: FloatArray, a: int, b: int) -> tuple[float, float, float]:
    """The way from the box round part b to the middle of part a (m); zero if that is inside."""
    dx = poses[a, MIDDLE, 0] - poses[b, MIDDLE, 0]
    dy = poses[a, MIDDLE, 1] - poses[b, MIDDLE, 1]
    dz = poses[a, MIDDLE, 2] - poses[b, MIDDLE, 2]
    ox = oy = oz = 0.0
    for axis in range(3):
        along = poses[b, 0, axis] * dx + poses[b, 1, axis] * dy + poses[b, 2, axis] * dz
        half = bounds[b, HALF + axis]
        outside = along - min(max(along, -half), half)
        ox += outside * poses[b, 0, axis]
        oy += outside * poses[b, 1, axis]
        oz += outside * poses[b, 2, axis]
    return ox, oy, oz


@njit(cache=True, nogil=True)
def _room_between(
    corners: FloatArray, spans: Index, bounds: FloatArray, poses: FloatArray, a: int, b: int, margin: float
) -> float:
    """By how much more than a margin two parts are certainly apart (m); negative where that is not certain."""
    wx, wy, wz = _towards(bounds, poses, a, b)
    room: float = math.sqrt(wx * wx + wy * wy + wz * wz) - bounds[a, RADIUS] - margin
    if room > 0.0:
        return room
    bx, by, bz = _towards(bounds, poses, b, a)
    room = math.sqrt(bx * bx + by * by + bz * bz) - bounds[b, RADIUS] - margin
    if room > 0.0:
        return room
    gap = margin + bounds[a, ROUNDING] + bounds[b, ROUNDING]
    room = room_at_plane(corners, spans, poses, a, b, gap, (wx, wy, wz))
    if room < 0.0 and a < EACH <= b < 2 * EACH:
        # From which of two arms a plane is found may be chance; a mirror image has to have the same answer.
        room = room_at_plane(corners, spans, poses, b, a, gap, (bx, by, bz))
    return room


@njit(cache=True, nogil=True)
def first_close_pair(
    corners: FloatArray, spans: Index, bounds: FloatArray, poses: FloatArray, pairs: Index, start: int, margin: float
) -> int:
    """The first pair, from one on, that is not certainly apart by a margin (m); -1 if all are."""
    for pair in range(start, len(pairs)):
        if _room_between(corners, spans, bounds, poses, pairs[pair, 0], pairs[pair, 1], margin) < 0.0:
            return pair
    return -1


@njit(cache=True, nogil=True)
def _add_ways(bounds: FloatArray, before: FloatArray, poses: FloatArray, gone: FloatArray) -> None:
    """Add to how far any point of each part has gone (m) what it goes from a pose to the next; remember that.

    The middle goes its way, and what is round it no further than the radius times how far the rotation's matrix turns
    a vector: its Frobenius norm over the square root of two, for the difference of two rotations.
    """
    for part in range(len(poses)):
        turned = moved = 0.0
        for axis in range(3):
            for row in range(3):
                change = poses[part, row, axis] - before[part, row, axis]
                turned += change * change
            change = poses[part, MIDDLE, axis] - before[part, MIDDLE, axis]
            moved += change * change
        if turned + moved != 0.0:
            gone[part] += math.sqrt(moved) + bounds[part, RADIUS] * math.sqrt(0.5 * turned)
            before[part] = poses[part]


@njit(cache=True, nogil=True)
def first_close(
    shape: ArmShape,
    lift_m: float,
    parts: Parts,
    poses: FloatArray,
    pairs: Index,
    joints: FloatArray,
    arms: Index,
    bases: FloatArray,
    tables: FloatArray,
    start: Index,
    margins: FloatArray,
) -> tuple[Index, FloatArray]:
    """For every posture the first pair that is not certainly apart, from a given one on.

    Args:
        shape: the left arm.
        lift_m: how far the torso is raised (m).
        parts: all parts.
        poses: those of the body are set, shape (p, 5, 3); those of arms and table become the last posture's.
        pairs: numbers of the parts to be compared, shape (q, 2).
        joints: of each posture, the joints of each arm that is looked at (rad), shape (n, k, 7).
        arms: those arms, 0 for the left and 1 for the right, shape (k,).
        bases: where the base stands: x (m), y (m), yaw (rad), table frame, shape (n, 3), or (1, 3) for all.
        tables: the places of the table's parts, which come last, in the table frame but from the floor (m), (t, 3).
        start: the pair with which to start, shape (n,).
        margins: how far apart each pair should be (m), shape (q,).

    Returns:
        The pair, -1 if all are apart, shape (n,); and the poses of its two parts, shape (n, 2, 5, 3).
    """
    corners, spans, bounds = parts
    found, places = np.empty(len(joints), dtype=np.int64), np.empty((len(joints), 2, 5, 3))
    first = len(poses) - len(tables)
    before, gone, apart_until = poses.copy(), np.zeros(len(poses)), np.zeros(len(pairs))
    for i in range(len(joints)):
        if i < len(bases):
            pose_table(bases[i], tables, poses[first:])
            set_middles(bounds[first:], poses[first:])
        for k in range(len(arms)):
            low, high = EACH * arms[k], EACH * (arms[k] + 1)
            pose_arm(shape, lift_m, joints[i, k], 1.0 - 2.0 * arms[k], poses[low:high])
            set_middles(bounds[low:high], poses[low:high])
        _add_ways(bounds, before, poses, gone)
        found[i] = -1
        for pair in range(start[i], len(pairs)):
            a, b = pairs[pair]
            if gone[a] + gone[b] < apart_until[pair]:
                continue
            room = _room_between(corners, spans, bounds, poses, a, b, margins[pair])
            if room < 0.0:
                found[i] = pair
                break
            apart_until[pair] = gone[a] + gone[b] + room
        if found[i] >= 0:
            for side in range(2):
                places[i, side] = poses[pairs[found[i], side]]
    return found, places
