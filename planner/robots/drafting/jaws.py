"""Find the grippers of a URDF by its joints, and how and where they close by their shapes.

A joint moves a finger if its name or its link's says so, or if others mimic it or it mimics another, and nothing else
hangs from it; fingers that slide opposite each other need no such name. Whatever leads from the root to a hand and to
no other hand is its arm. The shapes tell which end of the range closes a gripper, where its fingertips meet, and how it
is turned.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias
from xml.etree.ElementTree import Element, SubElement, tostring

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from planner.errors import RobotError
from planner.geometry.pose import FloatArray
from planner.robots.chain_reader import limits_of
from planner.robots.collision.link_shapes import LinkShape, link_shapes
from planner.robots.urdf_reader import MOVING, link_at, mimics_of

_FINGER = re.compile(r"finger|thumb|jaw|claw|knuckle|gripper|(?<![a-z])(index|middle|ring|little|pinky)(?![a-z])")
_CERTAIN = re.compile(r"finger|thumb|jaw|claw|knuckle")

JOINTS_MIN = 4
"""An arm has at least as many joints."""


@dataclass(frozen=True, slots=True)
class Hand:
    """A gripper and its arm.

    Attributes:
        arm: the joints that lead to it alone, from the base outwards.
        shared: the joints before those, which move other arms too.
        fingers: for each finger the joints that move it, from the hand outwards.
    """

    arm: tuple[str, ...]
    shared: tuple[str, ...]
    fingers: tuple[tuple[str, ...], ...]


def hands_of(urdf: Element) -> tuple[Hand, ...]:
    """Return the grippers at the ends of arms, in the URDF's order."""
    tree = _Tree(urdf)
    held: dict[str, list[str]] = {}
    for name, carrier in tree.carrier.items():
        if carrier is not None and tree.is_finger(name) and not tree.is_finger(carrier):
            held.setdefault(carrier, []).append(name)
    chains = {carrier: tree.chain(carrier) for carrier in held}
    found = []
    for carrier, tops in held.items():
        others = {name for other, chain in chains.items() if other != carrier for name in chain}
        chain = chains[carrier]
        arm = tuple(name for name in chain if name not in others)
        if len(arm) >= JOINTS_MIN:
            fingers = tuple((top, *tree.below(top)) for top in tops)
            found.append(Hand(arm, chain[: len(chain) - len(arm)], fingers))
    return tuple(found)


class _Tree:
    """The moving joints of a URDF: which hang from which."""

    def __init__(self, urdf: Element) -> None:
        joints = {joint.get("name", ""): joint for joint in urdf.iterfind("joint")}
        self._links = {name: link_at(joint, "child") for name, joint in joints.items()}
        by_child = {link: name for name, link in self._links.items()}
        self._kinds: Mapping[str, str] = {name: joint.get("type", "") for name, joint in joints.items()}
        self.carrier: dict[str, str | None] = {}
        for name, joint in joints.items():
            if self._kinds[name] not in MOVING:
                continue
            inner = by_child.get(link_at(joint, "parent"))
            while inner is not None and self._kinds[inner] not in MOVING:
                inner = by_child.get(link_at(joints[inner], "parent"))
            self.carrier[name] = inner
        mimics = {name: driver for name, (driver, _, __) in mimics_of(joints.values()).items()}
        self._coupled = {*mimics, *mimics.values()}
        self._carried: dict[str | None, list[str]] = {}
        for name, carrier in self.carrier.items():
            self._carried.setdefault(carrier, []).append(name)

    def below(self, name: str) -> Iterator[str]:
        """Yield all joints that hang from one, from there outwards."""
        for inner in self._carried.get(name, ()):
            yield inner
            yield from self.below(inner)

    def chain(self, name: str) -> tuple[str, ...]:
        """Return the joints that lead to one, that included, from the base outwards."""
        inner = self.carrier[name]
        return (name,) if inner is None else (*self.chain(inner), name)

    def is_finger(self, name: str) -> bool:
        """Return whether a joint moves a finger, or a part of one."""
        own, link = name.lower(), self._links[name].lower()
        carried = self._carried.get(name, [])
        if not all(self.is_finger(inner) for inner in carried):
            return False
        is_turning_a_hand = len(carried) > 1 and name not in self._coupled and not _CERTAIN.search(own + link)
        is_named = _FINGER.search(own) or _CERTAIN.search(link)  # the link of a wrist is often called the gripper
        return not is_turning_a_hand and (bool(is_named) or name in self._coupled or self._is_opposed(name))

    def _is_opposed(self, name: str) -> bool:
        """Return whether a joint slides, nothing hangs from it, and the same is true of one beside it."""
        beside = self._carried[self.carrier[name]]
        ends = [one for one in beside if self._kinds[one] == "prismatic" and not self._carried.get(one)]
        return name in ends and len(ends) > 1


_TIP_M = 0.02
"""Length of the fingertips that meet (m)."""

_BEHIND_TIP_M = 0.005
"""How far behind the fingertips the tool point is (m)."""

_A_LITTLE = 0.1
"""Share of the range by which a jaw is opened to see which way it moves."""

OPENING_MIN_M = 0.005
"""A gripper opens by more (m)."""

_STRAIGHT = np.cos(np.radians(20.0))
"""An axis this near to one of the link's is meant to be that (cosine)."""

_Values: TypeAlias = Mapping[str, float]
"""Joints by name (rad, m)."""


@dataclass(frozen=True, slots=True)
class Jaws:
    """A gripper, seen from the link that its arm's last joint carries.

    Attributes:
        driver: the joint that drives it.
        closed, opened: its values at both ends.
        coupled: the joints that follow it, though the URDF does not say so: the factor and the offset of each.
        approach, closing: where the fingers point, and along what they close.
        tool_m: the point between the fingertips (m).
        opening_m: how far apart the tips are when it is open (m).
        finger_m: a finger's length along the approach, its width, and its thickness along the closing axis (m).
    """

    driver: str
    closed: float
    opened: float
    coupled: tuple[tuple[str, float, float], ...]
    approach: FloatArray
    closing: FloatArray
    tool_m: FloatArray
    opening_m: float
    finger_m: tuple[float, float, float]


def read_jaws(urdf: Element, hand: Hand) -> Jaws:
    """Return how a hand closes, by its shapes; joints of it that follow no other are made to mimic the first.

    Args:
        urdf: the URDF, the paths of its meshes absolute; mimics are added to it.
        hand: the hand.

    Raises:
        RobotError: its fingers have no shapes or no limits, or do not move towards each other.
    """
    look = _Look(urdf, hand)
    driver, *others = look.drivers
    closed, opened = look.ends(driver)
    coupled = []
    for name in others:
        own_closed, own_opened = look.ends(name)
        factor = (own_opened - own_closed) / (opened - closed)
        coupled.append((name, factor, own_closed - factor * closed))
    for name, factor, offset in coupled:
        joint = next(one for one in urdf.iterfind("joint") if one.get("name") == name)
        SubElement(joint, "mimic", joint=driver, multiplier=repr(factor), offset=repr(offset))

    def at(share: float) -> _Values:
        value = closed + share * (opened - closed)
        return {driver: value} | {name: factor * value + offset for name, factor, offset in coupled}

    is_first = look.first_jaw(at(0.0), at(_A_LITTLE))
    sides, wide, opened_wide = (look.sides(at(share), is_first) for share in (0.0, _A_LITTLE, 1.0))
    if not len(sides[1]):
        raise RobotError("urdf", f"the finger of {driver!r} meets nothing: its hand has no shape")
    far = [_farthest(side) for side in sides]
    ways = [(wider[tip] - side[tip]).mean(axis=0) for side, wider, tip in zip(sides, wide, far, strict=True)]
    apart = ways[0] - ways[1]
    if not np.linalg.norm(apart) > 1e-4:
        raise RobotError("urdf", f"joint {driver!r} does not open its fingers")
    ahead = sum(side[tip].mean(axis=0) for side, tip in zip(sides, far, strict=True))
    closing = _straight(apart)
    approach = _straight(ahead - (ahead @ closing) * closing)
    closing = _unit(closing - (closing @ approach) * approach)
    tips, end = _tips(sides, approach)
    low, high = (tips[1] @ closing).max(), (tips[0] @ closing).min()
    across = np.cross(approach, closing)
    wide_m = np.concatenate([tip @ across for tip in tips])
    tool = (end - _BEHIND_TIP_M) * approach + 0.5 * (low + high) * closing
    tool = tool + 0.5 * (wide_m.min() + wide_m.max()) * across
    size = np.ptp(look.fingers(at(0.0))[0] @ np.column_stack([approach, across, closing]), axis=0)
    length, width, thickness = np.minimum(size, 0.2).round(3).tolist()
    is_tip = [side @ approach >= (side @ approach).max() - _TIP_M for side in sides]
    gaps = [_apart_m(*(side[tip] for side, tip in zip(now, is_tip, strict=True))) for now in (sides, opened_wide)]
    opening_m = min(gaps[1] - gaps[0], 0.5)
    if opening_m < OPENING_MIN_M:
        raise RobotError(
            "urdf",
            f"from one end of {driver!r} to the other the fingers open by {1000.0 * opening_m:.0f} mm: no gripper",
        )
    return Jaws(driver, closed, opened, tuple(coupled), approach, closing, tool, opening_m, (length, width, thickness))


class _Look:
    """A hand's points at values of its joints, in the frame of the joint that carries it."""

    def __init__(self, urdf: Element, hand: Hand) -> None:
        text = tostring(urdf, encoding="unicode")
        self._model = pin.buildModelFromXML(text)
        self._data = self._model.createData()
        self._carrier = self._model.getJointId(hand.arm[-1])
        joints = {joint.get("name", ""): joint for joint in urdf.iterfind("joint")}
        numbers = {name: self._model.getJointId(name) for finger in hand.fingers for name in finger}
        shapes = link_shapes(self._model, text, lambda joint: joint in {self._carrier, *numbers.values()})
        self._shapes: dict[int, list[LinkShape]] = {}
        for shape in shapes:
            self._shapes.setdefault(shape.joint, []).append(shape)
        # What has no shape is no finger but a part of the drive.
        fingers = [finger for finger in hand.fingers if any(numbers[name] in self._shapes for name in finger)]
        if not fingers:
            raise RobotError(
                "urdf", f"the fingers at {hand.arm[-1]!r} have no shapes, so where they meet cannot be seen"
            )
        self._fingers = [[numbers[name] for name in finger] for finger in fingers]
        self._mimics = mimics_of(joints[name] for finger in fingers for name in finger)
        driven = (self._mimics[name][0] if name in self._mimics else name for finger in fingers for name in finger)
        self.drivers = tuple(dict.fromkeys(driven))
        self._limits = {name: limits_of(joints[name]) for name in self.drivers}
        for name, (low, high) in self._limits.items():
            if not -np.inf < low < high < np.inf:
                raise RobotError("urdf", f"finger joint {name!r} has no limits")

    def ends(self, driver: str) -> tuple[float, float]:
        """Return the values of a driver at which its finger is next to the others, and away from them."""
        middle = {name: 0.5 * sum(ends) for name, ends in self._limits.items()}
        moves = {driver, *(name for name, (driven_by, _, __) in self._mimics.items() if driven_by == driver)}
        own = {self._model.getJointId(name) for name in moves}
        moved = next(number for number, finger in enumerate(self._fingers) if not own.isdisjoint(finger))
        found = []
        for value in self._limits[driver]:
            fingers = self.fingers(middle | {driver: value})
            others = [finger for number, finger in enumerate(fingers) if number != moved] or [self._fixed()]
            tip = fingers[moved][_farthest(fingers[moved], self._hinge(moved))]
            found.append((_apart_m(tip, np.vstack(others)), value))
        return min(found)[1], max(found)[1]

    def _hinge(self, finger: int) -> FloatArray:
        """Return where a finger hangs (m)."""
        return np.asarray(self._at({})[self._fingers[finger][0]].translation)

    def fingers(self, values: _Values) -> list[FloatArray]:
        """Return the points of each finger, shape (n, 3) each (m)."""
        places = self._at(values)
        return [
            np.vstack([_points(shape, places) for j in f for shape in self._shapes.get(j, ())]) for f in self._fingers
        ]

    def first_jaw(self, values: _Values, moved: _Values) -> tuple[bool, ...]:
        """Return which fingers go the way of the first from some values to others: they are one jaw."""
        here, there = self.fingers(values), self.fingers(moved)
        ways = [b.mean(axis=0) - a.mean(axis=0) for a, b in zip(here, there, strict=True)]
        return (True, *(bool(way @ ways[0] > 0.0) for way in ways[1:]))

    def sides(self, values: _Values, is_first: Sequence[bool]) -> tuple[FloatArray, FloatArray]:
        """Return the points of both jaws; the second one is the hand itself where all fingers are one jaw."""
        fingers = self.fingers(values)
        one, other = (
            [f for f, first in zip(fingers, is_first, strict=True) if first is side] for side in (True, False)
        )
        return np.vstack(one), np.vstack(other or [self._fixed()])

    def _fixed(self) -> FloatArray:
        shapes = self._shapes.get(self._carrier, ())
        places = self._at({})
        return np.vstack([_points(shape, places) for shape in shapes]) if shapes else np.empty((0, 3))

    def _at(self, values: _Values) -> list[pin.SE3]:
        q = pin.neutral(self._model)
        followed = {
            name: factor * values[driver] + offset
            for name, (driver, factor, offset) in self._mimics.items()
            if driver in values
        }
        for name, value in {**values, **followed}.items():
            joint = self._model.joints[self._model.getJointId(name)]
            if joint.nq == 1:
                q[joint.idx_q] = value
        pin.forwardKinematics(self._model, self._data, q)
        own = self._data.oMi[self._carrier]
        return [own.actInv(place) for place in self._data.oMi]


def _points(shape: LinkShape, places: Sequence[pin.SE3]) -> FloatArray:
    place = places[shape.joint]
    return np.asarray(shape.corners @ place.rotation.T + place.translation)


def _tips(sides: tuple[FloatArray, FloatArray], approach: FloatArray) -> tuple[list[FloatArray], float]:
    """Return the points of both jaws near their common end, and how far ahead that is (m)."""
    end = min(float((side @ approach).max()) for side in sides)
    tips = [side[side @ approach >= end - _TIP_M] for side in sides]
    return tips, end


def _farthest(points: FloatArray, start: FloatArray | None = None) -> NDArray[np.int64]:
    """Return which quarter of some points is farthest from a place, by default from the frame's origin."""
    away = np.linalg.norm(points if start is None else points - start, axis=1)
    return np.asarray(away.argsort()[-max(len(points) // 4, 1) :])


def _apart_m(one: FloatArray, other: FloatArray) -> float:
    """Return the distance of the two nearest points of two sets (m); 0 where one is empty."""
    if not (len(one) and len(other)):
        return 0.0
    return float(np.linalg.norm(one[:, None] - other[None], axis=2).min())


def _unit(axis: FloatArray) -> FloatArray:
    return np.asarray(axis / np.linalg.norm(axis))


def _straight(axis: FloatArray) -> FloatArray:
    """Return a direction, or the axis of the frame that it is nearly along."""
    unit = _unit(axis)
    best = int(np.abs(unit).argmax())
    return np.eye(3)[best] * np.sign(unit[best]) if abs(unit[best]) >= _STRAIGHT else unit
