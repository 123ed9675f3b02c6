"""A serial arm given by arrays, and its forward kinematics. Compiled.

Every joint turns about, or slides along, the z axis of its own frame; the fixed transforms between the frames carry
the rest.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from planner.geometry.pose import BoolArray, FloatArray

PITCH, AXIS, WHOLE = 4, 5, 6
"""Rows of a pose: position and pitch, position and approach axis, position and rotation."""


class Chain(NamedTuple):
    """An arm: lengths in m, angles in rad, seen from its root.

    Attributes:
        rotations: the rotation from each joint's frame to the one before it, at joint value 0, shape (n, 3, 3).
        offsets: the position of each joint's frame in the one before it, shape (n, 3).
        is_prismatic: which joints slide, shape (n,).
        low: the lower limits, shape (n,).
        high: the upper limits, shape (n,).
        turns: which joints have a whole turn or more, and so no limit for a pose; shape (n,).
        tool_rotation: the tool's axes in the last joint's frame, as columns; x is the approach axis. Shape (3, 3).
        tool_offset: the tool's position in the last joint's frame, shape (3,).
        rows: what the arm is asked of a pose where the roll does not matter: `PITCH`, `AXIS` or `WHOLE`.
        scale: the length by which angles count as distances (m).
    """

    rotations: FloatArray
    offsets: FloatArray
    is_prismatic: BoolArray
    low: FloatArray
    high: FloatArray
    turns: BoolArray
    tool_rotation: FloatArray
    tool_offset: FloatArray
    rows: int
    scale: float


class Scratch(NamedTuple):
    """Working memory for one thread.

    Attributes:
        axes: each joint's axis, shape (n, 3).
        places: each joint's position, shape (n, 3).
        frame: the tool's axes, as columns, shape (3, 3).
        point: the tool's position, shape (3,).
        rows: the Jacobian, shape (6, n).
        errors: what each row still lacks, shape (6,).
        normal: the damped normal matrix, shape (6, 6).
        solution: the solution of the normal equations, shape (6,).
        step: the step, shape (n,).
        is_held: which joints are held at a limit, shape (n,).
    """

    axes: FloatArray
    places: FloatArray
    frame: FloatArray
    point: FloatArray
    rows: FloatArray
    errors: FloatArray
    normal: FloatArray
    solution: FloatArray
    step: FloatArray
    is_held: BoolArray


def length_of(chain: Chain) -> float:
    """Return how far from its root an arm can reach at most (m)."""
    sliding = float(np.abs(np.where(chain.is_prismatic, np.maximum(-chain.low, chain.high), 0.0)).sum())
    return float(np.linalg.norm(chain.offsets[1:], axis=1).sum() + np.linalg.norm(chain.tool_offset)) + sliding


@njit(cache=True, nogil=True)
def scratch_for(joints: int) -> Scratch:
    """Return working memory for an arm of some joints."""
    return Scratch(
        np.empty((joints, 3)),
        np.empty((joints, 3)),
        np.empty((3, 3)),
        np.empty(3),
        np.empty((6, joints)),
        np.empty(6),
        np.empty((6, 6)),
        np.empty(6),
        np.empty(joints),
        np.zeros(joints, dtype=np.bool_),
    )


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})
def forward(chain: Chain, joints: FloatArray, scratch: Scratch) -> None:
    """Set the axes and places of all joints, and the tool's frame and point, at joint values."""
    r00, r01, r02, r10, r11, r12, r20, r21, r22 = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    x, y, z = 0.0, 0.0, 0.0
    for i in range(len(joints) + 1):
        is_tool = i == len(joints)
        f = chain.tool_rotation if is_tool else chain.rotations[i]
        t = chain.tool_offset if is_tool else chain.offsets[i]
        x += r00 * t[0] + r01 * t[1] + r02 * t[2]
        y += r10 * t[0] + r11 * t[1] + r12 * t[2]
        z += r20 * t[0] + r21 * t[1] + r22 * t[2]
        a0, a1 = r00 * f[0, 0] + r01 * f[1, 0] + r02 * f[2, 0], r00 * f[0, 1] + r01 * f[1, 1] + r02 * f[2, 1]
        a2 = r00 * f[0, 2] + r01 * f[1, 2] + r02 * f[2, 2]
        b0, b1 = r10 * f[0, 0] + r11 * f[1, 0] + r12 * f[2, 0], r10 * f[0, 1] + r11 * f[1, 1] + r12 * f[2, 1]
        b2 = r10 * f[0, 2] + r11 * f[1, 2] + r12 * f[2, 2]
        c0, c1 = r20 * f[0, 0] + r21 * f[1, 0] + r22 * f[2, 0], r20 * f[0, 1] + r21 * f[1, 1] + r22 * f[2, 1]
        c2 = r20 * f[0, 2] + r21 * f[1, 2] + r22 * f[2, 2]
        r00, r01, r02, r10, r11, r12, r20, r21, r22 = a0, a1, a2, b0, b1, b2, c0, c1, c2
        if is_tool:
            break
        scratch.axes[i, 0], scratch.axes[i, 1], scratch.axes[i, 2] = r02, r12, r22
        if chain.is_prismatic[i]:
            x, y, z = x + joints[i] * r02, y + joints[i] * r12, z + joints[i] * r22
        else:
            c, s = math.cos(joints[i]), math.sin(joints[i])
            r00, r01 = c * r00 + s * r01, c * r01 - s * r00
            r10, r11 = c * r10 + s * r11, c * r11 - s * r10
            r20, r21 = c * r20 + s * r21, c * r21 - s * r20
        scratch.places[i, 0], scratch.places[i, 1], scratch.places[i, 2] = x, y, z
    scratch.point[0], scratch.point[1], scratch.point[2] = x, y, z
    frame = scratch.frame
    frame[0, 0], frame[0, 1], frame[0, 2] = r00, r01, r02
    frame[1, 0], frame[1, 1], frame[1, 2] = r10, r11, r12
    frame[2, 0], frame[2, 1], frame[2, 2] = r20, r21, r22


@njit(cache=True, nogil=True)
def tool_poses(chain: Chain, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the tool's positions, shape (m, 3), and rotations, shape (m, 3, 3), at rows of joints, shape (m, n)."""
    scratch = scratch_for(joints.shape[1])
    points, frames = np.empty((len(joints), 3)), np.empty((len(joints), 3, 3))
    for i in range(len(joints)):
        forward(chain, joints[i], scratch)
        points[i], frames[i] = scratch.point, scratch.frame
    return points, frames
