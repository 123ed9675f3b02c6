"""How long moments last: evenly paced where the joints can follow, slower where they cannot.

Only the joints' speeds are limited (the robot's description names no accelerations), so there is nothing to optimise: a
step may not be shorter than its slowest joint needs, and what time is left is shared out evenly. A library for
time-optimal paths would have to be told accelerations that nobody has measured.
"""

import numpy as np
from scipy.optimize import brentq

from planner.geometry.pose import FloatArray


def needed_s(joints: FloatArray, speeds_rad_s: FloatArray) -> FloatArray:
    """The least time from each joint configuration to the next (s).

    Args:
        joints: shape (n, ..., 7), rad.
        speeds_rad_s: how fast joints may turn, of a shape that goes with `joints[0]`.

    Returns:
        Shape (n - 1,).
    """
    steps = np.abs(np.diff(joints, axis=0)) / speeds_rad_s
    return np.asarray(steps.max(axis=tuple(range(1, steps.ndim)), initial=0.0))


def paced_s(nominal_s: FloatArray, least_s: FloatArray, rest_s: float = 0.0) -> FloatArray:
    """How long each step takes: no less than it needs, as near to its even share of the whole as that allows.

    Args:
        nominal_s: each step's duration at an even pace, shape (n,).
        least_s: the least that each needs, shape (n,).
        rest_s: how much of the whole is not for them, but for resting.

    Returns:
        Shape (n,); the sum is that of the nominal durations less the rest, or of the least ones if that is longer.
    """
    total = float(nominal_s.sum()) - rest_s
    if rest_s == 0.0 and np.all(least_s <= nominal_s):
        return nominal_s
    if float(least_s.sum()) >= total:
        return least_s

    def excess(pace: float) -> float:
        return float(np.maximum(least_s, pace * nominal_s).sum()) - total

    return np.asarray(np.maximum(least_s, brentq(excess, 0.0, 1.0) * nominal_s))


def eased(shares: FloatArray, easing: float) -> FloatArray:
    """How much of a way is done at shares of its time, with even acceleration at both ends.

    Args:
        shares: shape (n,), 0..1.
        easing: the share of the time that is spent speeding up, and again slowing down, 0..0.5. The top speed is
            1 / (1 - easing) times the mean.
    """
    if easing <= 0.0:
        return shares
    top = 1.0 / (1.0 - easing)
    rising = 0.5 * top * shares**2 / easing
    falling = 1.0 - 0.5 * top * (1.0 - shares) ** 2 / easing
    cruising = top * (shares - 0.5 * easing)
    return np.where(shares < easing, rising, np.where(shares > 1.0 - easing, falling, cruising))
