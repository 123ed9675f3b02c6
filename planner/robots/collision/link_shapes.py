"""The shapes of a URDF's links: those for collisions, or those that are shown of links that have none."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from pathlib import Path
from xml.etree.ElementTree import Element

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from planner.errors import RobotError
from planner.geometry.pose import FloatArray
from planner.robots.collision.rounded_hull import hull_corners
from planner.robots.mesh_file import MeshError, read_mesh_file, triangle_count
from planner.robots.urdf_reader import parsed

TRIANGLES_MAX = 1_000_000
"""The most triangles of a robot's meshes together, each counted once for each of its scales (1 GB, 20 s)."""

_ROUND = 24
"""Corners of the polygon round a circle."""


@dataclass(frozen=True, slots=True, eq=False)
class LinkShape:
    """A shape of a link.

    Attributes:
        link: the link.
        joint: the number of the joint that carries it, in pinocchio's model.
        geometry: the shape as it is, for coal.
        placement: its frame in the joint's.
        corners: the corners of a convex hull that contains it, in its joint's frame (m), shape (n, 3).
        triangles: of a mesh the numbers of each triangle's vertices, shape (k, 3); None of other shapes.
    """

    link: str
    joint: int
    geometry: coal.CollisionGeometry
    placement: pin.SE3
    corners: FloatArray
    triangles: NDArray[np.int64] | None


def link_shapes(
    model: pin.Model, urdf: str, is_wanted: Callable[[int], bool] = lambda joint: True
) -> tuple[LinkShape, ...]:
    """Return the shapes of all links, or of those selected.

    Args:
        model: the robot's kinematic tree.
        urdf: the robot's URDF, the paths of its meshes absolute.
        is_wanted: whether the links are wanted that a joint of the model carries.

    Raises:
        RobotError: a mesh cannot be read, the meshes have more than `TRIANGLES_MAX` triangles, or a number is none.
    """
    links, meshes = parsed(urdf.encode()).iterfind("link"), _Meshes()
    return tuple(shape for link in links if is_wanted(_joint(model, link)) for shape in _shapes(model, link, meshes))


def require_shown(urdf: str) -> None:
    """Raise `RobotError` if the meshes that are shown cannot be read, or have too many triangles together."""
    meshes = _Meshes()
    for link in parsed(urdf.encode()).iterfind("link"):
        for element in link.iterfind("visual/geometry/mesh"):
            with _blaming(link.get("name", ""), element):
                meshes.read(*_named(element))


def _joint(model: pin.Model, link: Element) -> int:
    return int(model.frames[model.getFrameId(link.get("name", ""), pin.FrameType.BODY)].parentJoint)


def _shapes(model: pin.Model, link: Element, meshes: "_Meshes") -> Iterator[LinkShape]:
    name = link.get("name", "")
    frame = model.frames[model.getFrameId(name, pin.FrameType.BODY)]
    for element in link.findall("collision") or link.findall("visual"):
        geometry = element.find("geometry")
        if geometry is None or not len(geometry):
            continue
        placement = frame.placement * _origin(element.find("origin"))
        with _blaming(name, geometry[0]):
            shape, hull, triangles = _read(geometry[0], meshes)
            corners: FloatArray = hull @ placement.rotation.T + placement.translation
        yield LinkShape(name, frame.parentJoint, shape, placement, corners, triangles)


@contextmanager
def _blaming(link: str, element: Element) -> Iterator[None]:
    """Name the link in the errors of a shape."""
    try:
        yield
    except RobotError as error:
        raise RobotError("urdf", f"link {link!r}: {error.message}") from None
    except (ValueError, TypeError, RuntimeError):
        raise RobotError("urdf", f"link {link!r} has a {element.tag} whose numbers make no shape") from None


def _origin(element: Element | None) -> pin.SE3:
    if element is None:
        return pin.SE3.Identity()
    place, turn = (_numbers(element.get(key, "0 0 0")) for key in ("xyz", "rpy"))
    return pin.SE3(pin.rpy.rpyToMatrix(turn), place)


def _numbers(text: str) -> FloatArray:
    """Return the numbers of a text; raise `ValueError` where one is none."""
    numbers = np.array([float(x) for x in text.split()])
    if not np.isfinite(numbers).all():
        raise ValueError(text)
    return numbers


_Shape = tuple[coal.CollisionGeometry, FloatArray, NDArray[np.int64] | None]
"""A shape, the corners of a convex hull that contains it, and of a mesh its triangles."""


def _read(element: Element, meshes: "_Meshes") -> _Shape:
    """Return a shape; raise `ValueError` or `TypeError` where numbers are wrong."""
    if element.tag == "mesh":
        return meshes.shape(*_named(element))
    if element.tag == "box":
        size = _numbers(element.get("size", ""))
        return coal.Box(*size), hull_corners(np.array([*product((-0.5, 0.5), repeat=3)]) * size), None
    if element.tag not in ("sphere", "cylinder"):
        raise RobotError("urdf", f"unsupported shape {element.tag!r}; use box, sphere, cylinder or mesh")
    (radius,) = _numbers(element.get("radius", ""))
    if element.tag == "sphere":
        return coal.Sphere(radius), hull_corners(radius * _ball()), None
    (length,) = _numbers(element.get("length", ""))
    ring = radius * _circle()
    ends = [np.column_stack([ring, np.full(_ROUND, side * length / 2)]) for side in (-1, 1)]
    return coal.Cylinder(radius, length), hull_corners(np.vstack(ends)), None


def _circle() -> FloatArray:
    """Return the corners of a polygon round the unit circle."""
    turns = np.arange(_ROUND) * math.tau / _ROUND
    return np.column_stack([np.cos(turns), np.sin(turns)]) / math.cos(math.pi / _ROUND)


def _ball() -> FloatArray:
    """Return points whose hull contains the unit ball."""
    heights = np.linspace(-math.pi / 2, math.pi / 2, _ROUND // 2 + 1)
    rings = [np.column_stack([_circle() * math.cos(at), np.full(_ROUND, math.sin(at))]) for at in heights]
    return np.unique(np.vstack(rings) / math.cos(math.pi / _ROUND), axis=0)


def _named(element: Element) -> tuple[Path, tuple[float, ...]]:
    """Return the file and the scale that an element names."""
    return Path(element.get("filename", "")), tuple(_numbers(element.get("scale", "1 1 1")))


class _Meshes:
    """The meshes of one robot: each is read, and made into a shape, once, however many links have it."""

    def __init__(self) -> None:
        self._read: dict[tuple[Path, tuple[float, ...]], tuple[FloatArray, NDArray[np.int64]]] = {}
        self._made: dict[tuple[Path, tuple[float, ...]], _Shape] = {}
        self._left = TRIANGLES_MAX

    def shape(self, path: Path, scale: tuple[float, ...]) -> _Shape:
        """Return a mesh for coal, its hull's corners and its triangles; raise as `read` does."""
        if (path, scale) not in self._made:
            vertices, triangles = self.read(path, scale)
            mesh = coal.BVHModelOBBRSS()
            mesh.beginModel(len(triangles), len(vertices))
            mesh.addVertices(vertices)
            mesh.addTriangles(triangles)
            mesh.endModel()
            self._made[path, scale] = mesh, hull_corners(vertices), triangles
        return self._made[path, scale]

    def read(self, path: Path, scale: tuple[float, ...]) -> tuple[FloatArray, NDArray[np.int64]]:
        """Return a mesh's vertices and triangles.

        Raises:
            RobotError: it cannot be read, or there are more than `TRIANGLES_MAX` triangles with it.
            ValueError: its scale is none.
        """
        if (path, scale) not in self._read:
            self._read[path, scale] = self._scaled(path, scale)
        return self._read[path, scale]

    def _scaled(self, path: Path, scale: tuple[float, ...]) -> tuple[FloatArray, NDArray[np.int64]]:
        try:
            if (known := triangle_count(path)) is not None:
                self._count(path, known)
            count, corners, triangles = _read_once(path, path.stat().st_mtime_ns)
        except (MeshError, OSError) as error:
            said = error.strerror if isinstance(error, OSError) else error
            raise RobotError("urdf", f"the mesh {path.name!r} cannot be read: {said}") from None
        if known is None:
            self._count(path, count)
        if 0.0 in scale:
            raise ValueError(scale)
        vertices: FloatArray = corners * np.array(scale)
        if not np.isfinite(vertices).all():
            raise RobotError("urdf", f"the mesh {path.name!r} has corners that are no numbers")
        return vertices, triangles

    def _count(self, path: Path, triangles: int) -> None:
        """Count triangles; raise `RobotError` if there are too many."""
        self._left -= triangles
        if self._left < 0:
            so_far = TRIANGLES_MAX - self._left
            others = "" if so_far == triangles else f", {so_far} with the meshes before it"
            raise RobotError(
                "urdf", f"the mesh {path.name!r} has {triangles} triangles{others}; at most {TRIANGLES_MAX} are allowed"
            )


@lru_cache(maxsize=64)
def _read_once(path: Path, _: int) -> tuple[int, FloatArray, NDArray[np.int64]]:
    """Return how many triangles a file has, and the vertices and triangles of its mesh, each triangle once."""
    mesh = read_mesh_file(path)
    vertices, triangles = np.array(mesh.vertices, dtype=float), np.array(mesh.faces, dtype=np.int64)
    return len(triangles), *_without_repeats(vertices, triangles)


def _without_repeats(vertices: FloatArray, triangles: NDArray[np.int64]) -> tuple[FloatArray, NDArray[np.int64]]:
    """Return a mesh with each of its triangles once: trees of equal boxes and hulls of equal points take minutes."""
    _, place = np.unique(vertices, axis=0, return_inverse=True)
    _, first = np.unique(np.sort(place.reshape(-1)[triangles], axis=1), axis=0, return_index=True)
    if len(first) == len(triangles):
        return vertices, triangles
    used, numbers = np.unique(triangles[np.sort(first)], return_inverse=True)
    return vertices[used], numbers.reshape(-1, 3)
