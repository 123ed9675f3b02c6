"""The speeds and accelerations that a smooth motion keeps."""

import math
from dataclasses import dataclass

import numpy as np

from planner.geometry.pose import FloatArray
from planner.primitives.drive_time import TURN_ACCELERATION_RAD_S2
from planner.robots.card import ArmCard, RobotCard
from planner.task.scene import Scene

RISE_S = 0.25
"""The time in which a joint comes to its top speed, where a card gives no acceleration (s); the URDF never does."""

BASE_NAMES = ("base_x_m", "base_y_m", "base_yaw_rad")
"""The base's part of a motion."""

_DIRECTIONS = 8
"""Directions along which the base is bounded: the polygon of these bounds lies within the circle of its limits."""

_OBLIQUE_RAD = tuple(math.pi * turn / _DIRECTIONS for turn in range(_DIRECTIONS) if 2 * turn % _DIRECTIONS)
"""Those of the directions that are along neither axis (rad)."""


@dataclass(frozen=True)
class MotionLimits:
    """Top speeds and accelerations of arms, grippers and base.

    Attributes:
        names: the arms' joints, arm by arm, then the grippers' joints, then `BASE_NAMES`.
        speeds: the top speeds (rad/s, m/s), shape (names,); the base's is that of its way in any direction.
        accelerations: the top accelerations (rad/s2, m/s2), shape (names,), the base's alike.
    """

    names: tuple[str, ...]
    speeds: FloatArray
    accelerations: FloatArray

    @staticmethod
    def of(card: RobotCard, scene: Scene) -> "MotionLimits":
        """Return the limits of a robot in a scene."""
        grippers = [arm.gripper for arm in card.arms]
        joints = [name for arm in card.arms for name in arm.joint_names] + [hand.joint_name for hand in grippers]
        speeds = [speed for arm in card.arms for speed in arm.speeds_rad_s] + [hand.speed for hand in grippers]
        hard = [own for arm in card.arms for own in _accelerations(arm)] + [hand.speed / RISE_S for hand in grippers]
        base_hard = card.base_acceleration_m_s2
        return MotionLimits(
            (*joints, *BASE_NAMES),
            np.array([*speeds, scene.base_speed_m_s, scene.base_speed_m_s, scene.base_turn_rad_s]),
            np.array([*hard, base_hard, base_hard, TURN_ACCELERATION_RAD_S2]),
        )

    def bounded(self, values: FloatArray) -> FloatArray:
        """Return values of shape (n, names) with the base's ways along further directions, the columns of `bounds`."""
        x, y = values[:, -3], values[:, -2]
        return np.column_stack([values, *(x * math.cos(angle) + y * math.sin(angle) for angle in _OBLIQUE_RAD)])

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """The bounds of the columns of `bounded`, of either sign: speeds and accelerations, shape (columns,)."""
        return self._bounds(self.speeds), self._bounds(self.accelerations)

    def excess(self, velocities: FloatArray, accelerations: FloatArray) -> float:
        """Return the factor by which time must be stretched to keep the bounds; arrays of shape (n, columns)."""
        speeds, hard = self.bounds
        fast = float((np.abs(velocities) / speeds).max(initial=1.0))
        harder = float((np.abs(accelerations) / hard).max(initial=1.0))
        return max(fast, math.sqrt(harder))

    @staticmethod
    def _bounds(limits: FloatArray) -> FloatArray:
        inner = math.cos(0.5 * math.pi / _DIRECTIONS) * limits[-3]
        return np.array([*limits[:-3], inner, inner, limits[-1], *[inner] * len(_OBLIQUE_RAD)])


def _accelerations(arm: ArmCard) -> tuple[float, ...]:
    return arm.accelerations or tuple(speed / RISE_S for speed in arm.speeds_rad_s)
