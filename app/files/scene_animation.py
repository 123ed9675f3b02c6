"""The rigid part of a plan's animation, for any kind of 3-D file: the table and the robot, moved by keyframes.

A link of the robot is a node below its parent's, turned by keyframes of its joint, so many that it may go evenly
between them.
"""

import math
from collections.abc import Hashable, Iterable, Mapping
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from app.ui.colours import LIGHT, Rgb
from app.ui.robot_model import Link, Pose3, Visual, load_robot_model
from app.ui.robot_view import link_colour
from app.ui.rotation import yaw
from planner.geometry.pose import FloatArray, Point3, point3
from planner.geometry.table import table_parts
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan
from planner.task.trajectory import Trajectory

JOINTS_HZ = 60.0
"""Keyframes of joints and base in a second, besides the plan's own."""

_APART_S = 1e-3
"""The least time between two keyframes (s)."""

Moved = Literal["translation", "rotation", "scale"]

AT_PARENT, FULL_SIZE = Pose3(), (1.0, 1.0, 1.0)
"""The pose of a node that is where its parent is, and the scale along x, y and z of one that is as large."""


class SceneWriter(Protocol):
    """A 3-D file being built: nodes below one another, with meshes, and keyframes that move them."""

    def material(self, name: str, rgb: Rgb, /) -> int:
        """Add a dull material of a colour (screen values, 0..255) and return it."""

    def mesh(
        self, vertices: FloatArray, triangles: NDArray[np.int64], material: int, normals: FloatArray | None = None, /
    ) -> int:
        """Add a mesh, shapes (n, 3), m, and (m, 3), and return it; without normals it is shaded flat."""

    def node(
        self, name: str, parent: int | None, pose: Pose3 = AT_PARENT, scale: Point3 = FULL_SIZE, mesh: int | None = None
    ) -> int:
        """Add a node below another, or to the scene, and return it."""

    def animate(self, node: int, what: Moved, times_s: FloatArray, values: FloatArray, /) -> None:
        """Let a node's translation (m), rotation (x, y, z, w) or scale go evenly through values, shape (n, 3 or 4)."""


def add_table_and_robot(writer: SceneWriter, world: int | None, plan: Plan, path: Trajectory) -> None:
    """Add the table and the robot that moves along the path of a plan below a node in the table's frame."""
    _table(writer, world, plan)
    _robot(writer, world, plan, path, load_robot(plan.task.robot).card)


def _table(writer: SceneWriter, world: int | None, plan: Plan) -> None:
    for part in table_parts(plan.scene.table):
        material = writer.material(part.name, LIGHT.table if part.name == "table top" else LIGHT.table_foot)
        corners = np.array(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5], indexing="ij")).reshape(3, -1).T
        box = writer.mesh(corners[_BOX], _BOX_TRIANGLES, material)
        writer.node(part.name, world, Pose3(part.center), part.size, box)


_BOX = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]).reshape(-1)
"""The corners of a box's sides, each side with its own, so that its edges are sharp."""

_BOX_TRIANGLES = (4 * np.arange(6)[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)


def _robot(writer: SceneWriter, world: int | None, plan: Plan, path: Trajectory, card: RobotCard) -> None:
    root = _base(writer, world, path, -plan.scene.table.height_m)
    nodes: dict[str, int] = {"": root}
    meshes: dict[Hashable, int] = {}
    tracks = _tracks(path)
    still = card.still_values(path.torso_m) | path.resting
    for link in load_robot_model(card.urdf_path, card.package_dir):
        joint = link.joint or ""
        at_rest = link.pose_at(float(tracks[joint][1][0]) if joint in tracks else still.get(joint, 0.0))
        above = nodes[link.node.rpartition("/")[0]]
        node = nodes[link.node] = writer.node(link.name, above, at_rest)
        _visuals(writer, node, link, meshes)
        if joint in tracks:
            _move(writer, node, link, *tracks[joint])


def _tracks(path: Trajectory) -> Mapping[str, tuple[FloatArray, FloatArray]]:
    """Return times (s) and the positions (rad, m) then of each joint that moves."""
    times = _dense(path, path.arms.times_s)
    rows = np.array([path.arms.at(t) for t in times])
    tracks = {name: (np.array(times), rows[:, n]) for n, name in enumerate(path.arms.names)}
    for track in path.grippers:
        times = _dense(path, track.times_s)
        tracks[track.joint] = np.array(times), np.array([track.position_at(t) for t in times])
    return tracks


def _dense(path: Trajectory, keyframes_s: Iterable[float]) -> list[float]:
    """Return the times of keyframes, and more in between where these are far apart (s)."""
    count = math.ceil(path.duration_s * JOINTS_HZ) + 1
    times = np.union1d(list(keyframes_s), np.linspace(0.0, path.duration_s, count))
    kept = times[np.append(np.diff(times) > _APART_S, True)]  # written as single floats, which must grow
    return [0.0, *kept[kept > _APART_S].tolist()]


def _base(writer: SceneWriter, world: int | None, path: Trajectory, floor_m: float) -> int:
    """Add the node of the whole robot, which drives from pose to pose."""
    times = _dense(path, (part.start_s + t for part in path.segments for t in part.times_s[:-1]))
    poses = [path.segment_at(t).base_at(t) for t in times]
    turned = np.array([(z, w) for w, _, _, z in (yaw(pose.yaw_rad) for pose in poses)])
    flip = np.cumprod(np.append(1.0, np.where((turned[1:] * turned[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)))
    quaternions = np.column_stack([np.zeros((len(poses), 2)), turned * flip[:, None]])
    places = np.array([(pose.x_m, pose.y_m, floor_m) for pose in poses])
    root = writer.node("robot", world, Pose3(point3(places[0]), yaw(poses[0].yaw_rad)))
    writer.animate(root, "translation", np.array(times), places)
    writer.animate(root, "rotation", np.array(times), quaternions)
    return root


def _visuals(writer: SceneWriter, node: int, link: Link, meshes: dict[Hashable, int]) -> None:
    """Add a link's visuals; those that look alike, as both arms' do, share one mesh."""
    colour = link_colour(link.name, LIGHT)
    for number, visual in enumerate(link.visuals):
        key = (colour, visual.vertices.tobytes(), visual.triangles.tobytes())
        if key not in meshes:
            material = writer.material("robot", colour)
            meshes[key] = writer.mesh(visual.vertices, visual.triangles, material, _normals(visual))
        writer.node(f"{link.name} visual {number}", node, visual.pose, mesh=meshes[key])


def _normals(visual: Visual) -> FloatArray:
    """Return the vertices' normals: the mean of their triangles', by area; shape (n, 3)."""
    a, b, c = (visual.vertices[visual.triangles[:, corner]] for corner in range(3))
    facing = np.cross(b - a, c - a)
    normals = np.zeros_like(visual.vertices)
    for corner in range(3):
        np.add.at(normals, visual.triangles[:, corner], facing)
    lengths = np.sqrt((normals**2).sum(axis=1, keepdims=True))
    return np.where(lengths > 0.0, normals / np.where(lengths > 0.0, lengths, 1.0), [0.0, 0.0, 1.0])


def _move(writer: SceneWriter, node: int, link: Link, times_s: FloatArray, positions: FloatArray) -> None:
    poses = [link.pose_at(position) for position in positions.tolist()]
    if link.is_prismatic:
        writer.animate(node, "translation", times_s, np.array([pose.position for pose in poses]))
    else:
        xyzw = np.array([(x, y, z, w) for w, x, y, z in (pose.wxyz for pose in poses)])
        writer.animate(node, "rotation", times_s, xyzw)
