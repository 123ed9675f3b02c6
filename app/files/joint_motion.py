"""A step's motion as it is sent: all joints at even times, from rest to rest."""

import math
import re
from dataclasses import dataclass

import numpy as np

from planner.geometry.keyframes import acceleration_at, rate_at, value_at
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.motion.joint_trajectory import Keyframes
from planner.motion.motion_values import MotionLimits, accelerations_at, positions_at, velocities_at
from planner.robots.card import RobotCard
from planner.task.plan import PlanStep
from planner.task.scene import Scene
from planner.task.trajectory import Trajectory

RATE_HZ = 50.0
"""Points a second."""

_ROUNDED = 1e-9
"""Velocities that are smaller are those of a joint at rest (rad/s, m/s)."""


@dataclass(frozen=True, slots=True, eq=False)
class JointMotion:
    """Joints, grippers and base over time.

    Attributes:
        names: the columns, as `MotionLimits.names` has them or fewer.
        times_s: from 0 on, strictly rising (s), shape (n,).
        positions, velocities, accelerations: at each time (rad, m), shape (n, names).
    """

    names: tuple[str, ...]
    times_s: FloatArray
    positions: FloatArray
    velocities: FloatArray
    accelerations: FloatArray

    @staticmethod
    def of(path: Trajectory, step: PlanStep, card: RobotCard, scene: Scene) -> "JointMotion":
        """Return the motion of a step of a plan."""
        times = np.linspace(0.0, step.duration_s, max(math.ceil(step.duration_s * RATE_HZ - TIME_S), 1) + 1)
        at = step.start_s + times
        names = MotionLimits.of(card, scene).names
        still = _still(velocities_at(path, at))
        return JointMotion(names, times, positions_at(path, at), still, accelerations_at(path, at, step.end_s))

    @staticmethod
    def along(names: tuple[str, ...], frames: Keyframes, speed: float) -> "JointMotion":
        """Return the motion of some joints over keyframes at a share of their speed."""
        lasts_s = float(frames.times_s[-1])
        at = np.linspace(0.0, lasts_s, max(math.ceil(lasts_s / speed * RATE_HZ - TIME_S), 1) + 1)
        positions, velocities, accelerations = (
            np.array([of(frames.times_s.tolist(), frames.joints, frames.velocities, t_s) for t_s in at.tolist()])
            for of in (value_at, rate_at, acceleration_at)
        )
        return JointMotion(names, at / speed, positions, _still(velocities * speed), accelerations * speed**2)

    @property
    def duration_s(self) -> float:
        """The duration (s)."""
        return float(self.times_s[-1])

    def of_joints(self, names: tuple[str, ...]) -> "JointMotion":
        """Return the motion of some of the names."""
        which = [self.names.index(name) for name in names]
        orders = (self.positions, self.velocities, self.accelerations)
        return JointMotion(names, self.times_s, *(values[:, which] for values in orders))

    def at(self, t_s: float) -> dict[str, float]:
        """Return the positions at a time (s), straight between the points."""
        columns = zip(self.names, self.positions.T, strict=True)
        return {name: float(np.interp(t_s, self.times_s, column)) for name, column in columns}


def _still(velocities: FloatArray) -> FloatArray:
    """Return velocities without what rounding left of rest: controllers refuse motions that do not end in it."""
    return np.asarray(np.where(np.abs(velocities) < _ROUNDED, 0.0, velocities))


def controllers(card: RobotCard) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """Return the controllers of a robot's arms and grippers, and their joints."""
    parts = (
        part
        for arm in card.arms
        for part in ((f"{arm.name}_arm", arm.joint_names), (f"{arm.name}_gripper", (arm.gripper.joint_name,)))
    )
    return tuple(parts)


def controller_name(name: str) -> str:
    """Return the name of the controller of a part of a robot, as ROS allows it in a topic."""
    allowed = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")
    return f"{allowed if allowed[:1].isalpha() else f'arm_{allowed}'}_controller"
