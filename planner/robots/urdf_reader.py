"""Read URDFs safely: nothing outside of one folder is read, entities and what is too large are refused.

What makes no tree of links and joints is refused by name, what nobody needs is left out. Parsers of URDFs agree on good
ones and differ on the rest: one leaves a joint out, another stops with a message that names nothing. So each URDF is
brought into a form in which they agree: limits are complete, joints that mimic others name one that is driven, and
links have neither masses nor colours.
"""

import math
from collections.abc import Collection, Iterable, Sequence
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, TreeBuilder
from xml.parsers import expat

from planner.errors import RobotError
from planner.robots.card_parts import UrdfFile
from planner.robots.urdf_shapes import Source, make_shapes, shortened

URDF_BYTES_MAX = 10_000_000
"""Largest URDF (bytes)."""

FAR_M = 100.0
"""A part of a robot that is farther from the one before it is a mistake (m)."""

ELEMENTS_MAX, DEPTH_MAX = 50_000, 50
"""Largest number of elements in a URDF, and their largest nesting depth."""


def locate(urdf: UrdfFile, folder: Path, field: str) -> Source:
    """Return where a URDF is.

    Args:
        urdf: the URDF as a card names it.
        folder: the card's folder.
        field: the card's field, for errors.

    Raises:
        RobotError: there is no such package or file, or it is outside of its folder.
    """
    root = folder
    if urdf.package is not None:
        try:
            top = Path(str(distribution(urdf.package).locate_file("")))
        except (PackageNotFoundError, ValueError):
            raise RobotError(f"{field}.package", f"the package {urdf.package!r} is not installed") from None
        if Path(urdf.path).is_absolute() or ".." in Path(urdf.path).parts:
            raise RobotError(f"{field}.path", f"{urdf.path!r} leads out of its package")
        first, folder = Path(urdf.path).parts[:1], top
        root = top / "cmeel.prefix" / "share" if first == ("cmeel.prefix",) else top.joinpath(*first)
    try:
        path = (folder / urdf.path).resolve()
        is_there = path.is_file()
    except (OSError, ValueError):  # a name that no file can have
        raise RobotError(f"{field}.path", f"there is no file {shortened(urdf.path)!r}") from None
    if not path.is_relative_to(root.resolve()):
        raise RobotError(f"{field}.path", f"{urdf.path!r} leads out of its folder")
    if not is_there:
        raise RobotError(f"{field}.path", f"there is no file {urdf.path!r}")
    return Source(path, root.resolve())


def read_urdf(source: Source, field: str) -> Element:
    """Return a URDF's root element: numbers checked, links and shapes in a common form, the paths of meshes absolute.

    Raises:
        RobotError: it is no URDF, declares entities or a document type, has numbers that are none, joints that make no
            tree, or a mesh that is missing, too large or outside of its folder.
    """
    if source.path.stat().st_size > URDF_BYTES_MAX:
        raise RobotError(field, f"the URDF is larger than {URDF_BYTES_MAX // 1_000_000} MB")
    try:
        robot = parsed(source.path.read_bytes())
    except expat.ExpatError as error:
        raise RobotError(field, f"{source.path.name} is no XML: {error}") from None
    except _RefusedError as error:
        raise RobotError(field, f"{source.path.name} {error}") from None
    if (macro := _unexpanded(robot)) is not None:
        said = (
            f"is xacro that was not expanded ({shortened(macro)}): write a URDF with 'xacro {source.path.name} > FILE'"
        )
        raise RobotError(field, f"{source.path.name} {said}, and name that file")
    if robot.tag != "robot":
        raise RobotError(field, f"{source.path.name} is no URDF: its root is <{robot.tag}>")
    for part in (*robot.iter("link"), *robot.iter("joint")):
        _check_numbers(part, field)
    make_tree(robot, field)
    for link in robot.findall("link"):
        make_shapes(link, source, field)
    return robot


_HARMLESS = ("xacro:arg", "xacro:property")
"""Elements of xacro that change nothing by themselves; some makers' URDFs still have them."""


def _unexpanded(robot: Element) -> str | None:
    """Return the first element or text of a URDF that needs xacro; None if there is none."""
    for element in robot.iter():
        if element.tag in _HARMLESS:
            continue
        if element.tag.startswith("xacro:"):
            return f"<{element.tag}>"
        found = next((text for text in element.attrib.values() if "${" in text or "$(" in text), None)
        if found is not None:
            return found
    return None


class _RefusedError(Exception):
    """A document that is not read."""


def mimics_of(joints: Iterable[Element]) -> dict[str, tuple[str, float, float]]:
    """Return which of a URDF's joints mimic another, by name: the name of that one, the factor and the offset."""
    found = ((joint.get("name", ""), joint.find("mimic")) for joint in joints)
    return {
        name: (mimic.get("joint", ""), float(mimic.get("multiplier", "1")), float(mimic.get("offset", "0")))
        for name, mimic in found
        if mimic is not None
    }


def parsed(data: bytes) -> Element:
    """Return the root element of a URDF; names are taken as they stand, since URDFs use undeclared prefixes."""
    builder, parser = TreeBuilder(), expat.ParserCreate()
    count = depth = 0

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal count, depth
        count, depth = count + 1, depth + 1
        if count > ELEMENTS_MAX or depth > DEPTH_MAX:
            raise _RefusedError(f"has more than {ELEMENTS_MAX} elements, or nests more than {DEPTH_MAX}")
        builder.start(tag, attributes)

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(tag)

    def refuse(*_: object) -> None:
        raise _RefusedError("declares a document type, which could declare entities")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler = builder.data
    parser.StartDoctypeDeclHandler = refuse
    parser.Parse(data, True)
    return builder.close()


def _check_numbers(part: Element, field: str) -> None:
    """Raise `RobotError` if a limit, an origin or an axis is not of numbers, or an origin is too far away."""
    for element in part.iter():
        if element.tag not in ("origin", "axis", "limit", "safety_controller"):
            continue
        for name, text in element.attrib.items():
            numbers = text.split()
            is_wrong = not numbers or not all(_is_finite(number) for number in numbers)
            is_far = element.tag == "origin" and name == "xyz" and not is_wrong
            if is_wrong or (is_far and max(abs(float(number)) for number in numbers) > FAR_M):
                said = f"{element.tag} has {name} {shortened(text)!r}"
                raise RobotError(field, f"{part.tag} {part.get('name')!r}: {said}")


def _is_finite(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


_LIMITED = ("revolute", "prismatic")

MOVING = (*_LIMITED, "continuous")
"""Types of joints that move in one direction."""

_KNOWN = (*MOVING, "fixed", "planar", "floating")

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
    if kind in MOVING:
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
        child, parent = link_at(joint, "child"), link_at(joint, "parent")
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


def link_at(joint: Element, tag: str) -> str:
    """Return the name of a joint's `parent` or `child` link; empty if it has none."""
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
    if joint.get("type") in MOVING and driven is not None and driven.get("type") in MOVING:
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
