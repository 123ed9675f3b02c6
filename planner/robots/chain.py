"""A serial arm given by arrays, and its forward kinematics. Compiled.

Every joint turns about, or slides along, the z axis of its own frame; the fixed transforms between the frames carry
the rest.
"""

import math
from typing import NamedTuple

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import fast_inlined, kernel

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
        rows: what of a pose the arm must take where the roll does not matter: `PITCH`, `AXIS` or `WHOLE`.
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


@kernel
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


@fast_inlined
def forward(chain: Chain, joints: FloatArray, scratch: Scratch) -> None:
    """Set the axes and places of all joints, and the tool's frame and point, at joint values.

    Numbers are read one by one: to take a matrix out of an array costs more than to multiply by it.
    """
    f, t, axes, places = chain.rotations, chain.offsets, scratch.axes, scratch.places
    r00, r01, r02, r10, r11, r12, r20, r21, r22 = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    x, y, z = 0.0, 0.0, 0.0
    for i in range(len(joints)):
        x += r00 * t[i, 0] + r01 * t[i, 1] + r02 * t[i, 2]
        y += r10 * t[i, 0] + r11 * t[i, 1] + r12 * t[i, 2]
        z += r20 * t[i, 0] + r21 * t[i, 1] + r22 * t[i, 2]
        f00, f01, f02 = f[i, 0, 0], f[i, 0, 1], f[i, 0, 2]
        f10, f11, f12 = f[i, 1, 0], f[i, 1, 1], f[i, 1, 2]
        f20, f21, f22 = f[i, 2, 0], f[i, 2, 1], f[i, 2, 2]
        a0, a1 = r00 * f00 + r01 * f10 + r02 * f20, r00 * f01 + r01 * f11 + r02 * f21
        b0, b1 = r10 * f00 + r11 * f10 + r12 * f20, r10 * f01 + r11 * f11 + r12 * f21
        c0, c1 = r20 * f00 + r21 * f10 + r22 * f20, r20 * f01 + r21 * f11 + r22 * f21
        r02, r12, r22 = (
            r00 * f02 + r01 * f12 + r02 * f22,
            r10 * f02 + r11 * f12 + r12 * f22,
            r20 * f02 + r21 * f12 + r22 * f22,
        )
        axes[i, 0], axes[i, 1], axes[i, 2] = r02, r12, r22
        if chain.is_prismatic[i]:
            r00, r01, r10, r11, r20, r21 = a0, a1, b0, b1, c0, c1
            x, y, z = x + joints[i] * r02, y + joints[i] * r12, z + joints[i] * r22
        else:
            c, s = math.cos(joints[i]), math.sin(joints[i])
            r00, r01 = c * a0 + s * a1, c * a1 - s * a0
            r10, r11 = c * b0 + s * b1, c * b1 - s * b0
            r20, r21 = c * c0 + s * c1, c * c1 - s * c0
        places[i, 0], places[i, 1], places[i, 2] = x, y, z
    tool, tip, frame, point = chain.tool_rotation, chain.tool_offset, scratch.frame, scratch.point
    point[0] = x + r00 * tip[0] + r01 * tip[1] + r02 * tip[2]
    point[1] = y + r10 * tip[0] + r11 * tip[1] + r12 * tip[2]
    point[2] = z + r20 * tip[0] + r21 * tip[1] + r22 * tip[2]
    for k in range(3):
        frame[0, k] = r00 * tool[0, k] + r01 * tool[1, k] + r02 * tool[2, k]
        frame[1, k] = r10 * tool[0, k] + r11 * tool[1, k] + r12 * tool[2, k]
        frame[2, k] = r20 * tool[0, k] + r21 * tool[1, k] + r22 * tool[2, k]


@kernel
def tool_poses(chain: Chain, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the tool's positions, shape (m, 3), and rotations, shape (m, 3, 3), at rows of joints, shape (m, n)."""
    scratch = scratch_for(joints.shape[1])
    points, frames = np.empty((len(joints), 3)), np.empty((len(joints), 3, 3))
    for i in range(len(joints)):
        forward(chain, joints[i], scratch)
        points[i], frames[i] = scratch.point, scratch.frame
    return points, frames
