"""Find which postures of one arm are apart from which of another: compiled, for all pairs at once.

The tool of each arm has the same pose in all postures, so the hands are compared only once. They come nearest to each
other, and proving near parts separate takes longest.
"""

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import kernel
from planner.robots.collision.arm_kinematics import ArmKinematics, pose_parts
from planner.robots.collision.part_poses import Index, set_middles
from planner.robots.collision.separation import END, FIRST, HAND, Parts, first_close_pair

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
