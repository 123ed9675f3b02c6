"""The PR2's left arm in pinocchio alone: the reference for every answer about reach."""

from functools import cache

import numpy as np
import pinocchio as pin

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import ANGLE_RAD
from planner.robots.pr2.description import read_model
from planner.robots.pr2.robot import pr2_card

TORSO_M = 0.29
"""The torso's height in all queries about reach (m)."""

ALL_ROUND_RAD = np.pi
"""Largest start angle in a search of a joint that turns without end: half a turn either way."""


class PinArm:
    """The left arm, all else locked. Seven joints from the shoulder outwards (rad), tool in the base frame (m).

    Attributes:
        low: lower limits, -inf for joints that turn without end (rad), shape (7,).
        high: upper limits, shape (7,).
    """

    def __init__(self) -> None:
        """Read the robot's description and lock all but the left arm."""
        whole = read_model()
        card = pr2_card(whole)
        q = pin.neutral(whole)
        q[whole.joints[whole.getJointId(card.lift_joint)].idx_q] = TORSO_M
        names = card.arms[0].joint_names
        locked = [number for number, name in enumerate(whole.names) if number > 0 and name not in names]
        self._model = pin.buildReducedModel(whole, locked, q)
        self._data = self._model.createData()
        self._tool = self._model.getFrameId(card.arms[0].tool_frame)
        joints = [self._model.joints[self._model.getJointId(name)] for name in names]
        self._is_endless = np.array([joint.nq > joint.nv for joint in joints])
        self._places = np.array([joint.idx_q for joint in joints])
        limited = zip(joints, self._is_endless, strict=True)
        lows_and_highs = [
            (-np.inf, np.inf)
            if is_endless
            else (self._model.lowerPositionLimit[joint.idx_q], self._model.upperPositionLimit[joint.idx_q])
            for joint, is_endless in limited
        ]
        self.low, self.high = np.array(lows_and_highs).T

    def random_joints(self, random: np.random.Generator, count: int) -> FloatArray:
        """Return uniform random joints within their limits, shape (count, 7); joints without limits within a turn."""
        low, high = np.maximum(self.low, -ALL_ROUND_RAD), np.minimum(self.high, ALL_ROUND_RAD)
        bounded = np.where(self._is_endless, low, self.low), np.where(self._is_endless, high, self.high)
        return random.uniform(*bounded, (count, 7))

    @property
    def middle(self) -> FloatArray:
        """The middle of each joint's range, 0 for those without limits (rad), shape (7,)."""
        low, high = (np.where(self._is_endless, 0.0, limits) for limits in (self.low, self.high))
        middle: FloatArray = 0.5 * (low + high)
        return middle

    def clamped(self, joints: FloatArray) -> FloatArray:
        """Return joints clipped to their limits."""
        clamped: FloatArray = np.minimum(np.maximum(joints, self.low), self.high)
        return clamped

    def is_within_limits(self, joints: FloatArray) -> bool:
        """Return whether all joints are within their limits, up to rounding."""
        return bool(np.all(joints >= self.low - ANGLE_RAD) and np.all(joints <= self.high + ANGLE_RAD))

    def tool(self, joints: FloatArray) -> pin.SE3:
        """Return the tool's pose."""
        pin.forwardKinematics(self._model, self._data, self._q(joints))
        return pin.updateFramePlacement(self._model, self._data, self._tool)

    def tool_and_jacobian(self, joints: FloatArray) -> tuple[pin.SE3, FloatArray]:
        """Return the tool's pose and its Jacobian in its own frame, shape (6, 7)."""
        q = self._q(joints)
        jacobian = pin.computeFrameJacobian(self._model, self._data, q, self._tool, pin.LOCAL)
        pin.forwardKinematics(self._model, self._data, q)
        return pin.updateFramePlacement(self._model, self._data, self._tool), jacobian

    def residual(self, joints: FloatArray, point: FloatArray, rotation: FloatArray) -> float:
        """Return the tool's deviation from a pose: the worst coordinate (m), or rotation entry; inf beyond limits."""
        if not self.is_within_limits(joints):
            return np.inf
        tool = self.tool(joints)
        return max(float(np.abs(tool.translation - point).max()), float(np.abs(tool.rotation - rotation).max()))

    def _q(self, joints: FloatArray) -> FloatArray:
        q = np.empty(self._model.nq)
        q[self._places] = np.where(self._is_endless, np.cos(joints), joints)
        q[self._places[self._is_endless] + 1] = np.sin(joints[self._is_endless])
        return q


@cache
def pin_arm() -> PinArm:
    """Return the shared arm; two threads must not use it."""
    return PinArm()
