"""Tests for which pairs of convex parts are apart: compiled, for many postures at once.

For every posture the first pair that is not apart is found. A pair is apart if

- the sphere round one does not reach the box round the other, or
- a plane separates the two (`planner.robots.collision.plane`).

Postures mostly follow one another along a path. The distance of each pair is therefore remembered, and the pair is
skipped until its parts have moved as far.

Arrays are passed one by one: taking them out of a tuple in the inner loop costs more than the loop does.
"""

import math
from typing import NamedTuple

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import inlined, kernel
from planner.robots.collision.arm_kinematics import ArmKinematics, pose_parts
from planner.robots.collision.part_poses import MIDDLE, Index, pose_table, set_middles
from planner.robots.collision.plane import room_at_plane

HALF, RADIUS, ROUNDING = 3, 6, 7
"""Columns of bounds, after the bounding box's centre: half its extents, the sphere's radius, the rounding (m)."""

FIRST, HAND, END, JOINTS = range(4)
"""Columns of arms: the arm's first part, its first one of those that move with the tool, the one after its last; and
how many joints it has."""


class Parts(NamedTuple):
    """All parts: those of the arms first, arm after arm, then those that stand still while arms move.

    Attributes:
        corners: the corners of all hulls, each in its part's frame (m), shape (c, 3).
        spans: the number of each part's first corner, and of the one after its last, shape (p, 2).
        bounds: for each part its bounding box's centre, in its frame, half the box's extents, the radius of the sphere
            about that centre that contains the part, and the part's rounding beyond its hull (m), shape (p, 8).
        arms: which parts and how many joints each arm has (`FIRST`, `HAND`, `END`, `JOINTS`), shape (a, 4).
    """

    corners: FloatArray
    spans: Index
    bounds: FloatArray
    arms: Index


@inlined
def _towards(bounds: FloatArray, poses: FloatArray, a: int, b: int) -> tuple[float, float, float]:
    """Return the way from the box round part b to the centre of part a (m); zero if that is inside."""
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


@inlined
def _room_between(
    corners: FloatArray,
    spans: Index,
    bounds: FloatArray,
    poses: FloatArray,
    a: int,
    b: int,
    margin: float,
    wanted: float,
) -> float:
    """Return by how much more than a margin two parts are apart (m), at least; negative where they are not.

    The search for it ends once it is more than what is wanted (m), which is at least 0.
    """
    wx, wy, wz = _towards(bounds, poses, a, b)
    room: float = math.sqrt(wx * wx + wy * wy + wz * wz) - bounds[a, RADIUS] - margin
    if room > wanted:
        return room
    x, y, z = _towards(bounds, poses, b, a)
    room = math.sqrt(x * x + y * y + z * z) - bounds[b, RADIUS] - margin
    if room > wanted:
        return room
    gap = margin + bounds[a, ROUNDING] + bounds[b, ROUNDING]
    return room_at_plane(corners, spans, poses, a, b, gap, (wx, wy, wz), wanted)


@kernel
def first_close_pair(
    corners: FloatArray, spans: Index, bounds: FloatArray, poses: FloatArray, pairs: Index, start: int, margin: float
) -> int:
    """Return the first pair, from a start, that is not apart by a margin (m); -1 if all are."""
    for pair in range(start, len(pairs)):
        if _room_between(corners, spans, bounds, poses, pairs[pair, 0], pairs[pair, 1], margin, 0.0) < 0.0:
            return pair
    return -1


@inlined
def _add_ways(bounds: FloatArray, before: FloatArray, poses: FloatArray, gone: FloatArray, low: int, high: int) -> None:
    """Add to the distances (m) that any point of some parts has moved those since the last pose, and keep the pose.

    The bound adds the centre's displacement and the radius times the most by which the rotations' difference can
    stretch a vector: its Frobenius norm over the square root of two.
    """
    for part in range(low, high):
        turned = moved = 0.0
        for axis in range(3):
            for row in range(3):
                change = poses[part, row, axis] - before[part, row, axis]
                turned += change * change
            change = poses[part, MIDDLE, axis] - before[part, MIDDLE, axis]
            moved += change * change
        if turned + moved != 0.0:
            gone[part] += math.sqrt(moved) + bounds[part, RADIUS] * math.sqrt(0.5 * turned)
            for axis in range(3):
                for row in (0, 1, 2, MIDDLE):
                    before[part, row, axis] = poses[part, row, axis]


@kernel
def _pose_arms(
    kinematics: ArmKinematics, lift_m: float, parts: Parts, arms: Index, joints: FloatArray, poses: FloatArray
) -> None:
    """Set the poses of the parts of some arms, whose joints follow one another."""
    column = 0
    for arm in arms:
        low, high, after = parts.arms[arm, FIRST], parts.arms[arm, END], column + parts.arms[arm, JOINTS]
        pose_parts(kinematics, lift_m, arm, joints[column:after], poses[low:high])
        set_middles(parts.bounds[low:high], poses[low:high])
        column = after


@kernel
def first_close(
    kinematics: ArmKinematics,
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
    is_one_enough: bool,
    is_path: bool,
) -> tuple[Index, FloatArray, BoolArray]:
    """Return for every posture the first pair, from a start, that is not apart.

    Args:
        kinematics: the arms.
        lift_m: how far the lift is raised (m).
        parts: all parts.
        poses: the poses of all parts, shape (p, 5, 3), of which the body's count.
        pairs: numbers of the parts to be compared, shape (q, 2).
        joints: for each posture the joints of the arms considered, one arm after the other (rad, m), shape (n, joints).
        arms: those arms, shape (k,).
        bases: the base poses: x (m), y (m), yaw (rad), table frame, shape (n, 3), or (1, 3) for all.
        tables: the positions of the table's parts, which come last, in the table frame but measured from the floor (m),
            shape (t, 3).
        start: the pair with which to start, shape (n,).
        margins: the distance that each pair should keep (m), shape (q,).
        is_one_enough: stop at the first posture with such a pair; those after it get -1.
        is_path: whether it matters what is between postures.

    Returns:
        The pair, -1 if all are apart, shape (n,); the poses of its two parts, shape (n, 2, 5, 3); and for a path
        whether the parts of some pair may touch on the way from the posture before, shape (n,).
    """
    corners, spans, bounds, _ = parts
    found, places = np.full(len(joints), -1, dtype=np.int64), np.empty((len(joints), 2, 5, 3))
    may_touch = np.zeros(len(joints), dtype=np.bool_)
    first = len(poses) - len(tables)
    poses = poses.copy()
    before, gone, apart_until = poses.copy(), np.zeros(len(poses)), np.zeros(len(pairs))
    for i in range(len(joints)):
        if i < len(bases):
            pose_table(bases[i], tables, poses[first:])
            set_middles(bounds[first:], poses[first:])
            _add_ways(bounds, before, poses, gone, first, len(poses))
        _pose_arms(kinematics, lift_m, parts, arms, joints[i], poses)
        for arm in arms:
            _add_ways(bounds, before, poses, gone, parts.arms[arm, FIRST], parts.arms[arm, END])
        for pair in range(start[i], len(pairs)):
            a, b = pairs[pair, 0], pairs[pair, 1]
            if gone[a] + gone[b] < apart_until[pair]:
                continue
            # What is apart now may have touched on the way if it has come further than it was and is apart together.
            wanted = max(gone[a] + gone[b] - apart_until[pair] - 2.0 * margins[pair], 0.0) if is_path and i else 0.0
            room = _room_between(corners, spans, bounds, poses, a, b, margins[pair], wanted)
            if room < 0.0:
                found[i] = pair
                break
            may_touch[i] |= room < wanted
            apart_until[pair] = gone[a] + gone[b] + room
        if found[i] >= 0:
            for side in range(2):
                places[i, side] = poses[pairs[found[i], side]]
            if is_one_enough:
                break
    return found, places, may_touch


_UNKNOWN = -1
"""Marks a posture that has not been compared with the other arm's hand yet."""


@kernel
def postures_apart(
    kinematics: ArmKinematics,
    lift_m: float,
    parts: Parts,
    arms: tuple[int, int],
    postures: tuple[FloatArray, FloatArray],
    pairs: Index,
    margin: float,
    is_one_enough: bool,
) -> BoolArray:
    """Return which postures of one arm are apart from which of another, shape (k, l).

    Args:
        kinematics: the arms.
        lift_m: how far the lift is raised (m).
        parts: all parts.
        arms: the two arms, in rising order.
        postures: joints of each of them (rad, m), shapes (k, joints) and (l, joints), with the tool in the same pose in
            all postures of an arm.
        pairs: numbers of the parts to be compared, the first arm's first, shape (q, 2).
        margin: the distance that they should keep (m).
        is_one_enough: stop once two postures are found that are apart.
    """
    corners, spans, bounds, of_arms = parts
    (a, b), (left, right) = arms, postures
    are_apart = np.zeros((len(left), len(right)), dtype=np.bool_)
    if are_apart.size == 0:
        return are_apart
    of_hands, with_right, with_left, with_both = _by_hands(pairs, of_arms[a, HAND], of_arms[b, HAND])
    of_left, of_right = slice(of_arms[a, FIRST], of_arms[a, END]), slice(of_arms[b, FIRST], of_arms[b, END])
    lefts = _placed(kinematics, lift_m, a, bounds[of_left], left)
    rights = _placed(kinematics, lift_m, b, bounds[of_right], right)
    both = np.zeros((of_arms[b, END], 5, 3))
    both[of_left], both[of_right] = lefts[0], rights[0]
    if first_close_pair(corners, spans, bounds, both, of_hands, 0, margin) >= 0:
        return are_apart
    left_clear, right_clear = np.full(len(left), _UNKNOWN), np.full(len(right), _UNKNOWN)
    last_left = last_right = last_both = 0
    for i in range(len(left)):
        both[of_left] = lefts[i]
        for j in range(len(right)):
            both[of_right] = rights[j]
            if right_clear[j] == _UNKNOWN:
                close = _close_pair(corners, spans, bounds, both, with_left, last_right, margin)
                right_clear[j], last_right = close < 0, max(close, 0)
            if left_clear[i] == _UNKNOWN:
                close = _close_pair(corners, spans, bounds, both, with_right, last_left, margin)
                left_clear[i], last_left = close < 0, max(close, 0)
            if left_clear[i] == 0:
                break
            if right_clear[j] == 0:
                continue
            close = _close_pair(corners, spans, bounds, both, with_both, last_both, margin)
            if close >= 0:
                last_both = close
                continue
            are_apart[i, j] = True
            if is_one_enough:
                return are_apart
    return are_apart


@kernel
def _by_hands(pairs: Index, left_hand: int, right_hand: int) -> tuple[Index, Index, Index, Index]:
    """Return the pairs of two hands, of the right hand alone, of the left hand alone, and of neither.

    Args:
        pairs: numbers of parts, the left arm's first, shape (q, 2).
        left_hand: the first part of the left hand.
        right_hand: the first part of the right hand.
    """
    is_left, is_right = pairs[:, 0] >= left_hand, pairs[:, 1] >= right_hand
    return (
        pairs[is_left & is_right],
        pairs[~is_left & is_right],
        pairs[is_left & ~is_right],
        pairs[~is_left & ~is_right],
    )


@kernel
def _close_pair(
    corners: FloatArray, spans: Index, bounds: FloatArray, poses: FloatArray, pairs: Index, likely: int, margin: float
) -> int:
    """Return a pair that is not apart by a margin (m), preferably the likely one; -1 if all are apart.

    Neighbouring postures mostly collide in the same pair, and one pair is enough to tell.
    """
    if len(pairs) and first_close_pair(corners, spans, bounds, poses, pairs[likely : likely + 1], 0, margin) == 0:
        return likely
    return first_close_pair(corners, spans, bounds, poses, pairs, 0, margin)


@kernel
def _placed(kinematics: ArmKinematics, lift_m: float, arm: int, bounds: FloatArray, postures: FloatArray) -> FloatArray:
    """Return the poses of an arm's parts in the given postures, shape (n, p, 5, 3)."""
    poses = np.empty((len(postures), len(bounds), 5, 3))
    for i in range(len(postures)):
        pose_parts(kinematics, lift_m, arm, postures[i], poses[i])
        set_middles(bounds, poses[i])
    return poses
