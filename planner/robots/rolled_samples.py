"""Samples of the joints at whole tool poses, for an arm whose last joint gives the roll and nothing else. Compiled.

They are the samples of the point and the approach axis (`planner.robots.posture_samples.axis_samples`), each with its
hand turned to the roll and to half a turn more.
"""

import math

import numpy as np

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.chain import AXIS, Chain, forward, scratch_for
from planner.robots.hand_roll import gives_roll, roll_between
from planner.robots.newton import EXACT_M
from planner.robots.posture_samples import limit_cost

_STEEP = 0.7
"""Sine of the pitch of an approach from which its level direction is not certain enough to build on."""

_TURNS = (0.0, -math.tau, math.tau)
"""Whole turns by which a last joint of more than one turn may be off (rad)."""


def gives_roll_alone(chain: Chain) -> bool:
    """Return whether the last joint changes the hand's roll and neither the tool's point nor its approach axis."""
    beside_m = math.hypot(float(chain.tool_offset[0]), float(chain.tool_offset[1]))
    return chain.rows == AXIS and beside_m <= EXACT_M and gives_roll(chain) and _is_along(chain)


def _is_along(chain: Chain) -> bool:
    return math.hypot(float(chain.tool_rotation[0, 0]), float(chain.tool_rotation[1, 0])) <= EXACT_M


@kernel
def unrolled(rotations: FloatArray) -> FloatArray:
    """Return rotations with the same x axes, shape (n, 3, 3), and rolls that depend on these alone."""
    found = np.empty((len(rotations), 3, 3))
    for i in range(len(rotations)):
        # No negative zeros: equal axes are to be equal bytes.
        x, y, z = rotations[i, 0, 0] + 0.0, rotations[i, 1, 0] + 0.0, rotations[i, 2, 0] + 0.0
        ax, ay, az = (0.0, -z, y) if abs(z) > _STEEP else (-y, x, 0.0)  # across the axis, with x or with z
        length = math.sqrt(ax * ax + ay * ay + az * az)
        ax, ay, az = ax / length, ay / length, az / length
        found[i, 0, 0], found[i, 1, 0], found[i, 2, 0] = x, y, z
        found[i, 0, 1], found[i, 1, 1], found[i, 2, 1] = ax, ay, az
        found[i, 0, 2], found[i, 1, 2], found[i, 2, 2] = y * az - z * ay, z * ax - x * az, x * ay - y * ax
    return found


@kernel
def rolled_samples(
    chain: Chain, periods: FloatArray, rotations: FloatArray, joints: FloatArray, costs: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return samples at whole poses.

    Args:
        chain: the arm.
        periods: what each joint may be off without any difference, see `posture_samples`.
        rotations: the poses' rotations, shape (k, 3, 3).
        joints: the samples of their points and axes, shape (k, m, n).
        costs: their costs, shape (k, m); infinite where there is no sample.

    Returns:
        Joints and costs in the same form, at least one a pose.
    """
    poses, size, count = joints.shape
    found = np.zeros((poses, 6 * size, count))
    taken, scratch, most = np.full((poses, 6 * size), np.inf), scratch_for(count), 1
    last, turning = count - 1, np.empty(count)
    middle = 0.5 * (chain.low[last] + chain.high[last])
    for i in range(poses):
        number = 0
        for each in range(size):
            if costs[i, each] == np.inf:
                continue
            turning[:] = joints[i, each]
            forward(chain, turning, scratch)
            roll = roll_between(scratch.frame, rotations[i, :, 1])
            level = turning[last] + (roll if chain.tool_rotation[2, 0] > 0.0 else -roll)
            for half in range(2):
                rolled = level + math.pi * half
                rolled -= math.tau * math.floor((rolled - middle) / math.tau + 0.5)
                for turn in _TURNS:
                    turning[last] = rolled + turn
                    is_within = chain.low[last] <= turning[last] <= chain.high[last]
                    if is_within and (turn == 0.0 or periods[last] == 0.0):
                        found[i, number] = turning
                        taken[i, number] = costs[i, each] + limit_cost(chain, periods, turning, count)
                        number += 1
        most = max(most, number)
    return found[:, :most].copy(), taken[:, :most].copy()
