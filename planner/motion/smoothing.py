"""Smooth a path of joints: take out the kinks that a search through samples of postures has left.

They cost time, because joints must slow down for each. Each row is moved towards the middle of its neighbours, some
times over, which is a narrow Gaussian filter; the ends stay.
"""

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import kernel


def smoothed(joints: FloatArray, passes: int, may_move: BoolArray | None = None) -> FloatArray:
    """Return a path without kinks; a new array.

    Args:
        joints: one configuration for each step, shape (n, joints), rad.
        passes: how often it is smoothed.
        may_move: which rows may be moved, shape (n,); None: all but the ends.
    """
    found = joints.copy()
    inner = np.ones(len(joints), dtype=np.bool_) if may_move is None else may_move.copy()
    inner[[0, -1]] = False
    _smooth(found, np.flatnonzero(inner), passes)
    return found


@kernel
def _smooth(joints: FloatArray, rows: NDArray[np.int64], passes: int) -> None:
    """Smooth some rows in place, as often as wanted; compiled, because late hands have many paths smoothed."""
    before = np.empty_like(joints)
    for _ in range(passes if len(rows) else 0):
        before[:] = joints
        for i in rows:
            for j in range(joints.shape[1]):
                joints[i, j] = 0.25 * before[i - 1, j] + 0.5 * before[i, j] + 0.25 * before[i + 1, j]
