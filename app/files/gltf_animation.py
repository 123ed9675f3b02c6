"""Writes a plan's animation as one glTF file: the robot, the table and the cloth, for any viewer of 3-D models.

A link of the robot is a node below its parent's, turned by keyframes of its joint, so many that it may go evenly
between them. Cloth is cut anew wherever it bends, so that its triangles change from moment to
moment and no morph target could follow them: there is a mesh for each of its shapes, all in one place, of which an
animated scale shows one at a time.
"""

import math
from collections.abc import Hashable, Iterable, Mapping

import numpy as np

from app.files.gltf_writer import GltfWriter
from app.jobs.job_pool import ShouldStop
from app.ui.colours import LIGHT, Rgb
from app.ui.robot_model import Link, Visual, load_robot_model
from app.ui.robot_view import link_colour
from app.ui.rotation import yaw
from planner.geometry.pose import FloatArray
from planner.geometry.table_parts import table_parts
from planner.motion.sample import ClothSurface
from planner.motion.timeline import Timeline
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan
from planner.task.trajectory import Trajectory

JOINTS_HZ = 60.0
"""Keyframes of joints and base in a second, besides the plan's own."""

_APART_S = 1e-3
"""The least time between two keyframes (s)."""

CLOTH_HZ = 15.0
"""The most shapes of the cloth in a second."""

_UPRIGHT = (math.sqrt(0.5), -math.sqrt(0.5), 0.0, 0.0)
"""Turns z up, as robots have it, to y up, as glTF has it."""


def animation_glb(plan: Plan, should_stop: ShouldStop) -> bytes:
    """Return a solved plan's animation as a binary glTF file; empty if stopped before the end.

    Raises:
        UnsolvedPlanError: the plan is not solved.
    """
    timeline = Timeline.of(plan)
    writer = GltfWriter(plan.garment.title)
    world = writer.node("table frame", None, wxyz=_UPRIGHT)
    _table(writer, world, plan)
    _robot(writer, world, plan, timeline.trajectory, load_robot(plan.task.robot).card)
    if not _cloth(writer, world, timeline, should_stop):
        return b""
    return writer.file()


def _table(writer: GltfWriter, world: int, plan: Plan) -> None:
    for part in table_parts(plan.scene.table):
        material = writer.material(part.name, LIGHT.table if part.name == "table top" else LIGHT.table_foot)
        corners = np.array(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5], indexing="ij")).reshape(3, -1).T
        box = writer.part(writer.numbers(corners[_BOX], is_bounded=True), writer.indices(_BOX_TRIANGLES), material)
        writer.node(part.name, world, part.center, scale=part.size, mesh=writer.mesh([box]))


_BOX = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]).reshape(-1)
"""The corners of a box's sides, each side with its own, so that its edges are sharp."""

_BOX_TRIANGLES = (4 * np.arange(6)[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)


def _robot(writer: GltfWriter, world: int, plan: Plan, path: Trajectory, card: RobotCard) -> None:
    root = _base(writer, world, path, -plan.scene.table.height_m)
    nodes: dict[str, int] = {"": root}
    meshes: dict[Hashable, int] = {}
    tracks = _tracks(path)
    times = {name: writer.numbers(at, is_bounded=True) for name, (at, _) in tracks.items()}
    still = card.still_values(path.torso_m) | path.resting
    for link in load_robot_model(card.urdf_path, card.package_dir):
        joint = link.joint or ""
        at_rest = link.pose_at(float(tracks[joint][1][0]) if joint in tracks else still.get(joint, 0.0))
        above = nodes[link.node.rpartition("/")[0]]
        node = nodes[link.node] = writer.node(link.name, above, at_rest.position, at_rest.wxyz)
        _visuals(writer, node, link, meshes)
        if joint in tracks:
            _move(writer, node, link, times[joint], tracks[joint][1])


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


def _base(writer: GltfWriter, world: int, path: Trajectory, floor_m: float) -> int:
    """Add the node of the whole robot, which drives from pose to pose."""
    times = _dense(path, (part.start_s + t for part in path.segments for t in part.times_s[:-1]))
    poses = [path.segment_at(t).base_at(t) for t in times]
    at = writer.numbers(np.array(times), is_bounded=True)
    turned = np.array([(z, w) for w, _, _, z in (yaw(pose.yaw_rad) for pose in poses)])
    flip = np.cumprod(np.append(1.0, np.where((turned[1:] * turned[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)))
    quaternions = np.column_stack([np.zeros((len(poses), 2)), turned * flip[:, None]])
    places = np.array([(pose.x_m, pose.y_m, floor_m) for pose in poses])
    root = writer.node("robot", world, places[0].tolist(), yaw(poses[0].yaw_rad))
    writer.animate(root, "translation", at, writer.numbers(places))
    writer.animate(root, "rotation", at, writer.numbers(quaternions))
    return root


def _visuals(writer: GltfWriter, node: int, link: Link, meshes: dict[Hashable, int]) -> None:
    """Add a link's visuals; those that look alike, as both arms' do, share one mesh."""
    colour = link_colour(link.name, LIGHT)
    for number, visual in enumerate(link.visuals):
        key = (colour, visual.vertices.tobytes(), visual.triangles.tobytes())
        if key not in meshes:
            meshes[key] = _mesh(writer, visual, colour)
        writer.node(f"{link.name} visual {number}", node, visual.pose.position, visual.pose.wxyz, mesh=meshes[key])


def _mesh(writer: GltfWriter, visual: Visual, colour: Rgb) -> int:
    positions = writer.numbers(visual.vertices, is_bounded=True)
    material, normals = writer.material("robot", colour), writer.numbers(_normals(visual))
    return writer.mesh([writer.part(positions, writer.indices(visual.triangles), material, normals)])


def _normals(visual: Visual) -> FloatArray:
    """Return the vertices' normals: the mean of their triangles', by area; shape (n, 3)."""
    a, b, c = (visual.vertices[visual.triangles[:, corner]] for corner in range(3))
    facing = np.cross(b - a, c - a)
    normals = np.zeros_like(visual.vertices)
    for corner in range(3):
        np.add.at(normals, visual.triangles[:, corner], facing)
    lengths = np.sqrt((normals**2).sum(axis=1, keepdims=True))
    return np.where(lengths > 0.0, normals / np.where(lengths > 0.0, lengths, 1.0), [0.0, 0.0, 1.0])


def _move(writer: GltfWriter, node: int, link: Link, times: int, positions: FloatArray) -> None:
    poses = [link.pose_at(position) for position in positions.tolist()]
    if link.is_prismatic:
        writer.animate(node, "translation", times, writer.numbers(np.array([pose.position for pose in poses])))
    else:
        xyzw = np.array([(x, y, z, w) for w, x, y, z in (pose.wxyz for pose in poses)])
        writer.animate(node, "rotation", times, writer.numbers(xyzw))


def _cloth(writer: GltfWriter, world: int, timeline: Timeline, should_stop: ShouldStop) -> bool:
    """Add each shape of the cloth for the time in which it is seen; return False if stopped."""
    root = writer.node("cloth", world)
    front, back = writer.material("cloth front", LIGHT.cloth_front), writer.material("cloth back", LIGHT.cloth_back)
    shapes: list[tuple[float, ClothSurface]] = []
    for sample in timeline.samples(CLOTH_HZ):
        if should_stop():
            return False
        if not shapes or shapes[-1][1] is not sample.cloth:
            shapes.append((sample.t_s, sample.cloth))
    ends = [t_s for t_s, _ in shapes[1:]] + [math.inf]
    for number, ((start_s, cloth), end_s) in enumerate(zip(shapes, ends, strict=True)):
        positions = writer.numbers(cloth.vertices, is_bounded=True)
        sides = [(cloth.triangles, front), (cloth.triangles[:, ::-1], back)]
        mesh = writer.mesh([writer.part(positions, writer.indices(side), material) for side, material in sides])
        seen = [(start_s, 1.0)] if start_s == 0.0 else [(0.0, 0.0), (start_s, 1.0)]
        seen += [(end_s, 0.0)] if math.isfinite(end_s) else []
        scale = (seen[0][1],) * 3
        node = writer.node(f"cloth {number}", root, scale=scale, mesh=mesh)
        if len(seen) > 1:
            at = writer.numbers(np.array([t for t, _ in seen]), is_bounded=True)
            writer.animate(node, "scale", at, writer.numbers(np.array([(s, s, s) for _, s in seen])), "STEP")
    return True
