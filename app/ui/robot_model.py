"""A robot's links and meshes, read once from its URDF and shared by all 3D views.

Links form a tree, as does viser's scene: a link's node hangs below its parent's, so a moving joint changes one node and
the browser works out the poses beyond it. There is no kinematics here.
"""

import functools
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
import trimesh
import yourdfpy
from numpy.typing import NDArray

from app.ui.robot_mesh import creased, read_mesh
from app.ui.rotation import IDENTITY, Quaternion, from_matrix, product, rotated, to_matrix, turn
from planner.geometry.pose import FloatArray, Point3
from planner.robots.card import RobotCard

_SMALLEST_SHOWN_M = 0.03


@dataclass(frozen=True, slots=True)
class Pose3:
    """A position and a rotation in the parent's frame."""

    position: Point3 = (0.0, 0.0, 0.0)
    wxyz: Quaternion = IDENTITY

    @property
    def matrix(self) -> FloatArray:
        """The transform to the parent's frame, shape (4, 4)."""
        found = np.eye(4)
        found[:3, :3], found[:3, 3] = to_matrix(self.wxyz), self.position
        return found


@dataclass(frozen=True, slots=True)
class Visual:
    """A mesh that belongs to a link.

    Attributes:
        pose: in the link's frame.
        vertices: shape (n, 3), m; duplicated along sharp edges so that they are shaded as edges.
        triangles: shape (m, 3), indices into `vertices`.
    """

    pose: Pose3
    vertices: FloatArray
    triangles: NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Link:
    """A link, and the joint that connects it to its parent.

    Attributes:
        name: the link's name in the URDF.
        node: its scene node's path below the robot's own: the names of all links down to it.
        origin: its pose in the parent's frame while the joint is at zero.
        joint: the actuated joint that moves it, or None when it is fixed.
        own_joint: the name of the joint that connects it; another than `joint` if it mimics that; None for the root.
        factor: the factor on joint positions (a finger that mimics another has one).
        offset: what is added to them then (rad; m for a joint that slides).
        axis: the joint's axis in the link's own frame, shape (3,).
        is_prismatic: whether the joint slides rather than turns.
        visuals: its meshes.
    """

    name: str
    node: str
    origin: Pose3
    joint: str | None
    own_joint: str | None
    factor: float
    offset: float
    axis: FloatArray
    is_prismatic: bool
    visuals: tuple[Visual, ...]

    def pose_at(self, position: float) -> Pose3:
        """Return its pose in the parent's frame at a position of its joint (rad; m for one that slides)."""
        value = self.factor * position + self.offset
        if self.is_prismatic:
            along, aside, up = (float(part) * value for part in self.axis)
            shift = rotated(self.origin.wxyz, (along, aside, up))
            x, y, z = (start + part for start, part in zip(self.origin.position, shift, strict=True))
            return Pose3((x, y, z), self.origin.wxyz)
        return Pose3(self.origin.position, product(self.origin.wxyz, turn(self.axis, value)))


def load_robot_model(urdf_path: Path, package_dir: Path) -> tuple[Link, ...]:
    """Return all links of a robot, parents before children, the root first; the same ones until its URDF changes.

    Args:
        urdf_path: the URDF.
        package_dir: the folder that ``package://`` in its mesh paths stands for.
    """
    return _model(urdf_path, package_dir, urdf_path.stat().st_mtime_ns)


@functools.lru_cache(maxsize=4)
def _model(urdf_path: Path, package_dir: Path, _: int) -> tuple[Link, ...]:

    def mesh_path(fname: str) -> str:
        return str(package_dir / fname.removeprefix("package://"))

    urdf = yourdfpy.URDF.load(str(urdf_path), filename_handler=mesh_path, load_meshes=False)
    joint_of_link = {joint.child: joint for joint in urdf.robot.joints}
    has_looks = any(link.visuals for link in urdf.link_map.values())
    nodes: dict[str, str] = {}
    links = []
    for name in _parents_first(urdf):
        joint = joint_of_link.get(name)
        nodes[name] = f"{nodes[joint.parent]}/{name}" if joint else f"/{name}"
        link = urdf.link_map[name]
        shown = [_visual(one, mesh_path) for one in (link.visuals if has_looks else link.collisions)]
        links.append(_link(name, nodes[name], joint, tuple(v for v in shown if v is not None)))
    return tuple(links)


def _parents_first(urdf: yourdfpy.URDF) -> list[str]:
    children: dict[str, list[str]] = {}
    for joint in urdf.robot.joints:
        children.setdefault(joint.parent, []).append(joint.child)
    ordered = [urdf.base_link]
    for name in ordered:  # grows while it is walked through
        ordered.extend(children.get(name, ()))
    return ordered


def _link(name: str, node: str, joint: yourdfpy.Joint | None, visuals: tuple[Visual, ...]) -> Link:
    if joint is None:
        return Link(name, node, Pose3(), None, None, 1.0, 0.0, np.zeros(3), False, visuals)
    is_fixed = joint.type == "fixed"
    moved_by = joint.mimic.joint if joint.mimic else joint.name
    return Link(
        name=name,
        node=node,
        origin=_pose(joint.origin),
        joint=None if is_fixed else moved_by,
        own_joint=joint.name,
        factor=_or(joint.mimic and joint.mimic.multiplier, 1.0),
        offset=_or(joint.mimic and joint.mimic.offset, 0.0),
        axis=np.array(joint.axis if joint.axis is not None else (1.0, 0.0, 0.0), dtype=float),
        is_prismatic=joint.type == "prismatic",
        visuals=visuals,
    )


def _or(number: float | None, default: float) -> float:
    return default if number is None else float(number)


def _pose(matrix: FloatArray | None) -> Pose3:
    if matrix is None:
        return Pose3()
    x, y, z = (float(part) for part in matrix[:3, 3])
    return Pose3((x, y, z), from_matrix(matrix))


def _visual(visual: yourdfpy.Visual | yourdfpy.Collision, mesh_path: Callable[[str], str]) -> Visual | None:
    """Return a visual with its mesh; None for the tiny ones that only mark a frame."""
    mesh = _mesh(visual.geometry, mesh_path)
    if mesh is None or max(mesh.extents) < _SMALLEST_SHOWN_M:
        return None
    return Visual(_pose(visual.origin), *creased(mesh))


def _mesh(geometry: yourdfpy.Geometry, mesh_path: Callable[[str], str]) -> trimesh.Trimesh | None:
    made: trimesh.Trimesh | None = None
    if geometry.box is not None:
        made = trimesh.creation.box(extents=geometry.box.size)
    elif geometry.cylinder is not None:
        made = trimesh.creation.cylinder(geometry.cylinder.radius, geometry.cylinder.length)
    elif geometry.sphere is not None:
        made = trimesh.creation.icosphere(radius=geometry.sphere.radius)
    elif geometry.mesh is not None:
        x, y, z = np.broadcast_to(1.0 if geometry.mesh.scale is None else geometry.mesh.scale, 3).tolist()
        made = read_mesh(mesh_path(geometry.mesh.filename), (x, y, z))
    return made


@lru_cache(maxsize=8)
def waiting_box(card: RobotCard, torso_m: float) -> FloatArray:
    """Return the lowest and the highest corner of the box around a robot at home, shape (2, 3), base frame, m.

    Args:
        card: the robot.
        torso_m: how far its lift is raised (m).
    """
    joints = card.joint_values(torso_m, [np.array(arm.home) for arm in card.arms], [0.0] * len(card.arms))
    places: dict[str, Pose3] = {"": Pose3()}
    corners = []
    for link in load_robot_model(card.urdf_path, card.package_dir):
        here = link.pose_at(joints.get(link.joint or "", 0.0))
        place = places[link.node] = _placed(places[link.node.rpartition("/")[0]], here)
        for visual in link.visuals:
            shape = _placed(place, visual.pose)
            points = visual.vertices @ to_matrix(shape.wxyz).T + np.array(shape.position)
            corners += [points.min(axis=0), points.max(axis=0)]
    return np.array([np.min(corners, axis=0), np.max(corners, axis=0)])


def _placed(outer: Pose3, inner: Pose3) -> Pose3:
    x, y, z = (a + b for a, b in zip(outer.position, rotated(outer.wxyz, inner.position), strict=True))
    return Pose3((x, y, z), product(outer.wxyz, inner.wxyz))
