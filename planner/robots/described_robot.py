"""A robot read from its card: its composed URDF, its kinematic tree, and each of its arms as a chain."""

from collections import Counter
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, tostring

import numpy as np
import pinocchio as pin

from planner.errors import FieldError, RobotError
from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.card_file import ArmFile, CardFile
from planner.robots.card_parts import LinearDrive, Mount, ToolFile
from planner.robots.chain import Chain, length_of
from planner.robots.chain_reader import keep_soft_limits, read_chain
from planner.robots.known_robots import read_card, shipped_path, shipped_robots
from planner.robots.own_robots import own_card, own_robots
from planner.robots.urdf_reader import locate, mimics_of, parsed, read_urdf

REACH_MAX_M = 10.0
"""Arms that are longer, sliding joints included, are refused: their maps would be coarse."""


@dataclass(frozen=True, slots=True, eq=False)
class DescribedArm:
    """An arm of a described robot.

    Attributes:
        card: its part of the card.
        chain: its joints and its tool, seen from its root.
        root: where its root is in the base frame with the lift down (m), shape (3,).
        is_endless: which joints turn without end, shape (n,).
    """

    card: ArmFile
    chain: Chain
    root: FloatArray
    is_endless: BoolArray


@dataclass(frozen=True, slots=True, eq=False)
class DescribedRobot:
    """A robot as its card and its URDF describe it.

    Attributes:
        card: the card.
        urdf: the composed URDF, its root the base frame.
        arms: its arms, from left to right.
        lift_limits_m: the lowest and highest value of its lift; (0, 0) without one.
    """

    card: CardFile
    urdf: str
    arms: tuple[DescribedArm, ...]
    lift_limits_m: tuple[float, float]

    @staticmethod
    def of(card: CardFile, folder: Path) -> "DescribedRobot":
        """Read the URDF that a card names.

        Args:
            card: the card.
            folder: the card's folder.

        Raises:
            RobotError: names the card's field, and which link, joint, limit or mesh is wrong or missing.
        """
        urdf = composed_urdf(card, folder)
        try:
            model = pin.buildModelFromXML(urdf)
        except (ValueError, RuntimeError) as error:
            raise RobotError("urdf", f"is no tree of links and joints: {error}") from None
        tree = parsed(urdf.encode())
        keep_soft_limits(model, tree)
        for number, (name, _) in enumerate(card.resting):
            moving_joint(model, name, f"resting.{name}" if name else f"resting[{number}]")
        arms = []
        for number, arm in enumerate(card.arms):
            try:
                arms.append(_arm(model, card, arm))
            except FieldError as error:
                raise RobotError(f"arms[{number}].{error.field}", error.says or error.message) from None
        if card.camera is not None and card.camera.link is not None and not model.existFrame(card.camera.link):
            raise RobotError("camera.link", f"{card.camera.link!r} is no link of the URDF")
        limits = lift_limits(model, card)
        check_joints(model, card, mimics_of(tree.iterfind("joint")))
        if not limits[0] <= card.scene.torso_m <= limits[1]:
            said = "without a lift" if card.lift is None else f"the lift goes from {limits[0]:g} to {limits[1]:g}"
            raise RobotError("scene.torso_m", f"is {card.scene.torso_m}, {said}")
        return DescribedRobot(card, urdf, tuple(arms), limits)


def read_robot(name_or_path: str) -> DescribedRobot:
    """Return a robot, shipped or the user's own, by its name or by the path of its card.

    Raises:
        RobotError: there is no such card, or it or its URDF is not valid.
    """
    if name_or_path in shipped_robots():
        return _shipped(name_or_path)
    path = own_card(name_or_path) or Path(name_or_path)
    if not path.is_file():
        if name_or_path.endswith(".json"):
            raise RobotError("robot", f"there is no file {name_or_path!r}")
        known = (*shipped_robots(), *own_robots())
        raise RobotError("robot", f"there is no robot {name_or_path!r}, only {', '.join(known)}")
    return read_described(path)


@cache
def _shipped(name: str) -> DescribedRobot:
    return read_described(shipped_path(name))


def read_described(path: Path) -> DescribedRobot:
    """Return the robot of a card's file; raises `RobotError`."""
    return DescribedRobot.of(read_card(path), path.parent)


def _arm(model: pin.Model, card: CardFile, arm: ArmFile) -> DescribedArm:
    for number, (name, q) in enumerate(zip(arm.joints, arm.home, strict=True)):
        joint = moving_joint(model, name, f"joints[{number}]")
        if joint.nq > 1:
            continue
        low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
        if not low < high:
            raise RobotError(f"joints[{number}]", f"joint {name!r} has limits {low:g} and {high:g}")
        if not low <= q <= high:
            raise RobotError(f"home[{number}]", f"{q} is outside of the limits {low:g} and {high:g} of {name!r}")
        if arm.speeds is None and not 0.0 < model.velocityLimit[joint.idx_v] < np.inf:
            raise RobotError("speeds", f"the URDF gives joint {name!r} no speed, so the card must")
    for number, name in enumerate(arm.lifting):  # once the joints are known to be there: either list may be wrong
        if name not in arm.joints:
            raise RobotError(f"lifting[{number}]", f"{name!r} is no joint of this arm")
    moving_joint(model, arm.gripper.drive.joint, "gripper.drive.joint")
    named = [frame for frame in model.frames if frame.name == arm.tool.link]
    if not named:
        raise RobotError("tool.link", f"the URDF has no link or frame {arm.tool.link!r}")
    # A joint may be called as its link is.
    frame = next((frame for frame in named if frame.type == pin.FrameType.BODY), named[0])
    if frame.parentJoint != model.getJointId(arm.joints[-1]):
        carrier = model.names[frame.parentJoint]
        raise RobotError("tool.link", f"{arm.tool.link!r} is carried by {carrier!r}, not by {arm.joints[-1]!r}")
    chain, root = read_chain(model, arm.joints, frame.placement * _tool(arm.tool), dict(card.resting))
    if not length_of(chain) <= REACH_MAX_M:
        raise RobotError(
            "joints", f"the arm is {length_of(chain):.3g} m long, at most {REACH_MAX_M:g} m can be planned for"
        )
    is_endless = np.array([model.joints[model.getJointId(name)].nq > 1 for name in arm.joints])
    return DescribedArm(arm, chain, root, is_endless)


def _tool(tool: ToolFile) -> pin.SE3:
    """Return the tool in the frame it is fixed to: x along the approach axis, y along the closing axis."""
    approach, closing = np.array(tool.approach), np.array(tool.closing)
    for name, axis in (("approach", approach), ("closing", closing)):
        if not 1e-6 < np.abs(axis).max() < 1e6:
            raise RobotError(f"tool.{name}", "has no direction")
    closing = closing / np.linalg.norm(closing)
    x = approach / np.linalg.norm(approach)
    across = closing - (closing @ x) * x
    if not np.linalg.norm(across) > 1e-3:
        raise RobotError("tool.closing", "is along the approach axis")
    y = across / np.linalg.norm(across)
    return pin.SE3(np.column_stack([x, y, np.cross(x, y)]), np.array(tool.offset_m))


def lift_limits(model: pin.Model, card: CardFile) -> tuple[float, float]:
    """Return the lowest and highest value of a robot's lift (m); (0, 0) without one.

    Raises:
        RobotError: the lift is no joint of the robot, or does not slide straight up.
    """
    if card.lift is None:
        return 0.0, 0.0
    joint = moving_joint(model, card.lift, "lift")
    data, q = model.createData(), pin.neutral(model)
    pin.computeJointJacobians(model, data, q)
    axis = pin.getJointJacobian(model, data, model.getJointId(card.lift), pin.LOCAL_WORLD_ALIGNED)[:, joint.idx_v]
    if not np.allclose(axis, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0], atol=1e-6):
        raise RobotError("lift", f"joint {card.lift!r} does not slide straight up")
    return float(model.lowerPositionLimit[joint.idx_q]), float(model.upperPositionLimit[joint.idx_q])


_ROUNDED = 1e-3
"""A card's numbers may be rounded (m, rad)."""


def moving_joint(model: pin.Model, name: str, field: str) -> pin.JointModel:
    """Return a joint that moves in one direction, by name; raise `RobotError` if there is none."""
    if not model.existJointName(name):
        raise RobotError(field, f"the URDF has no moving joint {name!r}")
    joint = model.joints[model.getJointId(name)]
    if joint.nv != 1:
        raise RobotError(field, f"joint {name!r} has {joint.nv} degrees of freedom, not one")
    return joint


def check_joints(model: pin.Model, card: CardFile, mimics: Mapping[str, tuple[str, float, float]]) -> None:
    """Refuse joints that would be moved twice, that others drive, or that would be outside of their limits.

    Args:
        model: the robot's kinematic tree.
        card: the card.
        mimics: the joints that mimic another, see `mimics_of`.

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
            raise RobotError(field, f"{name!r} mimics {mimics[name][0]!r}, so it cannot be moved by itself")
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


BASE_LINK = "pleat_base"
"""The composed URDF's root: the base frame."""


def composed_urdf(card: CardFile, folder: Path) -> str:
    """Return the URDF of a card's robot, its root the base frame, the paths of its meshes absolute.

    Args:
        card: the card.
        folder: the card's folder.

    Raises:
        RobotError: a URDF is missing or refused (see `planner.robots.urdf_reader`), or the link that a tool is fixed to
            is missing, or two links or joints have one name.
    """
    body = read_urdf(locate(card.urdf, folder, "urdf"), "urdf")
    for number, tool in enumerate(card.tools):
        field = f"tools[{number}]"
        links = {link.get("name") for link in body.findall("link")}
        if tool.link not in links:
            raise RobotError(f"{field}.link", f"there is no link {tool.link!r}")
        _join(body, read_urdf(locate(tool.urdf, folder, f"{field}.urdf"), f"{field}.urdf"), tool.link, tool.mount)
    whole = Element("robot", name=card.name)
    SubElement(whole, "link", name=BASE_LINK)
    for mount in card.mounts:
        _join(whole, deepcopy(body), BASE_LINK, mount)
    _drop_prefixed(whole)
    for tag in ("link", "joint"):
        ((twice, times),) = Counter(one.get("name") for one in whole.iterfind(tag)).most_common(1) or (("", 0),)
        if times > 1:
            raise RobotError("mounts", f"two {tag}s are called {twice!r}: mounts and tools need names of their own")
    return tostring(whole, encoding="unicode")


def _drop_prefixed(element: Element) -> None:
    """Drop elements and attributes with prefixes that nothing declares: they are another program's, and no XML."""
    for name in [name for name in element.attrib if ":" in name]:
        del element.attrib[name]
    for child in list(element):
        if ":" in child.tag:
            element.remove(child)
        else:
            _drop_prefixed(child)


def _join(whole: Element, part: Element, parent: str, mount: Mount) -> None:
    """Add a URDF's links and joints to another, prefixed by the mount's name, its root fixed to a link."""
    prefix = f"{mount.name}_" if mount.name else ""
    children = {child.get("link") for child in part.findall("joint/child")}
    roots = [link for link in part.findall("link") if link.get("name") not in children]
    if len(roots) != 1:
        raise RobotError("urdf", f"the URDF has {len(roots)} root links, not one")
    materials = {one.get("name") for one in whole.findall("material")}
    whole.extend(one for one in part.findall("material") if one.get("name") not in materials)
    joint = SubElement(whole, "joint", name=f"{parent}_carries_{prefix}{roots[0].get('name')}", type="fixed")
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=f"{prefix}{roots[0].get('name')}")
    place = (mount.x_m, mount.y_m, mount.z_m)
    turn = (mount.roll_rad, mount.pitch_rad, mount.yaw_rad)
    SubElement(joint, "origin", xyz=" ".join(map(repr, place)), rpy=" ".join(map(repr, turn)))
    for one in (*part.findall("link"), *part.findall("joint")):
        one.set("name", f"{prefix}{one.get('name')}")
        for tag, key in (("parent", "link"), ("child", "link"), ("mimic", "joint")):
            for reference in one.findall(tag):
                reference.set(key, f"{prefix}{reference.get(key)}")
        whole.append(one)
