"""The lengths and limits of an arm, read from the URDF.

The arms of a PR2 are mirror images of each other (y to -y). Everything is computed for the left arm: a query for the
right arm is mirrored, answered for the left arm, and the answer mirrored back. Reading checks this symmetry, and the
layout that the closed form requires: the seven axes z y x y x y x, with every link along x.

Limits are those of the model, which keeps the soft limits of the URDF's safety controllers (`soft_limits`).

Shapes are named tuples of numbers because compiled kernels take those as arguments.
"""

import math
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from planner.errors import FoldingError
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M

JOINTS = (
    "shoulder_pan_joint",
    "shoulder_lift_joint",
    "upper_arm_roll_joint",
    "elbow_flex_joint",
    "forearm_roll_joint",
    "wrist_flex_joint",
    "wrist_roll_joint",
)
"""The joints of an arm from the shoulder outwards, without the side's prefix."""

MIRROR = np.array([-1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
"""Factors that mirror the seven joint angles: z and x axes turn the other way round."""

_AXES = ("RZ", "RY", "RX", "RY", "RUBX", "RY", "RUBX")
_LIFT = "torso_lift_joint"


class Sector(NamedTuple):
    """The limits of one joint: the angles between two directions, counter-clockwise (rad)."""

    low: float
    high: float
    cos_low: float
    sin_low: float
    cos_high: float
    sin_high: float


class ArmShape(NamedTuple):
    """The left arm: the position of its shoulder, its lengths (m), its limits.

    The shoulder is the point of the pan axis at the height of the lift axis, in the base frame with the torso down.
    `offset` leads from there to the lift axis, `tool` from wrist to tool frame.
    """

    shoulder_x: float
    shoulder_y: float
    shoulder_z: float
    offset: float
    upper: float
    fore: float
    tool: float
    pan: Sector
    lift: Sector
    roll: Sector
    elbow: Sector
    wrist: Sector


def read_arm(model: pin.Model) -> ArmShape:
    """Return the left arm of a model; raise `FoldingError` where the closed form would not hold."""
    left, right = _read_side(model, "l"), _read_side(model, "r")
    if not np.allclose(numbers_of(left), numbers_of(_mirrored(right)), rtol=0.0, atol=ANGLE_RAD):
        raise FoldingError("the robot's arms are not mirror images of each other")
    return left


def _read_side(model: pin.Model, prefix: str) -> ArmShape:
    joints = [model.getJointId(f"{prefix}_{name}") for name in JOINTS]
    if tuple(model.joints[j].shortname().removeprefix("JointModel") for j in joints) != _AXES:
        raise FoldingError(f"the axes of arm {prefix!r} are not z y x y x y x")
    tool = model.frames[model.getFrameId(f"{prefix}_gripper_tool_frame")].placement
    offset, roll, upper, forearm, fore, wrist, tool_m = (
        _length(placement) for placement in (*(model.jointPlacements[j] for j in joints[1:]), tool)
    )
    if max(abs(roll), abs(forearm), abs(wrist)) > LENGTH_M:
        raise FoldingError(f"the axes of arm {prefix!r} do not meet in shoulder, elbow and wrist")
    x, y, z = model.jointPlacements[model.getJointId(_LIFT)].translation + _shoulder(model, joints[0])
    limits = [_limits(model, j) for j in joints if model.joints[j].nq == 1]
    return ArmShape(float(x), float(y), float(z), offset, upper, fore, tool_m, *limits)


def _shoulder(model: pin.Model, joint: int) -> FloatArray:
    translation: FloatArray = model.jointPlacements[joint].translation
    return translation


def _length(placement: pin.SE3) -> float:
    """Return the length of a link along x (m)."""
    along_x = pin.SE3(np.eye(3), np.array([placement.translation[0], 0.0, 0.0]))
    if not placement.isApprox(along_x, ANGLE_RAD):
        raise FoldingError(f"a link of the arm does not lie along x but leads to {placement.translation}")
    return float(placement.translation[0])


def _limits(model: pin.Model, joint: int) -> Sector:
    index = model.joints[joint].idx_q
    return sector(float(model.lowerPositionLimit[index]), float(model.upperPositionLimit[index]))


def sector(low: float, high: float) -> Sector:
    """Return the sector between two angles (rad)."""
    return Sector(low, high, math.cos(low), math.sin(low), math.cos(high), math.sin(high))


def _mirrored(shape: ArmShape) -> ArmShape:
    return shape._replace(
        shoulder_y=-shape.shoulder_y,
        pan=sector(-shape.pan.high, -shape.pan.low),
        roll=sector(-shape.roll.high, -shape.roll.low),
    )


def numbers_of(shape: ArmShape) -> FloatArray:
    """Return all lengths and limits of an arm as one array, shape (37,)."""
    return np.hstack(tuple(shape))
