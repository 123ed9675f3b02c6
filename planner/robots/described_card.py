"""The card that planning and the stage read, of a robot described by a JSON card and a URDF."""

import math
import tempfile
from collections.abc import Iterator, Mapping
from hashlib import blake2b
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import pinocchio as pin
from platformdirs import user_cache_path

from planner.robots.card import ArmCard, GripperCard, LinearGripper, ParallelogramGripper, RobotCard
from planner.robots.card_file import ArmFile
from planner.robots.card_parts import GripperFile, ParallelogramDrive
from planner.robots.described_robot import DescribedRobot

_MOVING = ("revolute", "continuous", "prismatic")


def robot_card(robot: DescribedRobot) -> RobotCard:
    """Return the card of a described robot; its composed URDF is written to the user's cache."""
    card, model = robot.card, pin.buildModelFromXML(robot.urdf)
    arms = tuple(_arm_card(model, arm.card) for arm in robot.arms)
    moved = {name for arm in arms for name in (*arm.joint_names, arm.gripper.joint_name)} | {card.lift}
    path = _kept_urdf(robot.urdf)
    return RobotCard(
        name=card.name,
        title=card.title,
        arms=arms,
        base_kind=card.base.kind,
        base_size_m=card.base.size_m,
        base_radius_m=card.base.radius_m,
        lift_joint=card.lift,
        lift_limits_m=robot.lift_limits_m,
        resting=tuple(_resting(fromstring(robot.urdf), moved, dict(card.resting))),
        urdf_path=path,
        package_dir=path.parent,
        base_acceleration_m_s2=card.base.acceleration_m_s2,
    )


def _arm_card(model: pin.Model, arm: ArmFile) -> ArmCard:
    joints = [model.joints[model.getJointId(name)] for name in arm.joints]
    own = tuple(float(model.velocityLimit[joint.idx_v]) for joint in joints)
    return ArmCard(
        name=arm.name,
        joint_names=arm.joints,
        speeds_rad_s=own if arm.speeds is None else arm.speeds,
        is_continuous=tuple(joint.nq > joint.nv for joint in joints),
        tool_frame=arm.tool.link,
        home=arm.home,
        gripper=_gripper_card(model, arm.gripper),
        lifting=arm.lifting,
        accelerations=arm.accelerations,
    )


def _gripper_card(model: pin.Model, gripper: GripperFile) -> GripperCard:
    drive = gripper.drive
    speed = gripper.speed or float(model.velocityLimit[model.joints[model.getJointId(drive.joint)].idx_v])
    if isinstance(drive, ParallelogramDrive):
        size = (drive.link_x_m, drive.link_y_m, gripper.opening_max_m, gripper.finger_width_m)
        return ParallelogramGripper(drive.joint, *size, speed)
    ends = (drive.closed, drive.opened)
    return LinearGripper(drive.joint, *ends, gripper.opening_max_m, gripper.finger_width_m, speed)


def _resting(urdf: Element, moved: set[str | None], given: Mapping[str, float]) -> Iterator[tuple[str, float]]:
    """Yield the actuated joints that no arm, gripper or lift moves, and where they rest: within limits, near 0."""
    for joint in urdf.iterfind("joint"):
        name = joint.get("name", "")
        if joint.get("type") in _MOVING and joint.find("mimic") is None and name not in moved:
            limit = joint.find("limit")
            is_bounded = limit is not None and joint.get("type") != "continuous"
            low = float(limit.get("lower", 0.0)) if limit is not None and is_bounded else -math.inf
            high = float(limit.get("upper", 0.0)) if limit is not None and is_bounded else math.inf
            yield name, given.get(name, min(max(0.0, low), high))


def _kept_urdf(urdf: str) -> Path:
    """Return the path of a file that holds a composed URDF."""
    name = f"{blake2b(urdf.encode(), digest_size=12).hexdigest()}.urdf"
    for folder in (user_cache_path("pleat") / "urdf", Path(tempfile.gettempdir())):
        path = folder / name
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if not path.is_file():
                part = path.with_suffix(f".{id(urdf)}")
                part.write_text(urdf, encoding="utf-8")
                part.replace(path)
        except OSError:
            continue
        return path
    raise OSError(f"there is no room for {name}")
