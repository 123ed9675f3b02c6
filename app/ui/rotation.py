"""Rotations in viser's form: unit quaternions (w, x, y, z)."""

import math
from typing import TypeAlias

import numpy as np
from scipy.spatial.transform import Rotation

from planner.geometry.pose import FloatArray, Point3

Quaternion: TypeAlias = tuple[float, float, float, float]

IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)


def turn(axis: FloatArray, angle_rad: float) -> Quaternion:
    """Return the rotation by an angle (rad) about a unit axis, shape (3,)."""
    x, y, z = (float(part) for part in axis * math.sin(angle_rad / 2))
    return math.cos(angle_rad / 2), x, y, z


def yaw(angle_rad: float) -> Quaternion:
    """Return the rotation by an angle (rad) about z."""
    return math.cos(angle_rad / 2), 0.0, 0.0, math.sin(angle_rad / 2)


def product(first: Quaternion, second: Quaternion) -> Quaternion:
    """Return the rotation that does `second` and then `first`."""
    a, b, c, d = first
    e, f, g, h = second
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


def rotated(rotation: Quaternion, point: Point3) -> Point3:
    """Return a point after a rotation."""
    w, x, y, z = rotation
    _, *turned = product(product(rotation, (0.0, *point)), (w, -x, -y, -z))
    return (turned[0], turned[1], turned[2])


def to_matrix(rotation: Quaternion) -> FloatArray:
    """Return a rotation as a matrix, shape (3, 3)."""
    return np.array([rotated(rotation, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]).T


def from_matrix(matrix: FloatArray) -> Quaternion:
    """Return the rotation in the upper left of a matrix, shape (3, 3) or (4, 4)."""
    w, x, y, z = Rotation.from_matrix(matrix[:3, :3]).as_quat(canonical=True, scalar_first=True).tolist()
    return (w, x, y, z)
