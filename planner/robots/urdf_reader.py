"""Read URDFs safely: nothing outside of one folder is read, entities and what is too large are refused."""

import math
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from planner.errors import RobotError
from planner.robots.card_parts import UrdfFile
from planner.robots.urdf_shapes import Source, make_shapes, shortened
from planner.robots.urdf_tree import make_tree

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
    """Refuse limits, origins and axes that are no numbers, and origins that are too far."""
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
