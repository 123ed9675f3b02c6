"""The limits within which a robot's controllers let its joints move.

A URDF's `limit` says where a joint stops; its `safety_controller` may say where the controller already resists: the
soft limits. Plans keep both, since a command beyond a soft limit is not followed.
"""

import math
from xml.etree.ElementTree import Element

import pinocchio as pin


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
