"""The distance of a pose within reach from the boundary of the reach.

The tool is moved, its rotation kept, in the directions of the faces and the corners of a cube, further and further
until the dense truth says no; then that last stretch is searched in smaller steps.
"""

from itertools import product

import numpy as np

from bench.reach_truth import DenseReach
from planner.geometry.pose import FloatArray

NEAREST_M, FURTHEST_M = 5e-4, 1.1
FINER = 8
"""Number of steps in which the last stretch is searched."""

_CORNERS = np.array(list(product((-1.0, 1.0), repeat=3))) / np.sqrt(3.0)
DIRECTIONS = np.vstack((np.eye(3), -np.eye(3), _CORNERS))


def distance_m(dense: DenseReach, point: FloatArray, rotation: FloatArray) -> float:
    """Return the shortest of the moves tried that takes a pose out of reach (m); inf if none does."""
    doubling = NEAREST_M * 2.0 ** np.arange(np.ceil(np.log2(FURTHEST_M / NEAREST_M)) + 1)
    coarse = _first_out(dense, point, rotation, doubling)
    if coarse == len(doubling):
        return np.inf
    last = doubling[coarse - 1] if coarse else 0.0
    fine = np.linspace(last, doubling[coarse], FINER + 1)[1:]
    return float(fine[_first_out(dense, point, rotation, fine)])


def _first_out(dense: DenseReach, point: FloatArray, rotation: FloatArray, lengths: FloatArray) -> int:
    """Return the index of the first length at which some direction leads out of reach; their number if none does."""
    points = (point + lengths[:, None, None] * DIRECTIONS).reshape(-1, 3)
    rotations = np.broadcast_to(rotation, (len(points), 3, 3))
    is_out = ~dense.can_reach(points, rotations).reshape(len(lengths), -1).all(axis=1)
    return int(np.argmax(is_out)) if is_out.any() else len(lengths)
