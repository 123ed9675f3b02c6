"""The joints of an arm whose tool follows a path near to guides. Compiled."""

import math

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import kernel
from planner.robots.chain import PITCH, WHOLE, Chain, forward, scratch_for
from planner.robots.newton import solve


@kernel
def followed(
    chain: Chain, is_endless: BoolArray, points: FloatArray, rotations: FloatArray, guides: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Return the joints that Newton's method finds from each guide for its pose, or else from the joints before.

    A hand that is rolled by more than a quarter turn at the first guide stays rolled by half a turn.

    Args:
        chain: the arm.
        is_endless: which joints turn without end, shape (k,).
        points: positions, seen from the arm's root, shape (n, 3).
        rotations: rotations, shape (n, 3, 3).
        guides: joints to be near to, shape (n, k).

    Returns:
        The joints, shape (n, k), those that turn without end as near to the guides as they can be; and whether there
        are any, shape (n,).
    """
    rows = PITCH if chain.rows == PITCH else WHOLE
    scratch, joints, is_found = scratch_for(guides.shape[1]), guides.copy(), np.zeros(len(guides), dtype=np.bool_)
    forward(chain, guides[0], scratch)
    is_over = (scratch.frame[:, 1] * rotations[0, :, 1]).sum() < 0.0
    rotation = np.empty((3, 3))
    for i in range(len(guides)):
        rotation[:] = rotations[i]
        if is_over:
            rotation[:, 1:] *= -1.0
        is_found[i] = solve(chain, points[i], rotation, rows, joints[i], scratch)
        if not is_found[i] and i > 0:
            joints[i] = joints[i - 1]
            is_found[i] = solve(chain, points[i], rotation, rows, joints[i], scratch)
        for k in range(guides.shape[1]):
            if is_endless[k]:
                joints[i, k] += math.tau * math.floor((guides[i, k] - joints[i, k]) / math.tau + 0.5)
    return joints, is_found
