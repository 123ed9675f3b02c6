"""The speeds and accelerations that a smooth motion keeps."""

import math
from dataclasses import dataclass

import numpy as np

from planner.geometry.pose import FloatArray
from planner.robots.card import ArmCard, RobotCard
from planner.task.scene import Scene

RISE_S = 0.25
"""The time in which a joint comes to its top speed, where a card gives no acceleration (s); the URDF never does."""

BASE_TURN_ACCELERATION_RAD_S2 = 1.0
"""The base's angular acceleration (rad/s2)."""

BASE_NAMES = ("base_x_m", "base_y_m", "base_yaw_rad")
"""The base's part of a motion."""


@dataclass(frozen=True)
class MotionLimits:
    """Top speeds and accelerations of arms, grippers and base.

    Attributes:
        names: the arms' joints, arm by arm, then the grippers' joints, then `BASE_NAMES`.
        speeds: the top speeds (rad/s, m/s), shape (names,).
        accelerations: the top accelerations (rad/s2, m/s2), shape (names,).
    """

    names: tuple[str, ...]
    speeds: FloatArray
    accelerations: FloatArray

    @staticmethod
    def of(card: RobotCard, scene: Scene) -> "MotionLimits":
        """Return the limits of a robot in a scene.

        The base's acceleration bounds the length of its vector, so each axis has its share.
        """
        grippers = [arm.gripper for arm in card.arms]
        joints = [name for arm in card.arms for name in arm.joint_names] + [hand.joint_name for hand in grippers]
        speeds = [speed for arm in card.arms for speed in arm.speeds_rad_s] + [hand.speed for hand in grippers]
        hard = [own for arm in card.arms for own in _accelerations(arm)] + [hand.speed / RISE_S for hand in grippers]
        axis = card.base_acceleration_m_s2 / math.sqrt(2.0)
        return MotionLimits(
            (*joints, *BASE_NAMES),
            np.array([*speeds, scene.base_speed_m_s, scene.base_speed_m_s, scene.base_turn_rad_s]),
            np.array([*hard, axis, axis, BASE_TURN_ACCELERATION_RAD_S2]),
        )

    def excess(self, velocities: FloatArray, accelerations: FloatArray) -> float:
        """Return the factor by which time must be stretched to keep the limits; arrays of shape (n, names)."""
        fast = float((np.abs(velocities) / self.speeds).max(initial=1.0))
        hard = float((np.abs(accelerations) / self.accelerations).max(initial=1.0))
        return max(fast, math.sqrt(hard))


def _accelerations(arm: ArmCard) -> tuple[float, ...]:
    return arm.accelerations or tuple(speed / RISE_S for speed in arm.speeds_rad_s)
