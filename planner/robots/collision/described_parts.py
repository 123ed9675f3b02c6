"""The parts of a robot that a card and a URDF describe, made once and kept in the user's cache."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache, lru_cache, partial
from hashlib import blake2b
from json import dumps
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree.ElementTree import tostring

import numpy as np
from numpy.typing import NDArray

from planner.errors import RobotError
from planner.robots.collision import part_source
from planner.robots.collision.arm_kinematics import ArmChains
from planner.robots.collision.pair_choice import Choice, choose
from planner.robots.collision.part_poses import Index
from planner.robots.collision.part_source import Part, make_parts, openings_m
from planner.robots.collision.rigid_groups import BODY, Carrier
from planner.robots.collision.robot_parts import RobotParts
from planner.robots.collision.rounded_hull import hull_arrays, hull_from
from planner.robots.described_robot import DescribedRobot
from planner.robots.kept_arrays import Arrays, kept
from planner.robots.urdf_reader import parsed
from planner.user_cache import cache_folder

_FORMAT = 2
"""Version of the cache; raise it whenever parts or pairs are made or stored differently."""

_CALLED = ("name", "title")
"""Fields of a card on which neither parts nor the choice of pairs depend."""

_UNSHAPED = (*_CALLED, "base", "camera", "scene")
"""Fields of a card on which no part depends; nor does any on where an arm is at home and which joints lift it."""


@dataclass(frozen=True, slots=True)
class _Shaped:
    """A robot, equal to those of the same parts."""

    digest: str
    robot: DescribedRobot = field(compare=False)

    @staticmethod
    def of(robot: DescribedRobot) -> "_Shaped":
        card = {name: value for name, value in robot.card.to_dict().items() if name not in _UNSHAPED}
        card["arms"] = [{**arm, "home": None, "lifting": None} for arm in card["arms"]]
        return _Shaped(_digest(robot, card), robot)


class _Made(NamedTuple):
    parts: Sequence[Part]
    choice: Choice


@lru_cache(maxsize=16)
def described_parts(robot: DescribedRobot, directory: Path | None = None) -> RobotParts:
    """Return the parts of a robot (0.1 s; a few seconds when the cache has none yet).

    A cache that cannot be read is made again; a cache that cannot be written is ignored.

    Args:
        robot: the robot.
        directory: the cache directory; None: the platform's own.

    Raises:
        RobotError: a mesh cannot be read or is too large, or no link has a shape.
    """
    path = (directory or cache_folder()) / "shapes" / f"{_digest(robot, _card(robot))}.npz"
    made = kept(path, partial(_read, robot), partial(_make, robot), _arrays)
    return _robot_parts(robot, made.parts, made.choice)


def _make(robot: DescribedRobot) -> _Made:
    parts = _parts(_Shaped.of(robot))
    if not parts:
        raise RobotError("urdf", "no link has a shape")
    plain = _robot_parts(robot, parts, Choice((), np.empty((0, 2), dtype=np.int64)))
    joints = np.array([part.carrier.joint for part in parts])
    return _Made(parts, choose(plain, robot.arms, joints, [part.solids for part in parts]))


@lru_cache(maxsize=1)
def _parts(shaped: _Shaped) -> Sequence[Part]:
    """Return the parts of a robot; the last ones are kept, for a draft asks for them as it finds table and home."""
    return make_parts(shaped.robot)


def _robot_parts(robot: DescribedRobot, parts: Sequence[Part], choice: Choice) -> RobotParts:
    carriers = [part.carrier for part in parts]
    arms = np.array([_columns(carriers, arm, len(one.card.joints)) for arm, one in enumerate(robot.arms)])
    of_body = [carrier for carrier in carriers if carrier.arm == BODY]
    levels = range(part_source.LEVELS)
    hulls = tuple(tuple(part.hulls[level] for part in parts) for level in levels)
    convexes = {id(hull): hull.convex() for part in parts for hull in part.hulls}
    return RobotParts(
        kinematics=_kinematics(robot, carriers, arms),
        arms=arms,
        names=tuple(part.name for part in parts),
        openings_m=openings_m(robot),
        hulls=hulls,
        convexes=tuple(tuple(convexes[id(hull)] for hull in of_level) for of_level in hulls),
        is_mirrored=np.zeros(len(parts), dtype=np.bool_),
        is_tip=np.array([part.is_tip for part in parts]),
        low_parts=tuple(_first(carriers, arm, 1) for arm in range(len(robot.arms))),
        own_pairs=choice.own,
        body_poses=np.tile(np.vstack([np.eye(3), np.zeros(3)]), (len(of_body), 1, 1)),
        is_lifted=np.array([carrier.joint == 1 for carrier in of_body], dtype=np.bool_),
        skipped=frozenset((a, b) for a, b in choice.skipped.tolist()),
        is_fixed=robot.card.base.kind == "fixed",
    )


def _first(carriers: Sequence[Carrier], arm: int, joint: int) -> int:
    """Return the number of an arm's first part that a joint carries or one further out."""
    inner = [one for one in carriers if one.arm != BODY and (one.arm, one.joint) < (arm, joint)]
    return len(inner)


def _columns(carriers: Sequence[Carrier], arm: int, joints: int) -> tuple[int, int, int, int]:
    return _first(carriers, arm, 0), _first(carriers, arm, joints - 1), _first(carriers, arm + 1, 0), joints


def _kinematics(robot: DescribedRobot, carriers: Sequence[Carrier], arms: Index) -> ArmChains:
    chains = [arm.chain for arm in robot.arms]
    counts = [len(chain.low) for chain in chains]
    return ArmChains(
        roots=np.array([arm.root for arm in robot.arms]),
        first_joints=np.cumsum([0, *counts[:-1]]),
        rotations=np.vstack([chain.rotations for chain in chains]),
        offsets=np.vstack([chain.offsets for chain in chains]),
        is_prismatic=np.concatenate([chain.is_prismatic for chain in chains]),
        first_parts=np.append(arms[:, 0], arms[-1, 2]),
        carriers=np.array([one.joint for one in carriers if one.arm != BODY], dtype=np.int64),
    )


def _card(robot: DescribedRobot) -> dict[str, Any]:
    return {name: value for name, value in robot.card.to_dict().items() if name not in _CALLED}


def _digest(robot: DescribedRobot, card: dict[str, Any]) -> str:
    """Return a digest of everything that the parts depend on: the card, the URDF, its meshes, how parts are made.

    What the robot is called and where its files lie is left out, so a copy finds the parts of the first.
    """
    limits = {name: value for name, value in vars(part_source).items() if name.isupper()}
    digest = blake2b(f"{_FORMAT} {dumps(limits, default=str)}".encode(), digest_size=12)
    digest.update(dumps(card, sort_keys=True).encode())
    urdf, read = parsed(robot.urdf.encode()), cache(_digest_of)
    urdf.attrib.pop("name", None)
    for mesh in urdf.iter("mesh"):
        mesh.set("filename", read(mesh.get("filename", "")))
    digest.update(tostring(urdf))
    return digest.hexdigest()


def _digest_of(path: str) -> str:
    try:
        return blake2b(Path(path).read_bytes()).hexdigest()
    except OSError:
        return ""  # whoever makes the parts says what is wrong with it


def _arrays(made: _Made) -> dict[str, NDArray[Any]]:
    parts, choice = made
    carriers = [(part.carrier.arm, part.carrier.joint, int(part.carrier.is_finger)) for part in parts]
    found: dict[str, NDArray[Any]] = {
        "names": np.array([part.name for part in parts]),
        "carriers": np.array(carriers),
        "is_tip": np.array([part.is_tip for part in parts]),
        "skipped": choice.skipped,
    }
    found |= {f"own/{arm}": pairs for arm, pairs in enumerate(choice.own)}
    for number, part in enumerate(parts):
        for level, hull in enumerate(part.hulls[: _levels(part.carrier)]):
            found |= hull_arrays(f"{number}/{level}", hull)
    return found


def _read(robot: DescribedRobot, arrays: Arrays) -> _Made:
    """Return what is in a file; raise one of several errors where it is missing or malformed."""
    parts = []
    given = zip(arrays["names"].tolist(), arrays["carriers"].tolist(), arrays["is_tip"].tolist(), strict=True)
    for number, (name, (arm, joint, is_finger), is_tip) in enumerate(given):
        carrier = Carrier(arm, joint, bool(is_finger))
        hulls = [hull_from(arrays, f"{number}/{level}") for level in range(_levels(carrier))]
        levels = part_source.LEVELS
        parts.append(Part(name, carrier, tuple(hulls * (levels // len(hulls))), is_tip, ()))
    own = tuple(arrays[f"own/{arm}"] for arm in range(len(robot.arms)))
    return _Made(parts, Choice(own, arrays["skipped"]))


def _levels(carrier: Carrier) -> int:
    return part_source.LEVELS if carrier.is_finger else 1
