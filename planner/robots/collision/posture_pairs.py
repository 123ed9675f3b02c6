"""Find which postures of one arm are certainly apart from which of the other: compiled, for all pairs at once.

The tool of each arm has the same pose in all postures, so the hands are compared only once. They come nearest to each
other, and proving near parts separate takes longest.
"""

import numpy as np
from numba import njit

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.arm import ArmShape
from planner.robots.collision.part_poses import EACH, Index, pose_arm, set_middles
from planner.robots.collision.parts import PALM
from planner.robots.collision.separation import Parts, first_close_pair

_UNKNOWN = -1
"""Marks a posture that has not been compared with the other arm's hand yet."""


@njit(cache=True, nogil=True)
def postures_apart(
    shape: ArmShape,
    lift_m: float,
    parts: Parts,
    left: FloatArray,
    right: FloatArray,
    pairs: Index,
    margin: float,
    is_one_enough: bool,
) -> BoolArray:
    """Return which postures of the left arm are certainly apart from which of the right, shape (k, l).

    Args:
        shape: the left arm.
        lift_m: how far the torso is raised (m).
        parts: all parts.
        left: joints of the left arm (rad), shape (k, 7), with the tool in the same pose in all of them.
        right: joints of the right arm (rad), shape (l, 7), with the tool in the same pose in all of them.
        pairs: numbers of the parts to be compared, the left arm's first, shape (q, 2).
        margin: the distance that they should keep (m).
        is_one_enough: stop once two postures are found that are apart.
    """
    corners, spans, bounds = parts
    are_apart = np.zeros((len(left), len(right)), dtype=np.bool_)
    if are_apart.size == 0:
        return are_apart
    is_left_hand, is_right_hand = pairs[:, 0] >= PALM, pairs[:, 1] >= EACH + PALM
    lefts = _placed(shape, lift_m, bounds[:EACH], left, 1.0)
    rights = _placed(shape, lift_m, bounds[EACH : 2 * EACH], right, -1.0)
    both = np.concatenate((lefts[0], rights[0]))
    if first_close_pair(corners, spans, bounds, both, pairs[is_left_hand & is_right_hand], 0, margin) >= 0:
        return are_apart
    of_left, of_right = pairs[~is_left_hand & is_right_hand], pairs[is_left_hand & ~is_right_hand]
    of_both = pairs[~is_left_hand & ~is_right_hand]
    left_clear, right_clear = np.full(len(left), _UNKNOWN), np.full(len(right), _UNKNOWN)
    last_left = last_right = last_both = 0
    for i in range(len(left)):
        both[:EACH] = lefts[i]
        for j in range(len(right)):
            both[EACH:] = rights[j]
            if right_clear[j] == _UNKNOWN:
                close = _close_pair(corners, spans, bounds, both, of_right, last_right, margin)
                right_clear[j], last_right = close < 0, max(close, 0)
            if left_clear[i] == _UNKNOWN:
                close = _close_pair(corners, spans, bounds, both, of_left, last_left, margin)
                left_clear[i], last_left = close < 0, max(close, 0)
            if left_clear[i] == 0:
                break
            if right_clear[j] == 0:
                continue
            close = _close_pair(corners, spans, bounds, both, of_both, last_both, margin)
            if close >= 0:
                last_both = close
                continue
            are_apart[i, j] = True
            if is_one_enough:
                return are_apart
    return are_apart


@njit(cache=True, nogil=True)
def _close_pair(
    corners: FloatArray, spans: Index, bounds: FloatArray, poses: FloatArray, pairs: Index, likely: int, margin: float
) -> int:
    """Return a pair that is not certainly apart by a margin (m), preferably the likely one; -1 if all are apart.

    Neighbouring postures mostly collide in the same pair, and one pair is enough to tell.
    """
    if len(pairs) and first_close_pair(corners, spans, bounds, poses, pairs[likely : likely + 1], 0, margin) == 0:
        return likely
    return first_close_pair(corners, spans, bounds, poses, pairs, 0, margin)


@njit(cache=True, nogil=True)
def _placed(shape: ArmShape, lift_m: float, bounds: FloatArray, postures: FloatArray, side: float) -> FloatArray:
    """Return the poses of an arm's parts in the given postures, shape (n, EACH, 5, 3)."""
    poses = np.empty((len(postures), EACH, 5, 3))
    for i in range(len(postures)):
        pose_arm(shape, lift_m, postures[i], side, poses[i])
        set_middles(bounds, poses[i])
    return poses
