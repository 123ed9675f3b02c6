"""The grippers of a URDF by its joints: which move fingers, which carry the hand, which drive it.

A joint moves a finger if its name or its link's says so, or if others mimic it or it mimics another, and nothing else
hangs from it; fingers that slide opposite each other need no such name. Whatever leads from the root to a hand and to
no other hand is its arm.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import Element

from planner.robots.urdf_reader import mimics_of

_FINGER = re.compile(r"finger|thumb|jaw|claw|knuckle|gripper|(?<![a-z])(index|middle|ring|little|pinky)(?![a-z])")
_CERTAIN = re.compile(r"finger|thumb|jaw|claw|knuckle")
_MOVING = ("revolute", "continuous", "prismatic")

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
        self._links = {name: _end(joint, "child") for name, joint in joints.items()}
        by_child = {link: name for name, link in self._links.items()}
        self._kinds: Mapping[str, str] = {name: joint.get("type", "") for name, joint in joints.items()}
        self.carrier: dict[str, str | None] = {}
        for name, joint in joints.items():
            if self._kinds[name] not in _MOVING:
                continue
            inner = by_child.get(_end(joint, "parent"))
            while inner is not None and self._kinds[inner] not in _MOVING:
                inner = by_child.get(_end(joints[inner], "parent"))
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


def _end(joint: Element, tag: str) -> str:
    element = joint.find(tag)
    return "" if element is None else element.get("link", "")
