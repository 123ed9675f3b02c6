"""Check the joints that a card names against its URDF, beyond those of the arms' chains."""

from collections.abc import Iterator, Mapping
from xml.etree.ElementTree import Element

import numpy as np
import pinocchio as pin

from planner.errors import RobotError
from planner.robots.card_file import ArmFile, CardFile
from planner.robots.card_parts import LinearDrive

_ROUNDED = 1e-3
"""A card's numbers may be rounded (m, rad)."""


def mimicking(urdf: Element) -> dict[str, str]:
    """Return the joints of a URDF that mimic another, and which."""
    found = ((joint.get("name", ""), joint.find("mimic")) for joint in urdf.iterfind("joint"))
    return {name: mimic.get("joint", "") for name, mimic in found if mimic is not None}


def moving_joint(model: pin.Model, name: str, field: str) -> pin.JointModel:
    """Return a joint that moves in one direction, by name; raise `RobotError` if there is none."""
    if not model.existJointName(name):
        raise RobotError(field, f"the URDF has no moving joint {name!r}")
    joint = model.joints[model.getJointId(name)]
    if joint.nv != 1:
        raise RobotError(field, f"joint {name!r} has {joint.nv} degrees of freedom, not one")
    return joint


def check_joints(model: pin.Model, card: CardFile, mimics: Mapping[str, str]) -> None:
    """Refuse joints that would be moved twice, that others drive, or that would be outside of their limits.

    Args:
        model: the robot's kinematic tree.
        card: the card.
        mimics: the joints that mimic another, and which.

    Raises:
        RobotError: names the card's field and the joint.
    """
    moved: dict[str, str] = {}
    for field, name in _moved(card):
        if name in moved:
            raise RobotError(field, f"{name!r} is {moved[name]} already")
        moved[name] = field
        moving_joint(model, name, field)
        if name in mimics:
            raise RobotError(field, f"{name!r} mimics {mimics[name]!r}, so it cannot be moved by itself")
    for number, arm in enumerate(card.arms):
        _check_drive(model, arm, f"arms[{number}].gripper")
    for name, value in card.resting:
        field = f"resting.{name}"
        joint = moving_joint(model, name, field)
        if name in moved:
            raise RobotError(field, f"{name!r} does not rest: it is {moved[name]}")
        _check_within(model, joint, value, field)


def _moved(card: CardFile) -> Iterator[tuple[str, str]]:
    """Yield the fields that name a joint to be moved, and the joint."""
    for number, arm in enumerate(card.arms):
        yield from ((f"arms[{number}].joints[{index}]", name) for index, name in enumerate(arm.joints))
        yield f"arms[{number}].gripper.drive.joint", arm.gripper.drive.joint
    if card.lift is not None:
        yield "lift", card.lift


def _check_drive(model: pin.Model, arm: ArmFile, field: str) -> None:
    drive = arm.gripper.drive
    joint = moving_joint(model, drive.joint, f"{field}.drive.joint")
    if arm.gripper.speed is None and not 0.0 < model.velocityLimit[joint.idx_v] < np.inf:
        raise RobotError(f"{field}.speed", f"the URDF gives joint {drive.joint!r} no speed, so the card must")
    if isinstance(drive, LinearDrive):
        _check_within(model, joint, drive.closed, f"{field}.drive.closed")
        _check_within(model, joint, drive.opened, f"{field}.drive.opened")


def _check_within(model: pin.Model, joint: pin.JointModel, value: float, field: str) -> None:
    if joint.nq > 1:
        return
    low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
    if not low - _ROUNDED <= value <= high + _ROUNDED:
        raise RobotError(field, f"{value} is outside of the limits {low:g} and {high:g}")
