"""Arms whose tools are a little beside where the robot believes them to be."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.rehearsal.camera.posture import Posture
from planner.geometry.pose import FloatArray
from planner.robots.load_robot import load_robot

_TURN_RAD = 1e-4
"""The turn of a joint by which its effect is told (rad)."""

_WEAK = 0.05
"""Ways in which joints move a tool so much less than in the best one count as ways in which they do not."""


def deflected(robot_name: str, posture: Posture, beside: Mapping[str, FloatArray]) -> Posture:
    """Return how a robot really stands: with the smallest errors of its joints that bring tools beside their places.

    Args:
        robot_name: the name of the robot.
        posture: how it believes to stand.
        beside: how far the tools of its arms are beside their places, table frame, shape (2,), m, by the arms' names.
    """
    robot = load_robot(robot_name)
    cos, sin = np.cos(posture.base.yaw_rad), np.sin(posture.base.yaw_rad)
    joints = dict(posture.joints)
    torso_m = joints.get(robot.card.lift_joint or "", 0.0)
    for number, arm in enumerate(robot.card.arms):
        if arm.name not in beside:
            continue
        x, y = beside[arm.name]
        now = np.array([joints[name] for name in arm.joint_names])
        places = robot.tool_places(number, np.vstack([now, now + _TURN_RAD * np.eye(len(now))]), torso_m)
        slopes = (places[1:] - places[0]).T / _TURN_RAD
        errors = np.linalg.pinv(slopes, rcond=_WEAK) @ np.array([cos * x + sin * y, cos * y - sin * x, 0.0])
        joints |= dict(zip(arm.joint_names, (now + errors).tolist(), strict=True))
    return replace(posture, joints=joints)
