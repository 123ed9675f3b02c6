"""Writes a plan as a scene for MuJoCo: table, cloth and robot in one MJCF file, and the motion as a table beside it.

Cloth and table are those of a rehearsal. The robot's links are bodies without contacts, moved by the joints that the
plan moves; all other joints are fixed where they rest. The robot's joints come first in a state of the model, in the
order of the motion's columns. A grip ties the cloth's vertices that fingers pinch to the tool, while it is closed.
"""

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from xml.etree.ElementTree import Element, SubElement, fromstring, indent, tostring

import numpy as np

from app.files.folder_file import zipped
from app.files.mjcf import stl_file
from app.rehearsal.camera.robot_shape import RobotShape
from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.hand_way import pinched_by
from app.rehearsal.physics.model import HELD, model_xml
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.step_motions import posture_at, step_motions
from app.rehearsal.world import GripMotion
from app.ui.colours import LIGHT, Rgb
from app.ui.robot_model import Pose3, Visual, load_robot_model
from app.ui.robot_view import link_colour
from app.ui.rotation import yaw
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import FloatArray
from planner.geometry.table import TableTop, table_parts
from planner.geometry.tolerance import TIME_S
from planner.geometry.woven_mesh import woven_mesh
from planner.motion.motion_values import BASE_NAMES, MotionLimits, positions_at
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan
from planner.task.trajectory import Trajectory
from planner.task.world_state import WorldState

_SEEN = {"contype": "0", "conaffinity": "0", "group": "1"}
"""What a shape has that is seen and touches nothing."""

_INERTIA = {"pos": "0 0 0", "mass": "1", "diaginertia": "0.01 0.01 0.01"}
"""Each link's: the motion is given, and links are only so heavy that cloth does not move them."""

_TAKEN = re.compile(r"world|robot|v\d+")
"""The names of MuJoCo's root, the robot's, and the cloth's vertices: links with one of them get another."""

_BASE_AXES = (("slide", "1 0 0"), ("slide", "0 1 0"), ("hinge", "0 0 1"))


def mujoco_scene(plan: Plan) -> bytes:
    """Return a solved plan as a zipped folder with `scene.xml`, its meshes, `motion.csv` and `grips.csv`.

    Raises:
        UnsolvedPlanError: the plan is not solved.
    """
    path, garment, table = plan.trajectory, plan.garment, plan.scene.table
    if path is None:
        raise UnsolvedPlanError(plan.status)
    card = load_robot(plan.task.robot).card
    fabric = Fabric(garment.areal_density_kg_m2, friction=plan.scene.friction, thickness_m=garment.thickness_m)
    resolution = Resolution.of(garment.pattern.area)
    pattern, triangles = woven_mesh(garment.pattern, resolution.edge_m)
    lies = plan.task.start.placement
    rest = np.column_stack([lies.to_outer(pattern), np.full(len(pattern), fabric.layer_m / 2.0)])
    scene = fromstring(model_xml(rest, pattern, triangles, fabric, resolution, table, sockets=0))
    scene.set("model", garment.name)
    _found(scene, "compiler").attrib.update(angle="radian", meshdir="meshes")
    _add_surroundings(_found(scene, "worldbody"), plan)
    robot = _Robot(card, plan, path)
    _found(scene, "worldbody").insert(0, robot.root)
    scene.append(robot.assets)

    def planned(world: WorldState) -> FloatArray:
        return planned_positions(plan.sequence, pattern, world.done, world.placement, table, fabric.layer_m)

    ties = ["equality,from_s,to_s"]
    for grip, world, from_s, to_s in _grips(plan, path):
        cloth = planned(world)
        held = pinched_by(grip, cloth, triangles, TableTop.of(table), plan.scene.edge_clear_m)
        for name in robot.tie(_found(scene, "equality"), grip.arm, from_s, {one: cloth[one] for one in held}):
            ties.append(f"{name},{from_s:.9g},{to_s:.9g}")
    keys = SubElement(scene, "keyframe")
    worlds = {"start": (0.0, plan.task.start)}
    worlds |= {f"after_step_{number}": (step.end_s, step.after) for number, step in enumerate(plan.steps)}
    for name, (t_s, world) in worlds.items():
        state = np.concatenate([robot.positions(np.array([t_s]))[0], (planned(world) - rest).ravel()])
        SubElement(keys, "key", name=name, time=f"{t_s:.9g}", qpos=_text(state.tolist()))
    indent(scene, " ")
    count = math.ceil((path.duration_s - TIME_S) / resolution.step_s) + 1
    times_s = np.minimum(np.arange(count) * resolution.step_s, path.duration_s)
    rows = np.column_stack([times_s, robot.positions(times_s)])
    tables = {
        "motion.csv": _csv(("t_s", *robot.names), rows),
        "grips.csv": "".join(f"{tie}\n" for tie in ties).encode(),
    }
    return zipped({"scene.xml": tostring(scene), **tables, **robot.meshes})


def _grips(plan: Plan, path: Trajectory) -> Iterator[tuple[GripMotion, WorldState, float, float]]:
    """Yield each grip as it begins, with the world before it and the times between which it is closed (s)."""
    closed: dict[str, tuple[GripMotion, WorldState, float]] = {}
    for step, motion in zip(plan.steps, step_motions(plan), strict=True):
        for grip in motion.grips:
            closed.setdefault(grip.arm, (grip, step.before, step.start_s + grip.times_s[0]))
            if grip.opens:
                yield *closed.pop(grip.arm), step.start_s + grip.times_s[-1]
    for begun in closed.values():
        yield *begun, path.duration_s


def _found(scene: Element, name: str) -> Element:
    return next(scene.iter(name))


def _add_surroundings(world: Element, plan: Plan) -> None:
    """Add light, the floor and the table's legs."""
    floor_m = -plan.scene.table.height_m
    SubElement(world, "light", pos="0 0 3", dir="0 0 -1", directional="true")
    SubElement(world, "geom", _SEEN, name="floor", type="plane", size="4 4 0.1", pos=_text([0.0, 0.0, floor_m]))
    for part in table_parts(plan.scene.table)[1:]:
        size = _text([extent / 2.0 for extent in part.size])
        SubElement(
            world, "geom", _SEEN, name=part.name, type="box", size=size, pos=_text(part.center), rgba=_rgba(LIGHT.table)
        )


class _Robot:
    """A robot as bodies below one another.

    Attributes:
        root: the body of the whole robot.
        assets: its meshes as the scene names them.
        meshes: their files by path.
        names: its joints in the order of the model.
    """

    def __init__(self, card: RobotCard, plan: Plan, path: Trajectory) -> None:
        """Build the bodies of a robot that moves along the path of a plan."""
        self._path, self._sources = path, MotionLimits.of(card, plan.scene).names
        self.assets, self.meshes = Element("asset"), dict[str, bytes]()
        self._joints: dict[str, tuple[str, float, float]] = {}
        self._mesh_names: dict[bytes, str] = {}
        floor_m = -plan.scene.table.height_m
        start = path.segment_at(0.0).base_at(0.0)
        if card.is_fixed:
            self.root = _body("robot", Pose3((start.x_m, start.y_m, floor_m), yaw(start.yaw_rad)))
        else:
            self.root = _body("robot", Pose3((0.0, 0.0, floor_m)))
            for name, (kind, axis) in zip(BASE_NAMES, _BASE_AXES, strict=True):
                SubElement(self.root, "joint", name=name, type=kind, axis=axis)
        SubElement(self.root, "inertial", _INERTIA)
        still = card.still_values(path.torso_m) | path.resting
        bodies = {"": self.root}
        links = load_robot_model(card.urdf_path, card.package_dir)
        for link in links:
            above = bodies[link.node.rpartition("/")[0]]
            if link.joint in self._sources and link.own_joint is not None:
                body = _link_body(link.name, link.origin)
                kind = "slide" if link.is_prismatic else "hinge"
                SubElement(body, "joint", name=link.own_joint, type=kind, axis=_text(link.axis.tolist()))
                self._joints[link.own_joint] = link.joint, link.factor, link.offset
            else:
                body = _link_body(link.name, link.pose_at(still.get(link.joint or "", 0.0)))
            SubElement(body, "inertial", _INERTIA)
            above.append(body)
            bodies[link.node] = body
            for visual in link.visuals:
                self._add_visual(body, visual, link_colour(link.name, LIGHT))

        self._shape = RobotShape(links, floor_m, {})
        self._tools = {arm.name: arm.tool_frame for arm in card.arms}
        self._bodies = {link.name: bodies[link.node] for link in links}
        self.names = tuple(joint.attrib["name"] for joint in self.root.iter("joint"))

    def positions(self, times_s: FloatArray) -> FloatArray:
        """Return the joints at times of the plan, shape (n, joints): rad, m."""
        values = dict(zip(self._sources, positions_at(self._path, times_s).T, strict=True))
        followed = (self._joints.get(name, (name, 1.0, 0.0)) for name in self.names)
        return np.column_stack([factor * values[source] + offset for source, factor, offset in followed])

    def tie(self, ties: Element, arm: str, t_s: float, vertices: Mapping[int, FloatArray]) -> Iterator[str]:
        """Tie vertices of the cloth to where the tool of an arm has them at a time (s); yield the ties' names.

        Args:
            ties: where the ties are added, none of them active.
            arm: the arm's name.
            t_s: when the gripper closes (s).
            vertices: where each vertex is then, table frame, shape (3,), m.
        """
        tool = self._tools[arm]
        pose = self._shape.frames(posture_at(self._path, t_s))[tool]
        for vertex, place in vertices.items():
            name = f"{arm}_{len(ties)}"
            SubElement(self._bodies[tool], "site", name=name, pos=_text((place - pose[:3, 3]) @ pose[:3, :3]))
            ties.append(fromstring(f'<connect name="{name}" site1="{name}" site2="p{vertex}" active="false" {HELD}/>'))
            yield name

    def _add_visual(self, body: Element, visual: Visual, colour: Rgb) -> None:
        content = stl_file(visual.vertices[visual.triangles])
        name = self._mesh_names.setdefault(content, f"mesh_{len(self._mesh_names)}")
        if (file := f"meshes/{name}.stl") not in self.meshes:
            self.meshes[file] = content
            SubElement(self.assets, "mesh", name=name, file=f"{name}.stl", inertia="shell")
        SubElement(body, "geom", _SEEN | _placed(visual.pose), type="mesh", mesh=name, rgba=_rgba(colour))


def _body(name: str, pose: Pose3) -> Element:
    return Element("body", {"name": name} | _placed(pose))


def _link_body(name: str, pose: Pose3) -> Element:
    return _body(f"{name}_link" if _TAKEN.fullmatch(name) else name, pose)


def _placed(pose: Pose3) -> dict[str, str]:
    return {"pos": _text(pose.position), "quat": _text(pose.wxyz)}


def _text(numbers: Iterable[float]) -> str:
    return " ".join(f"{number:.9g}" for number in numbers)


def _rgba(colour: Rgb) -> str:
    return _text([*(part / 255.0 for part in colour), 1.0])


def _csv(names: Iterable[str], rows: FloatArray) -> bytes:
    lines = [",".join(names), *(",".join(f"{number:.9g}" for number in row) for row in rows.tolist())]
    return "".join(f"{line}\n" for line in lines).encode()
