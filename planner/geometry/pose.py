"""Poses in the plane, and the directions from which a tool may come."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from planner.geometry.tolerance import ANGLE_RAD

Point2: TypeAlias = tuple[float, float]
Point3: TypeAlias = tuple[float, float, float]
FloatArray: TypeAlias = NDArray[np.float64]
BoolArray: TypeAlias = NDArray[np.bool_]


def point2(row: FloatArray) -> Point2:
    """Return the first two numbers of an array as plain ones."""
    return (float(row[0]), float(row[1]))


def point3(row: FloatArray) -> Point3:
    """Return the first three numbers of an array as plain ones."""
    return (float(row[0]), float(row[1]), float(row[2]))


def wrapped_angle(angle_rad: float) -> float:
    """Return an angle wrapped to (-pi, pi]."""
    wrapped = math.remainder(angle_rad, math.tau)
    return math.pi if wrapped <= -math.pi else wrapped


@dataclass(frozen=True)
class Pose2:
    """The pose of a plane figure or a base in another frame.

    Attributes:
        x_m: origin's x in the outer frame (m).
        y_m: origin's y in the outer frame (m).
        yaw_rad: heading of the inner x axis in the outer frame (rad), wrapped to (-pi, pi].
    """

    x_m: float
    y_m: float
    yaw_rad: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "yaw_rad", wrapped_angle(self.yaw_rad))

    @staticmethod
    def of(row: FloatArray) -> "Pose2":
        """Return the pose with x (m), y (m) and yaw (rad) from an array, shape (3,)."""
        x_m, y_m, yaw_rad = row.tolist()
        return Pose2(x_m, y_m, yaw_rad)

    def to_outer(self, points: FloatArray) -> FloatArray:
        """Transform points, shape (..., 2) or (..., 3), from the inner frame to the outer frame (m)."""
        return points @ self._turn[: points.shape[-1], : points.shape[-1]].T + self._offset[: points.shape[-1]]

    def to_inner(self, points: FloatArray) -> FloatArray:
        """Transform points, shape (..., 2) or (..., 3), from the outer frame to the inner frame (m)."""
        return (points - self._offset[: points.shape[-1]]) @ self._turn[: points.shape[-1], : points.shape[-1]]

    def ahead(self, distance_m: float) -> "Pose2":
        """Return the pose `distance_m` further along its own x axis (backwards if negative)."""
        return Pose2(
            self.x_m + distance_m * math.cos(self.yaw_rad),
            self.y_m + distance_m * math.sin(self.yaw_rad),
            self.yaw_rad,
        )

    def moved(self, dx_m: float, dy_m: float) -> "Pose2":
        """Return the pose moved in the outer frame, with its heading kept."""
        return Pose2(self.x_m + dx_m, self.y_m + dy_m, self.yaw_rad)

    def between(self, other: "Pose2", fraction: float) -> "Pose2":
        """Return the pose a fraction of the way to another, turning the short way."""
        turn = wrapped_angle(other.yaw_rad - self.yaw_rad)
        return Pose2(
            self.x_m + fraction * (other.x_m - self.x_m),
            self.y_m + fraction * (other.y_m - self.y_m),
            self.yaw_rad + fraction * turn,
        )

    def to_dict(self) -> dict[str, float]:
        """Return the pose as JSON: ``{"x_m", "y_m", "yaw_rad"}``."""
        return {"x_m": self.x_m, "y_m": self.y_m, "yaw_rad": self.yaw_rad}

    @cached_property
    def _offset(self) -> FloatArray:
        return np.array((self.x_m, self.y_m, 0.0))

    @cached_property
    def _turn(self) -> FloatArray:
        cos, sin = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])


@dataclass(frozen=True, slots=True)
class Approach:
    """The direction in which a tool's fingers point, in the frame of the robot's base.

    Attributes:
        heading_rad: direction of the fingers in the horizontal plane, from the base's x axis (rad).
        pitch_rad: how far they point below the horizontal, 0..pi/2 (rad).
    """

    heading_rad: float
    pitch_rad: float

    @property
    def is_vertical(self) -> bool:
        """Whether the fingers point straight down."""
        return abs(self.pitch_rad - math.pi / 2) <= ANGLE_RAD

    @property
    def rotation(self) -> FloatArray:
        """The tool frame's axes in the base frame as columns, shape (3, 3), without roll.

        x is the approach axis, y horizontal, z = x cross y; fingers close along y.
        """
        ch, sh = math.cos(self.heading_rad), math.sin(self.heading_rad)
        cp, sp = math.cos(self.pitch_rad), math.sin(self.pitch_rad)
        return np.array([[cp * ch, -sh, sp * ch], [cp * sh, ch, sp * sh], [-sp, 0.0, cp]])
