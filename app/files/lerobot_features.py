"""Names and units of a robot's moving parts in a LeRobot dataset.

The arms that LeRobot drives itself, SO-100 and SO-101, have its names and units, so that `lerobot-replay` can send an
episode to them: ``left_shoulder_pan.pos`` and so on in degrees, arm by arm, the gripper from 0 (closed) to 100 (open).
Every other robot has the names and units of its URDF.
"""

import math
from dataclasses import dataclass

from app.files.markup import read_markup
from planner.motion.motion_values import BASE_NAMES
from planner.robots.card import ArmCard, LinearGripper, RobotCard

_SO_JOINTS = ("shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll")
_SO_GRIPPER = "gripper"
_BASE_UNITS = ("m", "m", "rad")


@dataclass(frozen=True, slots=True)
class Part:
    """One number of a state or an action: (position - zero) * factor.

    Attributes:
        name: its name in the dataset.
        unit: its unit there: "deg", "rad", "m", or "0..100" for a gripper from closed to open.
        source: its name in `MotionLimits.names`.
        zero: the position (rad, m) at which it is 0.
        factor: its change for each rad or m.
    """

    name: str
    unit: str
    source: str
    zero: float = 0.0
    factor: float = 1.0


def parts_of(card: RobotCard) -> tuple[Part, ...]:
    """Return the parts of a robot that move in a plan."""
    if all(_is_so_arm(arm) for arm in card.arms):
        arms = tuple(part for arm in card.arms for part in _so_parts(arm))
    else:
        sliding = _sliding(card)
        joints = [name for arm in card.arms for name in arm.joint_names]
        joints += [arm.gripper.joint_name for arm in card.arms]
        arms = tuple(Part(name, "m" if name in sliding else "rad", name) for name in joints)
    if card.is_fixed:
        return arms
    return (*arms, *(Part(name, unit, name) for name, unit in zip(BASE_NAMES, _BASE_UNITS, strict=True)))


def _is_so_arm(arm: ArmCard) -> bool:
    """Return whether an arm has the joints of an SO-100 or SO-101, each with the same name before it, or none."""
    gripper = arm.gripper
    before = gripper.joint_name.removesuffix(_SO_GRIPPER)
    wanted = (*(before + name for name in _SO_JOINTS), before + _SO_GRIPPER)
    return isinstance(gripper, LinearGripper) and (*arm.joint_names, gripper.joint_name) == wanted


def _so_parts(arm: ArmCard) -> list[Part]:
    gripper = arm.gripper
    closed, opened = gripper.angle(0.0), gripper.angle(gripper.opening_max_m)
    joints = [Part(f"{name}.pos", "deg", name, factor=math.degrees(1.0)) for name in arm.joint_names]
    return [*joints, Part(f"{gripper.joint_name}.pos", "0..100", gripper.joint_name, closed, 100.0 / (opened - closed))]


def _sliding(card: RobotCard) -> frozenset[str]:
    """Return the names of the joints that slide instead of turning."""
    elements = read_markup(card.urdf_path.read_bytes()).walk()
    return frozenset(e.attributes.get("name", "") for e in elements if e.attributes.get("type") == "prismatic")
