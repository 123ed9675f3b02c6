"""The tool's pose at the seven joints of a left arm, in its shoulder's frame (m, rad). Compiled.

Frames are tuples of numbers: compiled code keeps those in registers, arrays it does not.
"""

import math
from typing import TypeAlias

import numpy as np

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.pr2.arm import ArmShape

Vector: TypeAlias = tuple[float, float, float]
Frame: TypeAlias = tuple[Vector, Vector, Vector]
"""The x, y and z axes."""

BASE_FRAME: Frame = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@kernel
def _turned(a: Vector, b: Vector, angle: float) -> tuple[Vector, Vector]:
    """Return two axes of a frame, the first turned towards the second by an angle (rad)."""
    cos, sin = math.cos(angle), math.sin(angle)
    return (
        (cos * a[0] + sin * b[0], cos * a[1] + sin * b[1], cos * a[2] + sin * b[2]),
        (cos * b[0] - sin * a[0], cos * b[1] - sin * a[1], cos * b[2] - sin * a[2]),
    )


@kernel
def about_x(frame: Frame, angle: float) -> Frame:
    """Return a frame turned about its x axis (rad)."""
    y, z = _turned(frame[1], frame[2], angle)
    return frame[0], y, z


@kernel
def about_y(frame: Frame, angle: float) -> Frame:
    """Return a frame turned about its y axis (rad)."""
    z, x = _turned(frame[2], frame[0], angle)
    return x, frame[1], z


@kernel
def about_z(frame: Frame, angle: float) -> Frame:
    """Return a frame turned about its z axis (rad)."""
    x, y = _turned(frame[0], frame[1], angle)
    return x, y, frame[2]


@kernel
def ahead(place: Vector, frame: Frame, length: float) -> Vector:
    """Return the place a length (m) further along a frame's x axis."""
    x = frame[0]
    return place[0] + length * x[0], place[1] + length * x[1], place[2] + length * x[2]


@kernel
def _tool(shape: ArmShape, joints: FloatArray, row: int) -> tuple[Vector, Frame]:
    """Return the tool's position and frame at a row of joints."""
    frame = about_z(BASE_FRAME, joints[row, 0])
    place = ahead((0.0, 0.0, 0.0), frame, shape.offset)
    frame = about_x(about_y(frame, joints[row, 1]), joints[row, 2])
    place = ahead(place, frame, shape.upper)
    frame = about_x(about_y(frame, joints[row, 3]), joints[row, 4])
    place = ahead(place, frame, shape.fore)
    frame = about_x(about_y(frame, joints[row, 5]), joints[row, 6])
    return ahead(place, frame, shape.tool), frame


@kernel
def tool_pose(shape: ArmShape, joints: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the tool's position, shape (3,), and rotation, shape (3, 3), at seven joint angles."""
    place, frame = _tool(shape, joints.reshape((1, 7)), 0)
    rotation = np.empty((3, 3))
    for column in range(3):
        for row in range(3):
            rotation[row, column] = frame[column][row]
    return np.array(place), rotation


@kernel
def tool_places(shape: ArmShape, joints: FloatArray) -> FloatArray:
    """Return the tool's positions for rows of joints, shape (n, 7), seen from the shoulder (m), shape (n, 3)."""
    found = np.empty((len(joints), 3))
    for i in range(len(joints)):
        x, y, z = _tool(shape, joints, i)[0]
        found[i, 0], found[i, 1], found[i, 2] = x, y, z
    return found
