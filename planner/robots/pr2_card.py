"""The PR2's card, with numbers read from the URDF where it has them."""

import math

import pinocchio as pin

from planner.robots.arm import JOINTS, MIRROR
from planner.robots.card import ArmCard, ParallelogramGripper, RobotCard
from planner.robots.description import package_directory, urdf_path

_LIFT = "torso_lift_joint"

_LIFTING = (1, 3)
"""Indices of the joints that raise elbow and hand: shoulder lift and elbow flex."""

_HOME = (0.8, -0.2, 0.0, -1.6, math.pi, -1.4, 0.0)
"""Home joints of the left arm: raised beside the body, elbow bent upwards, the gripper pointing ahead (rad)."""

_RESTING = (("head_pan_joint", 0.0), ("head_tilt_joint", 0.6), ("laser_tilt_mount_joint", 0.0))
"""Resting joints of head and laser: the head looks down at the table (rad)."""


def pr2_card(model: pin.Model) -> RobotCard:
    """Return the card of a PR2 from its kinematic tree."""
    lift = model.joints[model.getJointId(_LIFT)].idx_q
    return RobotCard(
        name="pr2",
        title="PR2",
        arms=(_arm_card(model, "left", 1.0), _arm_card(model, "right", -1.0)),
        base_kind="omni",
        base_size_m=(0.669, 0.667),
        base_radius_m=0.47,
        lift_joint=_LIFT,
        lift_limits_m=(float(model.lowerPositionLimit[lift]), float(model.upperPositionLimit[lift])),
        resting=_RESTING,
        urdf_path=urdf_path(),
        package_dir=package_directory(),
        eye_frame="head_plate_frame",
    )


def _arm_card(model: pin.Model, name: str, side: float) -> ArmCard:
    prefix = name[0]
    joint_names = tuple(f"{prefix}_{joint}" for joint in JOINTS)
    joints = [model.joints[model.getJointId(joint)] for joint in joint_names]
    return ArmCard(
        name=name,
        joint_names=joint_names,
        speeds_rad_s=tuple(float(model.velocityLimit[joint.idx_v]) for joint in joints),
        is_continuous=tuple(joint.nq > joint.nv for joint in joints),
        tool_frame=f"{prefix}_gripper_tool_frame",
        home=tuple(q if side > 0 else q * float(mirror) for q, mirror in zip(_HOME, MIRROR, strict=True)),
        gripper=_gripper_card(model, prefix),
        lifting=tuple(joint_names[joint] for joint in _LIFTING),
        is_mirrored=side < 0,
    )


def _gripper_card(model: pin.Model, prefix: str) -> ParallelogramGripper:
    finger = model.joints[model.getJointId(f"{prefix}_gripper_l_finger_joint")]
    hinge = model.jointPlacements[model.getJointId(f"{prefix}_gripper_l_finger_tip_joint")].translation
    return ParallelogramGripper(
        joint_name=f"{prefix}_gripper_l_finger_joint",
        link_x_m=float(hinge[0]),
        link_y_m=float(hinge[1]),
        opening_max_m=0.09,
        finger_width_m=0.022,
        speed=float(model.velocityLimit[finger.idx_v]),
    )
