"""Pace the steps of a path: evenly where the joints can follow, slower where they cannot.

Only speeds are limited here: a step may not be shorter than its slowest joint needs, and the remaining time is spread
evenly. What accelerations take is up to `planner.motion.path_timing`.
"""

import numpy as np

from planner.geometry.pose import FloatArray


def needed_s(joints: FloatArray, speeds_rad_s: FloatArray) -> FloatArray:
    """Return the least time from each joint configuration to the next (s).

    Args:
        joints: shape (n, joints), rad.
        speeds_rad_s: the joints' top speeds, shape (joints,).

    Returns:
        Shape (n - 1,).
    """
    steps = np.abs(np.diff(joints, axis=0)) / speeds_rad_s
    return np.asarray(steps.max(axis=1, initial=0.0))


def paced_s(nominal_s: FloatArray, least_s: FloatArray, rest_s: float = 0.0) -> FloatArray:
    """Return the duration of each step: at least what it needs, and as near to its even share as that allows.

    Args:
        nominal_s: each step's duration at an even pace, shape (n,).
        least_s: the least duration of each, shape (n,).
        rest_s: the part of the total that is reserved for rests (s).

    Returns:
        Shape (n,); the sum is that of the nominal durations less the rest, or of the least ones if that is longer.
    """
    total = float(nominal_s.sum()) - rest_s
    if rest_s == 0.0 and np.all(least_s <= nominal_s):
        return nominal_s
    if float(least_s.sum()) >= total:
        return least_s

    # As the pace falls, steps come to their least in the order of these: the first pace that frees the rest is it.
    borders = np.divide(least_s, nominal_s, out=np.full(len(least_s), np.inf), where=nominal_s > 0.0)
    order = np.argsort(-borders)
    free_s = np.cumsum(nominal_s[order][::-1])[::-1]
    paces = (total - np.append(0.0, np.cumsum(least_s[order])[:-1])) / free_s
    return np.asarray(np.maximum(least_s, paces[np.argmax(paces >= borders[order])] * nominal_s))
