"""Poses of an arm's parts at its seven joints, and of the table's parts at a pose of the base, compiled.

The parts of the right arm are mirror images of the left arm's: their frames are left-handed, and in them the corners of
the left arm's hulls give those of the right arm's.

A pose is five rows of three: the rotation, the position of the frame's origin, and the centre of the part's bounding
box (m), all in the base frame.
"""

import math

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.arm import ArmShape
from planner.robots.collision.parts import ARM_PARTS, PALM
from planner.robots.forward_kinematics import BASE_FRAME, Frame, Vector, about_x, about_y, about_z, ahead

EACH = len(ARM_PARTS)
"""Number of parts of an arm."""

PLACE, MIDDLE = 3, 4
"""Rows of a pose that follow the three rows of the rotation."""

Index = NDArray[np.int64]


@kernel
def _set_pose(poses: FloatArray, part: int, frame: Frame, place: Vector, side: float) -> None:
    """Set a part's pose from the left arm's frame; `side` is -1 for the right arm."""
    x, y, z = frame
    poses[part, 0, 0], poses[part, 0, 1], poses[part, 0, 2] = x[0], y[0], z[0]
    poses[part, 1, 0], poses[part, 1, 1], poses[part, 1, 2] = side * x[1], side * y[1], side * z[1]
    poses[part, 2, 0], poses[part, 2, 1], poses[part, 2, 2] = x[2], y[2], z[2]
    poses[part, PLACE, 0], poses[part, PLACE, 1], poses[part, PLACE, 2] = place[0], side * place[1], place[2]


@kernel
def pose_arm(shape: ArmShape, lift_m: float, joints: FloatArray, side: float, poses: FloatArray) -> None:
    """Set rotation and position of an arm's parts in the base frame; from the palm on they are one body.

    Args:
        shape: the left arm.
        lift_m: how far the torso is raised (m).
        joints: the seven joints of this arm (rad).
        side: 1 for the left arm, -1 for the right.
        poses: the poses to set, shape (EACH, 5, 3).
    """
    place = (shape.shoulder_x, shape.shoulder_y, shape.shoulder_z + lift_m)
    frame = about_z(BASE_FRAME, side * joints[0])
    _set_pose(poses, 0, frame, place, side)
    place = ahead(place, frame, shape.offset)
    frame = about_y(frame, joints[1])
    _set_pose(poses, 1, frame, place, side)
    frame = about_x(frame, side * joints[2])
    _set_pose(poses, 2, frame, place, side)
    place = ahead(place, frame, shape.upper)
    frame = about_y(frame, joints[3])
    _set_pose(poses, 3, frame, place, side)
    frame = about_x(frame, side * joints[4])
    _set_pose(poses, 4, frame, place, side)
    place = ahead(place, frame, shape.fore)
    frame = about_y(frame, joints[5])
    _set_pose(poses, 5, frame, place, side)
    frame = about_x(frame, side * joints[6])
    for part in range(PALM, EACH):
        _set_pose(poses, part, frame, place, side)


@kernel
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
        poses[part, 0, 0], poses[part, 0, 1], poses[part, 0, 2] = cos, sin, 0.0
        poses[part, 1, 0], poses[part, 1, 1], poses[part, 1, 2] = -sin, cos, 0.0
        poses[part, 2, 0], poses[part, 2, 1], poses[part, 2, 2] = 0.0, 0.0, 1.0
        poses[part, PLACE, 0], poses[part, PLACE, 1] = cos * x + sin * y, cos * y - sin * x
        poses[part, PLACE, 2] = tables[part, 2]


@kernel
def set_middles(bounds: FloatArray, poses: FloatArray) -> None:
    """Set the centres of the bounding boxes, in poses whose other rows are set."""
    for part in range(len(poses)):
        for row in range(3):
            turned = 0.0
            for axis in range(3):
                turned += poses[part, row, axis] * bounds[part, axis]
            poses[part, MIDDLE, row] = poses[part, PLACE, row] + turned
