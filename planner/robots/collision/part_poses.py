"""Poses of an arm's parts at its seven joints, and of the table's parts at a pose of the base, compiled.

The parts of the right arm are mirror images of the left arm's: their frames are left-handed, and in them the corners of
the left arm's hulls give those of the right arm's.

A pose is five rows of three: the rotation, the position of the frame's origin, and the centre of the part's bounding
box (m), all in the base frame.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.robots.arm import ArmShape
from planner.robots.collision.parts import ARM_PARTS, PALM
from planner.robots.forward_kinematics import X, Y, Z, turn

EACH = len(ARM_PARTS)
"""Number of parts of an arm."""

PLACE, MIDDLE = 3, 4
"""Rows of a pose that follow the three rows of the rotation."""

Index = NDArray[np.int64]


@njit(cache=True, nogil=True)
def _set_pose(pose: FloatArray, frame: FloatArray, x: float, y: float, z: float, side: float) -> None:
    """Set a part's pose from the left arm's frame; `side` is -1 for the right arm."""
    for column in range(3):
        pose[0, column] = frame[0, column]
        pose[1, column] = side * frame[1, column]
        pose[2, column] = frame[2, column]
    pose[PLACE, 0], pose[PLACE, 1], pose[PLACE, 2] = x, side * y, z


@njit(cache=True, nogil=True)
def pose_arm(shape: ArmShape, lift_m: float, joints: FloatArray, side: float, poses: FloatArray) -> None:
    """Set rotation and position of an arm's parts in the base frame; from the palm on they are one body.

    Args:
        shape: the left arm.
        lift_m: how far the torso is raised (m).
        joints: the seven joints of this arm (rad).
        side: 1 for the left arm, -1 for the right.
        poses: the poses to set, shape (EACH, 5, 3).
    """
    frame = np.eye(3)
    x, y, z = shape.shoulder_x, shape.shoulder_y, shape.shoulder_z + lift_m
    turn(frame, X, Y, side * joints[0])
    _set_pose(poses[0], frame, x, y, z, side)
    x, y, z = x + shape.offset * frame[0, 0], y + shape.offset * frame[1, 0], z + shape.offset * frame[2, 0]
    turn(frame, Z, X, joints[1])
    _set_pose(poses[1], frame, x, y, z, side)
    turn(frame, Y, Z, side * joints[2])
    _set_pose(poses[2], frame, x, y, z, side)
    x, y, z = x + shape.upper * frame[0, 0], y + shape.upper * frame[1, 0], z + shape.upper * frame[2, 0]
    turn(frame, Z, X, joints[3])
    _set_pose(poses[3], frame, x, y, z, side)
    turn(frame, Y, Z, side * joints[4])
    _set_pose(poses[4], frame, x, y, z, side)
    x, y, z = x + shape.fore * frame[0, 0], y + shape.fore * frame[1, 0], z + shape.fore * frame[2, 0]
    turn(frame, Z, X, joints[5])
    _set_pose(poses[5], frame, x, y, z, side)
    turn(frame, Y, Z, side * joints[6])
    for part in range(PALM, EACH):
        _set_pose(poses[part], frame, x, y, z, side)


@njit(cache=True, nogil=True)
def pose_table(base: FloatArray, tables: FloatArray, poses: FloatArray) -> None:
    """Set rotation and position of the table's parts in the base frame.

    Args:
        base: x (m), y (m), yaw (rad), table frame.
        tables: the parts' positions in the table frame but measured from the floor (m), shape (t, 3).
        poses: the poses to set, shape (t, 5, 3).
    """
    cos, sin = math.cos(base[2]), math.sin(base[2])
    for part in range(len(tables)):
        x, y = tables[part, 0] - base[0], tables[part, 1] - base[1]
        pose = poses[part]
        pose[0, 0], pose[0, 1], pose[0, 2] = cos, sin, 0.0
        pose[1, 0], pose[1, 1], pose[1, 2] = -sin, cos, 0.0
        pose[2, 0], pose[2, 1], pose[2, 2] = 0.0, 0.0, 1.0
        pose[PLACE, 0], pose[PLACE, 1], pose[PLACE, 2] = cos * x + sin * y, cos * y - sin * x, tables[part, 2]


@njit(cache=True, nogil=True)
def set_middles(bounds: FloatArray, poses: FloatArray) -> None:
    """Set the centres of the bounding boxes, in poses whose other rows are set."""
    for part in range(len(poses)):
        for row in range(3):
            turned = 0.0
            for axis in range(3):
                turned += poses[part, row, axis] * bounds[part, axis]
            poses[part, MIDDLE, row] = poses[part, PLACE, row] + turned
