"""Read URDFs safely: nothing outside of one folder is read, entities and what is too large are refused."""

import math
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from planner.errors import RobotError
from planner.robots.card_parts import UrdfFile

URDF_BYTES_MAX, MESH_BYTES_MAX = 10_000_000, 25_000_000
"""Largest URDF and largest mesh (bytes); a mesh of a million triangles has more in every common format."""

ELEMENTS_MAX, DEPTH_MAX = 50_000, 50
"""Largest number of elements in a URDF, and their largest nesting depth."""


@dataclass(frozen=True, slots=True)
class Source:
    """A URDF on the disk.

    Attributes:
        path: the file.
        root: the folder outside of which nothing is read for it.
    """

    path: Path
    root: Path


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
    path = (folder / urdf.path).resolve()
    if not path.is_relative_to(root.resolve()):
        raise RobotError(f"{field}.path", f"{urdf.path!r} leads out of its folder")
    if not path.is_file():
        raise RobotError(f"{field}.path", f"there is no file {urdf.path!r}")
    return Source(path, root.resolve())


def read_urdf(source: Source, field: str) -> Element:
    """Return a URDF's root element, its numbers checked and the paths of its meshes absolute.

    Raises:
        RobotError: it is no URDF, declares entities or a document type, has numbers that are none, or a mesh that is
            missing, too large or outside of its folder.
    """
    if source.path.stat().st_size > URDF_BYTES_MAX:
        raise RobotError(field, f"the URDF is larger than {URDF_BYTES_MAX // 1_000_000} MB")
    try:
        robot = parsed(source.path.read_bytes())
    except expat.ExpatError as error:
        raise RobotError(field, f"{source.path.name} is no XML: {error}") from None
    except _RefusedError as error:
        raise RobotError(field, f"{source.path.name} {error}") from None
    if robot.tag != "robot":
        raise RobotError(field, f"{source.path.name} is no URDF: its root is <{robot.tag}>")
    for part in (*robot.iter("link"), *robot.iter("joint")):
        _check_numbers(part, field)
    for link in robot.iter("link"):
        _set_meshes(link, source, field)
    return robot


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
    """Refuse limits, origins and axes that are no numbers."""
    for element in part.iter():
        if element.tag not in ("origin", "axis", "limit"):
            continue
        for name, text in element.attrib.items():
            if not all(_is_finite(number) for number in text.split()):
                raise RobotError(field, f"{part.tag} {part.get('name')!r}: {element.tag} has {name} {text!r}")


def _is_finite(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _set_meshes(link: Element, source: Source, field: str) -> None:
    """Make the paths of a link's meshes absolute.

    A shape for collisions whose mesh is missing is left out where the link is seen all the same.
    """
    for kind in ("visual", "collision"):
        for shape in list(link.findall(kind)):
            for mesh in shape.iter("mesh"):
                named = mesh.get("filename", "")
                found = _mesh(named, source, f"link {link.get('name')!r}", field)
                if found is not None:
                    mesh.set("filename", str(found))
                elif kind == "collision" and link.find("visual") is not None:
                    link.remove(shape)
                else:
                    raise RobotError(field, f"link {link.get('name')!r}: there is no mesh {named!r}")


def _mesh(named: str, source: Source, owner: str, field: str) -> Path | None:
    """Return the file of a mesh; None where it is missing."""
    scheme, _, rest = named.rpartition("://")
    if scheme not in ("", "package") or Path(rest).is_absolute():
        raise RobotError(field, f"{owner}: the mesh {named!r} is not given by a path within the robot's folder")
    inner = Path(rest)
    tries = (
        [source.path.parent / inner] if not scheme else [source.root / inner, source.root.joinpath(*inner.parts[1:])]
    )
    resolved = [one.resolve() for one in tries]
    if not all(one.is_relative_to(source.root) for one in resolved):
        raise RobotError(field, f"{owner}: the mesh {named!r} leads out of the robot's folder")
    found = next((one for one in resolved if one.is_file()), None)
    if found is not None and found.stat().st_size > MESH_BYTES_MAX:
        raise RobotError(field, f"{owner}: the mesh {named!r} is larger than {MESH_BYTES_MAX // 1_000_000} MB")
    return found
