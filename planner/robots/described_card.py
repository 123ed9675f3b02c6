"""The card that planning and the 3D view read, of a robot described by a JSON card and a URDF."""

import math
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import replace
from hashlib import blake2b
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import pinocchio as pin

from planner.robots.card import ArmCard, GripperCard, LinearGripper, ParallelogramGripper, RobotCard
from planner.robots.card_file import ArmFile, CardFile
from planner.robots.card_parts import GripperFile, ParallelogramDrive
from planner.robots.chain_reader import keep_soft_limits, limits_of
from planner.robots.described_robot import DescribedRobot
from planner.robots.urdf_reader import MOVING
from planner.user_cache import cache_folder, use


def robot_card(robot: DescribedRobot) -> RobotCard:
    """Return the card of a described robot; its composed URDF is written to the user's cache."""
    tree = fromstring(robot.urdf)
    model = keep_soft_limits(pin.buildModelFromXML(robot.urdf), tree)
    card = card_on(robot.card, model, robot.lift_limits_m, _kept_urdf(robot.urdf))
    moved = {name for arm in card.arms for name in (*arm.joint_names, arm.gripper.joint_name)} | {card.lift_joint}
    return replace(card, resting=tuple(_resting(tree, moved, dict(card.resting))))


def card_on(
    card: CardFile, model: pin.Model, lift_limits_m: tuple[float, float], urdf: Path, package: Path | None = None
) -> RobotCard:
    """Return the card that a JSON card makes with numbers from its URDF.

    Args:
        card: the JSON card.
        model: the kinematic tree that the URDF describes.
        lift_limits_m: the lowest and highest value of the lift.
        urdf: the URDF's path.
        package: the directory to which the URDF's ``package://`` addresses are relative; None: the URDF's own.
    """
    return RobotCard(
        name=card.name,
        title=card.title,
        arms=tuple(_arm_card(model, arm) for arm in card.arms),
        base_kind=card.base.kind,
        base_size_m=card.base.size_m,
        base_radius_m=card.base.radius_m,
        lift_joint=card.lift,
        lift_limits_m=lift_limits_m,
        resting=card.resting,
        urdf_path=urdf,
        package_dir=urdf.parent if package is None else package,
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
        gripper=gripper_card(model, arm.gripper),
        lifting=arm.lifting,
        accelerations=arm.accelerations,
        limits=tuple(_limits(model, joint) for joint in joints),
    )


def _limits(model: pin.Model, joint: pin.JointModel) -> tuple[float, float]:
    """Return the lowest and highest value of a joint; infinite where it turns without end."""
    if joint.nq > joint.nv:
        return -math.inf, math.inf
    return float(model.lowerPositionLimit[joint.idx_q]), float(model.upperPositionLimit[joint.idx_q])


def gripper_card(model: pin.Model, gripper: GripperFile) -> GripperCard:
    """Return the gripper of a JSON card, with its speed from the kinematic tree where the card has none."""
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
        if joint.get("type") in MOVING and joint.find("mimic") is None and name not in moved:
            low, high = limits_of(joint)
            yield name, given.get(name, min(max(0.0, low), high))


def _kept_urdf(urdf: str) -> Path:
    """Return the path of a file that holds a composed URDF."""
    name = f"{blake2b(urdf.encode(), digest_size=12).hexdigest()}.urdf"
    for folder in (cache_folder() / "urdf", Path(tempfile.gettempdir())):
        path = folder / name
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if not path.is_file():
                part = path.with_suffix(f".{id(urdf)}")
                part.write_text(urdf, encoding="utf-8")
                part.replace(path)
            if folder.parent == cache_folder():
                use(path)
        except OSError:
            continue
        return path
    raise OSError(f"there is no room for {name}")
