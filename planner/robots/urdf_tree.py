"""The links and joints of a URDF as a tree: what does not make one is refused by name, what nobody needs is left out.

Parsers of URDFs agree on good ones and differ on the rest: one leaves a joint out, another stops with a message that
names nothing. So each URDF is brought into a form here in which they agree: limits are complete, joints that mimic
others name one that is driven, and links have neither masses nor colours.
"""

import math
from collections.abc import Collection, Sequence
from xml.etree.ElementTree import Element, SubElement

from planner.errors import RobotError

_LIMITED = ("revolute", "prismatic")
_MOVING = (*_LIMITED, "continuous")
_KNOWN = (*_MOVING, "fixed", "planar", "floating")

ENDLESS_RAD = 20.0 * math.pi
"""A joint that turns this far has no limit that matters: URDFs give some endless joints huge numbers."""

_NAMES_SHOWN = 5


def make_tree(robot: Element, field: str) -> None:
    """Check that a URDF's joints connect its links to one tree, and bring them into a common form.

    Args:
        robot: the URDF's root element; changed in place.
        field: the card's field, for errors.

    Raises:
        RobotError: names the link or joint, and what it lacks.
    """
    links, joints = _by_name(robot, "link", field), _by_name(robot, "joint", field)
    for name, joint in joints.items():
        _check_joint(name, joint, links.keys(), field)
    _check_connected(list(links), joints, field)
    for name, joint in joints.items():
        _resolve_mimic(name, joint, joints, field)
    for link in links.values():
        for inertial in link.findall("inertial"):
            link.remove(inertial)


def _by_name(robot: Element, tag: str, field: str) -> dict[str, Element]:
    found: dict[str, Element] = {}
    for element in robot.findall(tag):
        name = element.get("name")
        if not name:
            raise RobotError(field, f"a {tag} has no name")
        if name in found:
            raise RobotError(field, f"two {tag}s are called {name!r}")
        found[name] = element
    return found


def _check_joint(name: str, joint: Element, links: Collection[str], field: str) -> None:
    kind = joint.get("type")
    if kind not in _KNOWN:
        said = "no type" if kind is None else f"the type {kind!r}"
        raise RobotError(field, f"joint {name!r} has {said}, not one of {', '.join(_KNOWN)}")
    for end in ("parent", "child"):
        element = joint.find(end)
        link = None if element is None else element.get("link")
        if link is None:
            raise RobotError(field, f"joint {name!r} has no {end} link")
        if link not in links:
            raise RobotError(field, f"joint {name!r}: there is no link {link!r}")
    for element in (*joint.findall("origin"), *joint.findall("axis")):
        for key in ("xyz", "rpy"):
            if len(element.get(key, "0 0 0").split()) != 3:
                said = f"{element.tag} has {key} {element.get(key)!r}, not three numbers"
                raise RobotError(field, f"joint {name!r}: {said}")
    if kind in _MOVING:
        axis = joint.find("axis")
        if axis is not None and not any(float(part) for part in axis.get("xyz", "1 0 0").split()):
            raise RobotError(field, f"joint {name!r}: its axis has no direction")
        _complete_limit(name, joint, field)


def _complete_limit(name: str, joint: Element, field: str) -> None:
    """Give a joint the numbers that a limit must have; a joint that turns very far becomes one without end."""
    limit = joint.find("limit")
    if limit is None:
        if joint.get("type") in _LIMITED:
            raise RobotError(field, f"joint {name!r} is {joint.get('type')} and has no limit")
        return
    for key in ("effort", "velocity"):
        limit.set(key, str(max(float(limit.get(key, "0")), 0.0)))
    low, high = (float(limit.get(key, "0")) for key in ("lower", "upper"))
    if joint.get("type") == "revolute" and high - low >= ENDLESS_RAD:
        joint.set("type", "continuous")


def _check_connected(links: list[str], joints: dict[str, Element], field: str) -> None:
    """Raise `RobotError` unless the links form a tree."""
    carried: dict[str, str] = {}
    inner: dict[str, str] = {}
    for name, joint in joints.items():
        child, parent = _end(joint, "child"), _end(joint, "parent")
        if child in carried:
            raise RobotError(field, f"link {child!r} hangs from two joints, {carried[child]!r} and {name!r}")
        carried[child], inner[child] = name, parent
    roots = [link for link in links if link not in carried]
    if len(roots) > 1:
        raise RobotError(field, f"the URDF has {len(roots)} root links, not one: {_shown(roots)}")
    below: dict[str, list[str]] = {}
    for child, parent in inner.items():
        below.setdefault(parent, []).append(child)
    reached = list(roots)
    for link in reached:  # grows while it is walked through
        reached.extend(below.get(link, ()))
    if len(reached) < len(links):
        known = set(reached)
        others = [link for link in links if link not in known]
        raise RobotError(field, f"links hang from each other in a ring: {_shown(others)}")
    if not links:
        raise RobotError(field, "the URDF has no link")


def _shown(names: Sequence[str]) -> str:
    return ", ".join(map(repr, names[:_NAMES_SHOWN])) + (", ..." if len(names) > _NAMES_SHOWN else "")


def _end(joint: Element, tag: str) -> str:
    element = joint.find(tag)
    return "" if element is None else element.get("link", "")


def _resolve_mimic(name: str, joint: Element, joints: dict[str, Element], field: str) -> None:
    """Make a mimicking joint name the joint at the end of its chain, with the combined factor and offset.

    A joint that mimics what does not move rests.
    """
    mimic = joint.find("mimic")
    if mimic is None:
        return
    factor, offset, driver, passed = 1.0, 0.0, name, [name]
    while (follows := joints[driver].find("mimic")) is not None:
        more, shift = (_number(follows, key, default, name, field) for key, default in _MIMIC_NUMBERS)
        factor, offset = factor * more, factor * shift + offset
        driver = follows.get("joint", "")
        if driver not in joints:  # an error that some makers' URDFs have: the joint rests
            break
        if driver in passed:
            raise RobotError(field, f"joint {name!r} mimics itself, over {' and '.join(map(repr, passed))}")
        passed.append(driver)
    joint.remove(mimic)
    driven = joints.get(driver)
    if joint.get("type") in _MOVING and driven is not None and driven.get("type") in _MOVING:
        SubElement(joint, "mimic", joint=driver, multiplier=repr(factor), offset=repr(offset))


_MIMIC_NUMBERS = (("multiplier", "1"), ("offset", "0"))


def _number(element: Element, key: str, default: str, name: str, field: str) -> float:
    text = element.get(key, default)
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise RobotError(field, f"joint {name!r}: {element.tag} has {key} {text!r}")
    return number
