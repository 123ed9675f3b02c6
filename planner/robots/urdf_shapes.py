"""The shapes of a URDF's links: meshes are found within one folder, shapes without volume left out."""

import math
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

from planner.errors import RobotError

MESH_BYTES_MAX = 25_000_000
"""Largest mesh (bytes); a mesh of a million triangles has more in every common format."""

MESH_FORMATS = ("stl", "dae", "obj", "ply", "off", "glb", "gltf")
"""Formats of meshes that are read, by the ends of their names. Archives are not among them: nobody knows how large
they get."""

_SHOWN = 60


@dataclass(frozen=True, slots=True)
class Source:
    """A URDF on the disk.

    Attributes:
        path: the file.
        root: the folder outside of which nothing is read for it.
    """

    path: Path
    root: Path


def make_shapes(link: Element, source: Source, field: str) -> None:
    """Make the paths of a link's meshes absolute, and bring its other shapes into a form that every parser knows.

    Shapes without a geometry are left out, and materials: nothing is painted. A shape for collisions whose mesh is
    missing is left out where the link is seen all the same.

    Raises:
        RobotError: a size is negative or no number, or a mesh is missing, too large or outside of its folder.
    """
    owner = f"link {link.get('name')!r}"
    for kind in ("visual", "collision"):
        for shape in link.findall(kind):
            for material in shape.findall("material"):
                shape.remove(material)
            geometry = shape.find("geometry")
            if geometry is None or not len(geometry) or _is_nothing(geometry[0], owner, field):
                link.remove(shape)
            elif geometry[0].tag == "capsule":
                link.remove(shape)
                link.extend(_of_capsule(shape, geometry[0]))
            elif geometry[0].tag == "mesh" and not _find_mesh(geometry[0], source, owner, field):
                if kind == "visual" or link.find("visual") is None:
                    raise RobotError(field, f"{owner}: there is no mesh {shortened(geometry[0].get('filename', ''))!r}")
                link.remove(shape)


def shortened(text: str) -> str:
    """Return a text, or its beginning if it is long."""
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."


def _is_nothing(geometry: Element, owner: str, field: str) -> bool:
    """Return whether a shape has no volume; raise `RobotError` if its size is not of numbers."""
    keys = {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length"), "capsule": ("radius", "length")}
    if geometry.tag == "mesh":
        return False
    if geometry.tag not in keys:
        raise RobotError(field, f"{owner}: unsupported shape {geometry.tag!r}; use box, sphere, cylinder or mesh")
    try:
        sizes = [float(part) for key in keys[geometry.tag] for part in geometry.get(key, "").split()]
    except ValueError:
        sizes = []
    wanted = 3 if geometry.tag == "box" else len(keys[geometry.tag])
    if len(sizes) != wanted or not all(0.0 <= size < math.inf for size in sizes):
        raise RobotError(field, f"{owner} has a {geometry.tag} whose numbers make no shape")
    return min(sizes) == 0.0 if geometry.tag != "box" else max(sizes) == 0.0


def _of_capsule(shape: Element, capsule: Element) -> Iterator[Element]:
    """Yield the cylinder and the two spheres that a capsule is made of; few parsers know capsules."""
    radius, length = capsule.get("radius", ""), float(capsule.get("length", ""))
    origin = shape.find("origin")
    xyz, rpy = ("0 0 0", "0 0 0") if origin is None else (origin.get("xyz", "0 0 0"), origin.get("rpy", "0 0 0"))
    x, y, z = (float(part) for part in xyz.split())
    up = _z_axis(*(float(part) for part in rpy.split()))
    for along in (0.0, -0.5 * length, 0.5 * length):
        part = deepcopy(shape)
        for old in (*part.findall("origin"), *part.findall("geometry")):
            part.remove(old)
        place = (x + along * up[0], y + along * up[1], z + along * up[2])
        SubElement(part, "origin", xyz=" ".join(map(repr, place)), rpy=rpy)
        geometry = SubElement(part, "geometry")
        if along == 0.0:
            SubElement(geometry, "cylinder", radius=radius, length=repr(length))
        else:
            SubElement(geometry, "sphere", radius=radius)
        yield part


def _z_axis(roll: float, pitch: float, yaw: float) -> tuple[float, float, float]:
    """Return the third column of the rotation by a URDF's roll, pitch and yaw (rad)."""
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(angle), math.cos(angle)) for angle in (roll, pitch, yaw))
    return (cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr)


def _find_mesh(mesh: Element, source: Source, owner: str, field: str) -> bool:
    """Make a mesh's path absolute; return whether there is a file."""
    named = mesh.get("filename", "")
    shown = shortened(named)
    scheme, _, rest = named.rpartition("://")
    if scheme == "package":
        rest = rest.lstrip("/")
    if scheme not in ("", "package") or Path(rest).is_absolute():
        raise RobotError(field, f"{owner}: the mesh {shown!r} is not given by a path within the robot's folder")
    inner = Path(rest)
    tries = (
        [source.path.parent / inner] if not scheme else [source.root / inner, source.root.joinpath(*inner.parts[1:])]
    )
    try:
        resolved = [one.resolve() for one in tries]
        found = next((one for one in resolved if one.is_file()), None)
    except (OSError, ValueError):  # a name that no file can have
        return False
    if not all(one.is_relative_to(source.root) for one in resolved):
        raise RobotError(field, f"{owner}: the mesh {shown!r} leads out of the robot's folder")
    if found is None:
        return False
    if found.suffix[1:].lower() not in MESH_FORMATS:
        raise RobotError(field, f"{owner}: expected a mesh of {', '.join(MESH_FORMATS)}; got {shown!r}")
    if found.stat().st_size > MESH_BYTES_MAX:
        raise RobotError(field, f"{owner}: the mesh {shown!r} is larger than {MESH_BYTES_MAX // 1_000_000} MB")
    mesh.set("filename", str(found))
    return True
