"""The tool's pose at the seven joints of a left arm, in its shoulder's frame (m, rad). Compiled."""

import math

import numpy as np
from numba import njit

from planner.geometry.pose import FloatArray
from planner.robots.arm import ArmShape

X, Y, Z = 0, 1, 2


@njit(cache=True, nogil=True)
def turn(frame: FloatArray, i: int, j: int, angle: float) -> None:
    """Turn a frame's axis i towards its axis j: (X, Y) turns about z, (Y, Z) about x, (Z, X) about y."""
    cos, sin = math.cos(angle), math.sin(angle)
    for row in range(3):
        a, b = frame[row, i], frame[row, j]
        frame[row, i], frame[row, j] = cos * a + sin * b, cos * b - sin * a


@njit(cache=True, nogil=True)
def tool_pose(shape: ArmShape, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the tool's position, shape (3,), and rotation, shape (3, 3), at seven joint angles."""
    frame = np.eye(3)
    turn(frame, X, Y, joints[0])
    position = shape.offset * frame[:, 0]
    turn(frame, Z, X, joints[1])
    turn(frame, Y, Z, joints[2])
    position += shape.upper * frame[:, 0]
    turn(frame, Z, X, joints[3])
    turn(frame, Y, Z, joints[4])
    position += shape.fore * frame[:, 0]
    turn(frame, Z, X, joints[5])
    turn(frame, Y, Z, joints[6])
    position += shape.tool * frame[:, 0]
    return position, frame


@njit(cache=True, nogil=True)
def tool_places(shape: ArmShape, joints: FloatArray) -> FloatArray:
    """Return the tool's positions for rows of joints, shape (n, 7), seen from the shoulder (m), shape (n, 3)."""
    found = np.empty((len(joints), 3))
    for i in range(len(joints)):
        found[i] = tool_pose(shape, joints[i])[0]
    return found
