"""Read an arm off a robot's kinematic tree as a chain, and the limits of joints.

A URDF's `limit` says where a joint stops; its `safety_controller` may say where the controller already resists: the
soft limits. Plans keep both, since a command beyond a soft limit is not followed.
"""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from xml.etree.ElementTree import Element

import numpy as np
import pinocchio as pin

from planner.errors import RobotError
from planner.geometry.pose import FloatArray
from planner.robots.chain import AXIS, PITCH, WHOLE, Chain

_ALONG = math.cos(math.radians(1.0))
"""Two axes count as parallel where the cosine between them is at least this."""


def read_chain(
    model: pin.Model, joint_names: Sequence[str], tool: pin.SE3, resting: Mapping[str, float]
) -> tuple[Chain, FloatArray]:
    """Return an arm, and where its root is in the base frame (m), shape (3,).

    The root is the first joint's place, its axes are parallel to those of the base.

    Args:
        model: the robot's kinematic tree, its root the base frame.
        joint_names: the arm's joints, from the base outwards.
        tool: the tool in the last joint's frame, x along the approach axis, y along the closing axis.
        resting: where other joints rest; those that are not named are at 0.

    Raises:
        RobotError: the joints do not follow each other from the base outwards, or have limits that are no numbers.
    """
    ids = [model.getJointId(name) for name in joint_names]
    for number, (inner, outer) in enumerate(pairwise(ids), start=1):
        if inner not in model.supports[outer]:
            raise RobotError(
                f"joints[{number}]", f"{joint_names[number]!r} does not follow {joint_names[number - 1]!r}"
            )
    data, q = model.createData(), at_rest(model, resting, joint_names)
    pin.computeJointJacobians(model, data, q)
    axes = [pin.getJointJacobian(model, data, i, pin.LOCAL)[:, model.joints[i].idx_v] for i in ids]
    is_prismatic = np.array([not np.any(axis[3:]) for axis in axes])
    frames = [
        data.oMi[i].rotation @ _with_z(axis[:3] if slides else axis[3:])
        for i, axis, slides in zip(ids, axes, is_prismatic, strict=True)
    ]
    places = [data.oMi[i].translation for i in ids]
    before = [np.eye(3), *frames[:-1]]
    steps = [np.zeros(3), *(after - here for here, after in pairwise(places))]
    low, high = (np.array([_limit(model, i, end) for i in ids]) for end in ("lower", "upper"))
    turns = ~is_prismatic & (high - low >= math.tau - 1e-9)
    in_last = frames[-1].T @ data.oMi[ids[-1]].rotation
    offset = in_last @ tool.translation
    chain = Chain(
        np.array([inner.T @ outer for inner, outer in zip(before, frames, strict=True)]),
        np.array([frame.T @ step for frame, step in zip(before, steps, strict=True)]),
        is_prismatic,
        low,
        high,
        turns,
        np.ascontiguousarray(in_last @ tool.rotation),
        np.ascontiguousarray(offset),
        AXIS,
        0.3 * float(sum(np.linalg.norm(step) for step in steps) + np.linalg.norm(offset)),
    )
    return chain._replace(rows=_rows(chain)), np.array(places[0])


def at_rest(model: pin.Model, resting: Mapping[str, float], moving: Sequence[str] = ()) -> FloatArray:
    """Return the configuration in which some joints rest where they are said to, and all others are at 0."""
    q: FloatArray = pin.neutral(model)
    for name in moving:
        joint = model.joints[model.getJointId(name)]
        if joint.nq == 1:
            q[joint.idx_q] = 0.0
    for name, value in resting.items():
        set_joint(model, q, name, value)
    return q


def set_joint(model: pin.Model, q: FloatArray, name: str, value: float) -> None:
    """Set a joint of a configuration (rad, m); one that turns without end has a cosine and a sine there."""
    joint = model.joints[model.getJointId(name)]
    q[joint.idx_q : joint.idx_q + joint.nq] = [value] if joint.nq == 1 else [math.cos(value), math.sin(value)]


def _rows(chain: Chain) -> int:
    """Return which rows of a pose the arm must meet where the roll does not matter to the cloth."""
    if len(chain.low) <= 5:
        return PITCH
    gives_roll = not chain.is_prismatic[-1] and abs(chain.tool_rotation[2, 0]) >= _ALONG
    return AXIS if gives_roll and chain.high[-1] - chain.low[-1] >= math.pi else WHOLE


def _limit(model: pin.Model, joint: int, end: str) -> float:
    """Return a joint's lower or upper limit; half a turn if it has none."""
    kind = model.joints[joint]
    if kind.nq != 1:
        return -math.pi if end == "lower" else math.pi
    limits = model.lowerPositionLimit if end == "lower" else model.upperPositionLimit
    return float(limits[kind.idx_q])


def _with_z(axis: FloatArray) -> FloatArray:
    """Return a rotation whose z axis is a given unit vector."""
    z = axis / np.linalg.norm(axis)
    x = np.cross(np.eye(3)[np.argmin(np.abs(z))], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def limits_of(joint: Element) -> tuple[float, float]:
    """Return the lowest and highest value that a joint of a URDF may take (rad, m), soft limits kept.

    A joint that turns without end, or has no limits, goes from minus to plus infinity. Soft limits that leave no room
    between them are none, as ROS has it: both are 0 where they are left out.
    """
    limit, soft = joint.find("limit"), joint.find("safety_controller")
    if limit is None or joint.get("type") == "continuous":
        return -math.inf, math.inf
    low, high = float(limit.get("lower", 0.0)), float(limit.get("upper", 0.0))
    if soft is not None:
        soft_low, soft_high = float(soft.get("soft_lower_limit", 0.0)), float(soft.get("soft_upper_limit", 0.0))
        if soft_low < soft_high:
            return max(low, soft_low), min(high, soft_high)
    return low, high


def keep_soft_limits(model: pin.Model, urdf: Element) -> pin.Model:
    """Narrow the position limits of a kinematic tree to the soft limits of its URDF, and return it."""
    for joint in urdf.iterfind("joint"):
        name = joint.get("name", "")
        if joint.find("safety_controller") is not None and model.existJointName(name):
            own = model.joints[model.getJointId(name)]
            if own.nq == 1:
                model.lowerPositionLimit[own.idx_q], model.upperPositionLimit[own.idx_q] = limits_of(joint)
    return model
