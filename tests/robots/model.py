"""The PR2 in pinocchio: the reference for the closed form."""

import numpy as np
import pinocchio as pin

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from planner.robots.pr2.description import read_model
from planner.robots.pr2.kernel import reachable_batch
from planner.robots.pr2.robot import Pr2
from planner.robots.tool_path import ToolPath

MODEL = read_model()
DATA = MODEL.createData()


def the_pr2() -> Pr2:
    """Return the PR2 that plans are made for, with its closed form."""
    robot = load_robot("pr2")
    assert isinstance(robot, Pr2)
    return robot


def random_joints(card: RobotCard, arm: int, rng: np.random.Generator) -> FloatArray:
    """Return seven joints within their limits, continuous ones anywhere (rad)."""
    low, high = limits(card, arm)
    return rng.uniform(np.maximum(low, -6.0), np.minimum(high, 6.0))


def limits(card: RobotCard, arm: int) -> tuple[FloatArray, FloatArray]:
    """Return the lower and upper limits of an arm's joints (rad), infinite for continuous ones."""
    joints = [MODEL.joints[MODEL.getJointId(name)] for name in card.arms[arm].joint_names]
    low = [MODEL.lowerPositionLimit[j.idx_q] if j.nq == 1 else -np.inf for j in joints]
    high = [MODEL.upperPositionLimit[j.idx_q] if j.nq == 1 else np.inf for j in joints]
    return np.array(low), np.array(high)


def can_reach(robot: Pr2, arm: int, positions: FloatArray, rotations: FloatArray, torso_m: float) -> BoolArray:
    """Return which tool poses an arm of the robot can take with every joint within its limits, shape (n,)."""
    own = robot._arms[arm]
    points = own.mirrored_places(positions) - own.shoulder(torso_m)
    return reachable_batch(own.shape, points, own.mirrored_places(rotations[:, :, 0]))


def joints_near(
    robot: Pr2, arm: int, position: FloatArray, rotation: FloatArray, torso_m: float, near: FloatArray
) -> FloatArray | None:
    """Return joints of an arm that bring its tool to a pose, near to given ones (rad); None if it is out of reach."""
    path = ToolPath(position[None], rotation[None], np.empty(0), (0, 1))
    found = robot.arm_path_near(arm, path, torso_m, lambda _, joints: np.ones(len(joints), dtype=bool), near[None])
    if found is not None:
        return np.asarray(found[0])
    samples = robot.free_postures(arm, position, rotation, torso_m, lambda joints: np.ones(len(joints), dtype=bool))
    nearest = np.linalg.norm(samples - near, axis=1).argsort()
    return np.asarray(samples[nearest[0]]) if len(samples) else None


def pin_pose(frame: str, values: dict[str, float]) -> tuple[FloatArray, FloatArray]:
    """Return position and rotation of a frame in base_footprint, with joints set by name."""
    q = pin.neutral(MODEL)
    for name, value in values.items():
        joint = MODEL.joints[MODEL.getJointId(name)]
        q[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else (np.cos(value), np.sin(value))
    pin.forwardKinematics(MODEL, DATA, q)
    placement = pin.updateFramePlacement(MODEL, DATA, MODEL.getFrameId(frame))
    return placement.translation.copy(), placement.rotation.copy()


def pin_tool_pose(card: RobotCard, arm: int, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
    """Return position and rotation of an arm's tool in base_footprint."""
    return pin_arm_pose(card.arms[arm].tool_frame, card, arm, joints, torso_m)


def pin_arm_pose(
    frame: str, card: RobotCard, arm: int, joints: FloatArray, torso_m: float
) -> tuple[FloatArray, FloatArray]:
    """Return position and rotation of a frame of an arm in base_footprint."""
    names = card.arms[arm].joint_names
    assert card.lift_joint is not None
    values: dict[str, float] = {card.lift_joint: torso_m, **dict(zip(names, joints, strict=True))}
    return pin_pose(frame, values)
