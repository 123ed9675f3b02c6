"""The poses of the robot's tools in a trajectory, by pinocchio from the URDF and the joints' names alone."""

import math
from dataclasses import dataclass
from functools import cache
from importlib.metadata import distribution
from typing import Any

import numpy as np
import pinocchio as pin

Space = tuple[float, float, float]
URDF = "cmeel.prefix/share/example-robot-data/robots/pr2_description/urdf/pr2.urdf"
TOOLS = {"left": "l_gripper_tool_frame", "right": "r_gripper_tool_frame"}
CLOSED_M = 0.005


@cache
def robot() -> tuple[Any, Any]:
    model = pin.buildModelFromUrdf(str(distribution("example-robot-data").locate_file(URDF)))
    return model, model.createData()


@dataclass(frozen=True)
class Moment:
    """A sample: the tools in the table frame, their directions, whether they are closed, the base."""

    t_s: float
    primitive: int
    tools: dict[str, Space]
    headings: dict[str, Space]
    is_closed: dict[str, bool]
    base: Space


def seen(sample: dict[str, Any], table_height_m: float) -> Moment:
    """Return the forward kinematics of one sample of a timeline's JSON."""
    model, data = robot()
    q = pin.neutral(model)
    for name, value in sample["joints"].items():
        joint = model.joints[model.getJointId(name)]
        q[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else (math.cos(value), math.sin(value))
    pin.framesForwardKinematics(model, data, q)
    x, y, yaw = (sample["base"][k] for k in ("x_m", "y_m", "yaw_rad"))
    base = pin.SE3(pin.utils.rotate("z", yaw), np.array([x, y, -table_height_m]))
    poses = {arm: base * data.oMf[model.getFrameId(frame)] for arm, frame in TOOLS.items()}
    return Moment(
        sample["t_s"],
        sample["primitive"],
        {arm: tuple(pose.translation) for arm, pose in poses.items()},
        {arm: tuple(pose.rotation[:, 0]) for arm, pose in poses.items()},
        {arm: sample["grippers_m"][arm] <= CLOSED_M for arm in TOOLS},
        (x, y, yaw),
    )


def require_joint_limits(sample: dict[str, Any]) -> None:
    """Fail unless all actuated joints are there and within the URDF's limits."""
    model, _ = robot()
    for name, value in sample["joints"].items():
        assert model.existJointName(name), f"the URDF has no joint {name}"
        joint = model.joints[model.getJointId(name)]
        if joint.nq == 1:
            low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
            assert low - 1e-6 <= value <= high + 1e-6, f"{name} is {value:.4f} at {sample['t_s']:.2f} s"


def distance_to_way(point: Space, way: list[Space]) -> float:
    """Return the distance of a point from a polyline (m)."""
    spot, best = np.array(point), math.inf
    for a, b in zip(map(np.array, way[:-1]), map(np.array, way[1:]), strict=True):
        square = float((b - a) @ (b - a))
        share = 0.0 if square == 0.0 else float(np.clip((spot - a) @ (b - a) / square, 0.0, 1.0))
        best = min(best, float(np.linalg.norm(spot - a - share * (b - a))))
    return best
