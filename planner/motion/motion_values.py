"""The moving parts of a plan as columns of numbers: their limits, their values, and derivatives by time."""

from dataclasses import dataclass

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.primitives.drive_time import TURN_ACCELERATION_RAD_S2
from planner.robots.card import FINGER_RISE_S, RobotCard
from planner.task.scene import Scene
from planner.task.trajectory import Trajectory

BASE_NAMES = ("base_x_m", "base_y_m", "base_yaw_rad")
"""The base's part of a motion."""


@dataclass(frozen=True)
class MotionLimits:
    """Limits of the arms' joints, top speeds and accelerations of arms, grippers and base.

    Attributes:
        names: the arms' joints, arm by arm, then the grippers' joints, then `BASE_NAMES`.
        speeds: the top speeds (rad/s, m/s), shape (names,); the base's is that of its way in any direction.
        accelerations: the top accelerations (rad/s2, m/s2), shape (names,), the base's alike.
        ranges: the lowest and highest value of each of the arms' joints (rad, m), shape (joints, 2).
    """

    names: tuple[str, ...]
    speeds: FloatArray
    accelerations: FloatArray
    ranges: FloatArray

    @staticmethod
    def of(card: RobotCard, scene: Scene) -> "MotionLimits":
        """Return the limits of a robot in a scene."""
        grippers = [arm.gripper for arm in card.arms]
        joints = [name for arm in card.arms for name in arm.joint_names] + [hand.joint_name for hand in grippers]
        speeds = [speed for arm in card.arms for speed in arm.speeds_rad_s] + [hand.speed for hand in grippers]
        hard = [own for arm in card.arms for own in arm.kept_accelerations] + [
            hand.speed / FINGER_RISE_S for hand in grippers
        ]
        base_hard = card.base_acceleration_m_s2
        return MotionLimits(
            (*joints, *BASE_NAMES),
            np.array([*speeds, scene.base_speed_m_s, scene.base_speed_m_s, scene.base_turn_rad_s]),
            np.array([*hard, base_hard, base_hard, TURN_ACCELERATION_RAD_S2]),
            np.array([ends for arm in card.arms for ends in arm.limits]),
        )


def positions_at(path: Trajectory, times_s: FloatArray) -> FloatArray:
    """Return joints, grippers and base at times of a plan, shape (n, names): rad, m; the base's yaw without jumps."""
    rows = [
        (*path.arms.at(t), *(track.position_at(t) for track in path.grippers), *_pose(path, t))
        for t in times_s.tolist()
    ]
    found = np.array(rows)
    found[:, -1] = np.unwrap(found[:, -1])
    return found


def velocities_at(path: Trajectory, times_s: FloatArray) -> FloatArray:
    """Return their velocities just after some times, shape (n, names): rad/s, m/s."""
    rows = [
        (
            *path.arms.velocities_at(t),
            *(track.velocity_at(t) for track in path.grippers),
            *path.segment_at(t).base_velocity_at(t),
        )
        for t in times_s.tolist()
    ]
    return np.array(rows)


def accelerations_at(path: Trajectory, times_s: FloatArray, end_s: float) -> FloatArray:
    """Return their accelerations just after some times, from `end_s` on just before that, shape (n, names).

    Accelerations jump where a step ends and the next begins.
    """
    rows = [
        (
            *path.arms.accelerations_at(t),
            *(track.acceleration_at(t) for track in path.grippers),
            *path.segment_at(t).base_acceleration_at(t),
        )
        for t in np.minimum(times_s, end_s - TIME_S).tolist()
    ]
    return np.array(rows)


def _pose(path: Trajectory, t_s: float) -> tuple[float, float, float]:
    pose = path.segment_at(t_s).base_at(t_s)
    return pose.x_m, pose.y_m, pose.yaw_rad
