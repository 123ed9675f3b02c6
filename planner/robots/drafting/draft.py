"""A robot's card drafted from its URDF: what it says, what can be guessed from its shapes, and what stays unknown."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from shutil import copyfile
from typing import Literal
from xml.etree.ElementTree import Element, indent, tostring

import numpy as np
import pinocchio as pin

from planner.errors import RobotError
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.robots.card_doubts import stations_in_table
from planner.robots.card_file import VERSION, ArmFile, BaseFile, CardFile, SuitableScene
from planner.robots.card_parts import GripperFile, LinearDrive, Mount, ToolFile, UrdfFile
from planner.robots.card_robot import CardRobot
from planner.robots.chain import length_of, tool_poses
from planner.robots.chain_reader import limits_of, set_joint
from planner.robots.collision.link_shapes import link_shapes
from planner.robots.collision.rigid_groups import BODY, Skeleton
from planner.robots.described_robot import DescribedRobot
from planner.robots.drafting.jaws import Hand, Jaws, hands_of, read_jaws
from planner.robots.tool_point import tool_points
from planner.robots.urdf_reader import read_urdf
from planner.robots.urdf_shapes import Source

URDF, MESHES = Path("urdf"), Path("meshes")
"""Where a draft's URDF and its meshes are, below the card."""

TABLE_M = 0.75
"""The height of the table beside which, or on which, a robot is put (m)."""

_STANDS_M = 0.55
"""A robot whose shoulders are higher over its lowest part stands on the floor, a lower one on the table (m)."""

_LOWEST_TABLE_M, _HIGHEST_TABLE_M = 0.5, 0.95
"""The lowest and highest table before which a robot on the floor is put: a couch table's and a counter's height (m)."""

_JOINT_SPEED, _SLIDE_SPEED, _FINGER_S = 1.0, 0.1, 0.5
"""Speeds where a URDF has none (rad/s, m/s), and the time in which fingers close then (s)."""

_LIFTED_ARM = 6
"""A joint that slides straight up before as many others of an arm is a lift."""

_TRIES = 2000
"""Postures among which a home is looked for."""

_GAP_M = 0.02
"""How far a robot stands from the table's edge (m)."""


@dataclass(frozen=True, slots=True)
class Draft:
    """A drafted card.

    Attributes:
        card: the card.
        guesses: what was guessed, a sentence each.
        unknown: what only its owner knows, a sentence each.
    """

    card: CardFile
    guesses: tuple[str, ...]
    unknown: tuple[str, ...]


def draft_robot(source: Source, name: str, title: str, folder: Path) -> Draft:
    """Draft the card of a robot: write its URDF and its meshes below a folder, and return the card.

    Args:
        source: the URDF.
        name: the robot's name, which its files get too.
        title: its name for people.
        folder: the folder in which the card is to be.

    Raises:
        RobotError: the URDF is refused, none of its arms ends in a gripper, or a gripper's shapes do not tell how it
            closes.
        OSError: the system refuses to write.
    """
    urdf = read_urdf(source, "urdf")
    hands = hands_of(urdf)
    if not hands:
        raise RobotError(
            "urdf",
            "has no arm of 4 or more joints that ends in a gripper; where the gripper has a URDF of its own, "
            "write a card that joins the two under tools",
        )
    jaws = [read_jaws(urdf, hand) for hand in hands]
    path = _written(urdf, name, folder)
    return _Drafting(urdf, hands, jaws, folder).draft(name, title, UrdfFile(path.as_posix()))


def _written(urdf: Element, name: str, folder: Path) -> Path:
    """Write a URDF and copies of its meshes; return its path below the folder."""
    (folder / URDF).mkdir(parents=True, exist_ok=True)
    (folder / MESHES).mkdir(exist_ok=True)
    absolute = {mesh: Path(mesh.get("filename", "")) for mesh in urdf.iter("mesh")}
    copies: dict[Path, str] = {}
    for mesh, file in absolute.items():
        if file not in copies:
            taken = {copy.casefold() for copy in copies.values()}
            names = (f"{file.stem}{'' if n == 0 else f'-{n}'}{file.suffix}" for n in count())
            copies[file] = next(one for one in names if one.casefold() not in taken)
            copyfile(file, folder / MESHES / copies[file])
        mesh.set("filename", f"../{MESHES}/{copies[file]}")
    indent(urdf)
    path = URDF / f"{name}.urdf"
    (folder / path).write_bytes(tostring(urdf, encoding="utf-8", xml_declaration=True))
    for mesh, file in absolute.items():
        mesh.set("filename", str(file))
    return path


class _Drafting:
    """The making of one card."""

    def __init__(self, urdf: Element, hands: Sequence[Hand], jaws: Sequence[Jaws], folder: Path) -> None:
        self._joints = {joint.get("name", ""): joint for joint in urdf.iterfind("joint")}
        self._hands, self._jaws, self._folder = hands, jaws, folder
        self._guesses: list[str] = []
        self._unknown: list[str] = []
        text = tostring(urdf, encoding="unicode")
        self._model = pin.buildModelFromXML(text)
        data, q = self._model.createData(), pin.neutral(self._model)
        pin.forwardKinematics(self._model, data, q)
        self._places = {self._model.names[i]: data.oMi[i].copy() for i in range(self._model.njoints)}
        shapes = link_shapes(self._model, text)
        corners = [data.oMi[one.joint].act(point) for one in shapes for point in one.corners]
        self._lowest_m = min((float(point[2]) for point in corners), default=0.0)

    def draft(self, name: str, title: str, urdf: UrdfFile) -> Draft:
        """Return the card, its home, its tool points and its station found on the robot that it describes."""
        lift = self._lift()
        drafted = [
            (hand, jaws, self._arm(hand, jaws, lift)) for hand, jaws in zip(self._hands, self._jaws, strict=True)
        ]
        drafted.sort(key=lambda one: -self._root(one[2])[1])
        arms = tuple(
            replace(arm, name=label) for (_, __, arm), label in zip(drafted, _names(len(drafted)), strict=True)
        )
        shoulder_m = float(np.mean([self._root(arm)[2] for arm in arms])) - self._lowest_m
        stands = shoulder_m > _STANDS_M
        z_m = (0.0 if stands else TABLE_M) - self._lowest_m
        self._guesses.append(
            f"it stands on the floor, its lowest part at 0 m: its shoulders are {shoulder_m:.2f} m high"
            if stands
            else f"it stands on a table of {TABLE_M:g} m, at its edge: mounts has z_m {z_m:.3f}"
        )
        self._unknown.append("where it looks: x of its URDF's root is taken as ahead; yaw_rad of the mount turns it")
        mount = Mount(z_m=round(z_m, 4))
        base = BaseFile(self._base_kind(stands), 0.5, (0.5, 0.5))
        torso_m = 0.0 if lift is None else max(limits_of(self._joints[lift])[0], 0.0)
        scene = SuitableScene(Table(), (("front", Pose2(-1.0, 0.0, 0.0)),), Pose2(0.0, 0.0, 0.0), torso_m)
        card = CardFile(VERSION, name, title, urdf, arms, base, scene, (mount,), lift=lift)
        card = self._at_tips(card)
        card = self._at_table(card, self._described(card), stands)
        card = self._lifting(self._at_home(card, self._described(card)))
        self._unknown += [
            "accelerations, and speeds under load: the URDF has none of the first, and makers' speeds are top speeds",
            "how flat each gripper may come over the table (pinch)",
            "the camera that looks at the cloth: one over the table is taken",
        ]
        return Draft(card, tuple(self._guesses), tuple(self._unknown))

    def _described(self, card: CardFile) -> DescribedRobot:
        return DescribedRobot.of(card, self._folder)

    def _root(self, arm: ArmFile) -> FloatArray:
        return np.asarray(self._places[arm.joints[0]].translation)

    def _lift(self) -> str | None:
        """Return the joint that raises all arms straight up, if there is one."""
        first = [(*hand.shared, *hand.arm) for hand in self._hands]
        for name in first[0]:
            if not all(name in chain and len(chain) - chain.index(name) > _LIFTED_ARM for chain in first):
                continue
            joint = self._joints[name]
            axis = np.array([float(x) for x in _attribute(joint, "axis", "xyz", "1 0 0").split()])
            if joint.get("type") == "prismatic" and (self._places[name].rotation @ axis)[2] > 0.999 * np.linalg.norm(
                axis
            ):
                self._guesses.append(f"{name!r} is the lift, and stays down (scene.torso_m)")
                return name
        return None

    def _arm(self, hand: Hand, jaws: Jaws, lift: str | None) -> ArmFile:
        joints = tuple(name for name in hand.arm if name != lift)
        limits = [limits_of(self._joints[name]) for name in joints]
        home = tuple(float(min(max(0.0, low), high)) for low, high in limits)
        speeds = tuple(self._speed(name) for name in joints)
        own = [_number(self._joints[name], "limit", "velocity") for name in joints]
        if min(own) <= 0.0:
            self._guesses.append(f"speeds of {joints[0]!r} to {joints[-1]!r}: the URDF has none for some of them")
        if resting := [name for name in hand.shared if name != lift]:
            self._guesses.append(f"{', '.join(map(repr, resting))} rest: they move more than one arm")
        if jaws.coupled:
            followers = ", ".join(repr(one) for one, _, __ in jaws.coupled)
            self._guesses.append(
                f"with {jaws.driver!r} move {followers}, from closed to open: so says the draft's URDF, not the given"
            )
        self._guesses.append(
            f"the gripper of {joints[-1]!r}: {jaws.driver!r} closes it at {jaws.closed:g} and opens it at "
            f"{jaws.opened:g}, the ends of its range, by {1000.0 * jaws.opening_m:.0f} mm"
        )
        if len(hand.fingers) > 2:
            self._unknown.append(f"whether the {len(hand.fingers)} fingers at {joints[-1]!r} hold cloth as two jaws do")
        link = _attribute(self._joints[joints[-1]], "child", "link", "")
        way = abs(jaws.opened - jaws.closed)
        gripper = GripperFile(
            LinearDrive(jaws.driver, jaws.closed, jaws.opened),
            round(jaws.opening_m, 4),
            *jaws.finger_m,
            speed=_number(self._joints[jaws.driver], "limit", "velocity") or round(way / _FINGER_S, 4),
        )
        tool = ToolFile(link, _rounded(jaws.approach), _rounded(jaws.closing), _rounded(jaws.tool_m))
        return ArmFile("arm", joints, tool, home, gripper, None if min(own) > 0.0 else speeds)

    def _speed(self, name: str) -> float:
        slides = self._joints[name].get("type") == "prismatic"
        return _number(self._joints[name], "limit", "velocity") or (_SLIDE_SPEED if slides else _JOINT_SPEED)

    def _base_kind(self, stands: bool) -> Literal["fixed", "omni", "differential"]:
        wheels = [name for name in self._joints if "wheel" in name.lower()]
        if not (stands and wheels):
            self._guesses.append("its base does not move" + ("" if not stands else ": there are no wheels"))
            return "fixed"
        is_omni = any(word in name.lower() for name in wheels for word in ("mecanum", "omni", "swerve", "steer"))
        kind: Literal["omni", "differential"] = "omni" if is_omni else "differential"
        self._guesses.append(f"its base is {kind}, by the names of its wheels, as {wheels[0]!r}")
        self._unknown.append(
            "how fast the base drives and turns; speed_m_s .25 and turn_rad_s .5 are Pleat's usual ones"
        )
        return kind

    def _at_tips(self, card: CardFile) -> CardFile:
        """Return the card with tool points 5 mm behind the fingertips and between them, by the shapes themselves."""
        off = {point.arm: point for point in tool_points(self._described(card))}
        arms = []
        for arm in card.arms:
            tool, point = arm.tool, off.get(arm.name)
            if point is not None:
                along = (point.beyond_m - 0.005) * np.array(tool.approach)
                aside = (point.beside_m or 0.0) * np.array(tool.closing)
                tool = replace(tool, offset_m=_rounded(np.array(tool.offset_m) + along + aside))
            arms.append(replace(arm, tool=tool))
            place = ", ".join(f"{value:.3f}" for value in tool.offset_m)
            self._guesses.append(
                f"the tool point of {arm.name!r} is at ({place}) m in {tool.link!r}, at its fingertips"
            )
        return replace(card, arms=tuple(arms))

    def _at_table(self, card: CardFile, robot: DescribedRobot, stands: bool) -> CardFile:
        """Return the card with a table that the arms reach, the base's size, and a station that is free."""
        skeleton = Skeleton(robot)
        body = [
            skeleton.points(one)
            for one in link_shapes(skeleton.model, robot.urdf)
            if skeleton.carrier(one.joint).arm == BODY
        ]
        floor = np.vstack(body)[:, :2] if body else np.zeros((1, 2))
        low, high = floor.min(axis=0), floor.max(axis=0)
        length_m, width_m = (float(round(min(max(one, 0.05), 3.0), 2)) for one in (high - low).tolist())
        radius = float(round(min(max(np.linalg.norm(floor, axis=1).max(), 0.05), 3.0), 2))
        reach_m = max(length_of(arm.chain) for arm in robot.arms)
        shoulder_m = float(np.mean([arm.root[2] for arm in robot.arms]))
        height_m = float(np.clip(round(shoulder_m - 0.3 * reach_m, 2), _LOWEST_TABLE_M, _HIGHEST_TABLE_M))
        if not stands:
            height_m = TABLE_M
        depth_m, table_width_m = (float(np.clip(round(share * reach_m, 1), 0.4, 1.6)) for share in (0.8, 1.1))
        table = Table(depth_m=depth_m, width_m=table_width_m, height_m=height_m)
        roots_m = [float(arm.root[0]) for arm in robot.arms]
        if max(roots_m) - min(roots_m) > depth_m:  # arms that face each other have the table between them
            x_m = round(-float(np.mean(roots_m)), 2) + 0.0
        else:
            x_m = round(-(0.5 * depth_m + max(float(high[0]), 0.0) + _GAP_M), 2)
        station = ("front", Pose2(x_m, 0.0, 0.0))
        collisions = CardRobot(robot).collisions(table, card.scene.torso_m)
        for found in stations_in_table((station,), collisions):
            if found.back_m is not None:
                station = ("front", Pose2(round(x_m - found.back_m, 2), 0.0, 0.0))
        self._guesses.append(
            f"a table {table.depth_m:g} m deep, {table.width_m:g} m wide and {table.height_m:g} m high suits arms of "
            f"{reach_m:.2f} m, and the base stands {abs(station[1].x_m):g} m from its middle"
        )
        near = Pose2(round(-0.15 * table.depth_m, 2), 0.0, 0.0)
        return replace(
            card,
            base=replace(card.base, radius_m=radius, size_m=(length_m, width_m)),
            scene=SuitableScene(table, (station,), near, card.scene.torso_m),
        )

    def _at_home(self, card: CardFile, robot: DescribedRobot) -> CardFile:
        """Return the card with arms folded over the table's near edge, their grippers down, where nothing touches."""
        collisions = CardRobot(robot).collisions(card.scene.table, card.scene.torso_m)
        (_, station), *_ = card.scene.stations
        random = np.random.default_rng(0)
        homes = [np.array(arm.home) for arm in card.arms]
        for number, arm in enumerate(robot.arms):
            chain, reach_m = arm.chain, length_of(arm.chain)
            low, high = (np.clip(ends, -np.pi, np.pi) for ends in (chain.low, chain.high))
            tried = np.vstack([homes[number], random.uniform(low, high, (_TRIES, len(low)))]).round(3)
            places, turns = tool_poses(chain, tried)
            wanted = np.array([0.4 * reach_m, 0.0, card.scene.table.height_m + 0.25 * reach_m - arm.root[2]])
            down = turns[..., 0] @ np.array([0.35, 0.0, -0.94])
            bent = np.abs(tried - 0.5 * (low + high)) / (high - low)
            costs = np.linalg.norm(places - wanted, axis=1) / reach_m - 0.3 * down + 0.2 * (bent**2).mean(axis=1)
            for best in costs.argsort():
                if not ((tried[best] >= chain.low) & (tried[best] <= chain.high)).all():
                    continue
                joined = np.concatenate([*homes[:number], tried[best], *homes[number + 1 :]])[None]
                if collisions.arm_free(number, station, tried[best][None])[0] and (
                    number + 1 < len(homes) or collisions.free(station, joined)[0]
                ):
                    homes[number] = tried[best]
                    self._guesses.append(
                        f"home of {arm.card.name!r}: bent over the table's near edge, gripper down, touching nothing"
                    )
                    break
            else:
                self._unknown.append(f"a home of {arm.card.name!r}: in none of those tried it touches nothing")
        arms = (replace(arm, home=tuple(home.tolist())) for arm, home in zip(card.arms, homes, strict=True))
        return replace(card, arms=tuple(arms))

    def _lifting(self, card: CardFile) -> CardFile:
        """Return the card with the joints that raise elbow and gripper: those that lie flat when the arm is at home."""
        data, q = self._model.createData(), pin.neutral(self._model)
        for arm in card.arms:
            for name, value in zip(arm.joints, arm.home, strict=True):
                set_joint(self._model, q, name, value)
        pin.computeJointJacobians(self._model, data, q)

        def lifts(name: str) -> bool:
            number = self._model.getJointId(name)
            column = pin.getJointJacobian(self._model, data, number, pin.LOCAL_WORLD_ALIGNED)
            turn = column[3:, self._model.joints[number].idx_v]
            return float(np.linalg.norm(turn)) > 0.0 and abs(float(turn[2])) < 0.5

        arms = (replace(arm, lifting=tuple(name for name in arm.joints[:-2] if lifts(name))) for arm in card.arms)
        return replace(card, arms=tuple(arms))


def _names(arms: int) -> Iterator[str]:
    if arms <= 2:
        return iter(("arm",) if arms == 1 else ("left", "right"))
    return (f"arm-{number + 1}" for number in range(arms))


def _attribute(joint: Element, tag: str, key: str, default: str) -> str:
    element = joint.find(tag)
    return default if element is None else element.get(key, default)


def _number(joint: Element, tag: str, key: str) -> float:
    return float(_attribute(joint, tag, key, "0"))


def _rounded(point: FloatArray) -> tuple[float, float, float]:
    x, y, z = (float(value) + 0.0 for value in point.round(4))
    return x, y, z
