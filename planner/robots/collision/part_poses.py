"""Poses of the table's parts at a pose of the base, compiled.

A pose is five rows of three: the rotation, the position of the frame's origin, and the centre of the part's bounding
box (m), all in the base frame.
"""

import math

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.kernels import kernel

PLACE, MIDDLE = 3, 4
"""Rows of a pose that follow the three rows of the rotation."""

Index = NDArray[np.int64]


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
