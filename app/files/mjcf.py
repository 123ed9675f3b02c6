"""A robot in MuJoCo's XML as a URDF: bodies become links, hinges and slides joints, geoms shapes.

MuJoCo reads the file and works out defaults, classes and includes; what it has compiled is written down. Floors and
free joints are left out, joint equalities become mimics. Joints count from MuJoCo's reference.
"""

import re
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final
from xml.etree.ElementTree import Element, SubElement, tostring

import numpy as np

from app.distribution import missing
from app.ui.rotation import to_matrix
from planner.errors import RobotError
from planner.geometry.pose import FloatArray

_FREE, _BALL, _SLIDE = 0, 1, 2
_SHAPES: Final = {2: "sphere", 3: "capsule", 4: "ellipsoid", 5: "cylinder", 6: "box", 7: "mesh"}
_LIMIT_M = 1.0
"""The limits of a joint that slides and has none (m)."""


def urdf_of_mjcf(path: Path, folder: Path) -> Path:
    """Write the URDF of a robot in MuJoCo's XML, and its meshes, into a folder; return its path.

    Raises:
        RobotError: MuJoCo is not installed or refuses the file, or the robot has a joint that no URDF has.
        OSError: the system refuses to write.
    """
    if (lacking := missing("mujoco")) is not None:
        raise RobotError("file", f"{path.name} is MuJoCo's XML: convert it to a URDF. {lacking.text}")
    import mujoco

    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise RobotError("file", f"MuJoCo refuses {path.name}: {' '.join(str(error).split())}") from None
    urdf = folder / f"{path.stem}.urdf"
    urdf.write_bytes(tostring(_Conversion(model, folder).urdf()))
    return urdf


class _Conversion:
    """The conversion of one compiled model."""

    def __init__(self, model: Any, folder: Path) -> None:  # noqa: ANN401
        self._model, self._folder = model, folder
        self._robot = Element("robot", name="mjcf")
        # Of each body: its link's name, and where that link's frame is in the body's, turned alike (m).
        self._links: list[tuple[str, FloatArray]] = []

    def urdf(self) -> Element:
        """Return the URDF's root element."""
        for body in range(self._model.nbody):
            self._add_body(body)
        self._add_mimics()
        return self._robot

    def _add_body(self, body: int) -> None:
        model, name = self._model, _name(self._model.body(body).name, f"body_{body}")
        joints = [
            joint
            for joint in range(model.body_jntadr[body], model.body_jntadr[body] + model.body_jntnum[body])
            if model.jnt_type[joint] != _FREE
        ]
        if body > 0:
            parent, shift = self._links[model.body_parentid[body]]
            place, turn = model.body_pos[body], model.body_quat[body]
            if not joints:
                self._add_joint(f"{name}_fixed", "fixed", parent, name, place - shift, turn)
            before = np.zeros(3)
            for number, joint in enumerate(joints):
                child = name if number == len(joints) - 1 else f"{name}_{number}"
                if child != name:
                    SubElement(self._robot, "link", name=child)
                # The first joint turns from the parent's axes to the body's, the others are along these already.
                at = (
                    place + to_matrix(tuple(turn)) @ model.jnt_pos[joint] - shift
                    if number == 0
                    else model.jnt_pos[joint] - before
                )
                self._add_moving(joint, parent, child, at, turn if number == 0 else np.array([1.0, 0.0, 0.0, 0.0]))
                parent, before = child, model.jnt_pos[joint]
        link = SubElement(self._robot, "link", name=name)
        self._links.append((name, model.jnt_pos[joints[-1]] if joints else np.zeros(3)))
        for geom in range(model.body_geomadr[body], model.body_geomadr[body] + model.body_geomnum[body]):
            self._add_shape(link, geom, self._links[-1][1])

    def _add_moving(self, joint: int, parent: str, child: str, place: FloatArray, turn: FloatArray) -> None:
        model, name = self._model, self._joint_name(joint)
        if model.jnt_type[joint] == _BALL:
            raise RobotError("file", f"joint {name!r} is a ball, which no URDF has")
        slides, is_limited = model.jnt_type[joint] == _SLIDE, bool(model.jnt_limited[joint])
        kind = "prismatic" if slides else "revolute" if is_limited else "continuous"
        element = self._add_joint(name, kind, parent, child, place, turn)
        SubElement(element, "axis", xyz=_text(model.jnt_axis[joint]))
        start = float(model.qpos0[model.jnt_qposadr[joint]])
        low, high = model.jnt_range[joint] - start if is_limited else (-_LIMIT_M, _LIMIT_M)
        if kind != "continuous":
            SubElement(element, "limit", lower=repr(float(low)), upper=repr(float(high)))

    def _add_joint(self, name: str, kind: str, parent: str, child: str, place: FloatArray, turn: FloatArray) -> Element:
        joint = SubElement(self._robot, "joint", name=name, type=kind)
        SubElement(joint, "parent", link=parent)
        SubElement(joint, "child", link=child)
        SubElement(joint, "origin", xyz=_text(place), rpy=_text(_rpy(turn)))
        return joint

    def _add_shape(self, link: Element, geom: int, shift: FloatArray) -> None:
        model, kind = self._model, _SHAPES.get(int(self._model.geom_type[geom]))
        if kind is None:  # a floor
            return
        is_seen = not (model.geom_contype[geom] or model.geom_conaffinity[geom])
        shape = SubElement(link, "visual" if is_seen else "collision")
        place, turn = model.geom_pos[geom] - shift, model.geom_quat[geom]
        SubElement(shape, "origin", xyz=_text(place), rpy=_text(_rpy(turn)))
        geometry, size = SubElement(shape, "geometry"), model.geom_size[geom]
        if kind == "mesh":
            SubElement(geometry, "mesh", filename=self._mesh(int(model.geom_dataid[geom])))
        elif kind in ("box", "ellipsoid"):
            SubElement(geometry, "box", size=_text(2.0 * size))
        elif kind == "sphere":
            SubElement(geometry, "sphere", radius=repr(float(size[0])))
        else:
            SubElement(geometry, kind, radius=repr(float(size[0])), length=repr(2.0 * float(size[1])))

    def _mesh(self, mesh: int) -> str:
        """Return the path of a mesh below the folder, written as STL."""
        model, path = self._model, Path("meshes") / f"mesh_{mesh}.stl"
        if not (self._folder / path).exists():
            first, faces = model.mesh_vertadr[mesh], model.mesh_faceadr[mesh]
            corners = model.mesh_vert[first : first + model.mesh_vertnum[mesh]]
            triangles = corners[model.mesh_face[faces : faces + model.mesh_facenum[mesh]]]
            (self._folder / path).parent.mkdir(exist_ok=True)
            (self._folder / path).write_bytes(stl_file(triangles))
        return path.as_posix()

    def _add_mimics(self) -> None:
        joints = {element.get("name"): element for element in self._robot.iterfind("joint")}
        for follower, driver, offset, factor in self._equalities():
            joint = joints.get(self._joint_name(follower))
            if joint is not None and joint.find("mimic") is None:
                mimic = {"joint": self._joint_name(driver), "multiplier": repr(factor), "offset": repr(offset)}
                SubElement(joint, "mimic", mimic)

    def _equalities(self) -> Iterator[tuple[int, int, float, float]]:
        """Yield the joints that follow another: both, the offset and the factor."""
        import mujoco

        model = self._model
        for number in range(model.neq):
            if model.eq_type[number] == mujoco.mjtEq.mjEQ_JOINT and model.eq_obj2id[number] >= 0:
                offset, factor = (float(value) for value in model.eq_data[number][:2])
                yield int(model.eq_obj1id[number]), int(model.eq_obj2id[number]), offset, factor

    def _joint_name(self, joint: int) -> str:
        return _name(self._model.joint(joint).name, f"joint_{joint}")


def _name(given: str, other: str) -> str:
    return re.sub(r"\s+", "_", given.strip()) or other


def _text(values: FloatArray) -> str:
    return " ".join(repr(float(value)) for value in values)


def _rpy(quat: FloatArray) -> FloatArray:
    """Return the roll, pitch and yaw of a quaternion, as a URDF has them (rad)."""
    turn = to_matrix(tuple(quat))
    pitch = np.arcsin(np.clip(-turn[2, 0], -1.0, 1.0))
    if abs(turn[2, 0]) > 1.0 - 1e-12:  # straight up or down: roll and yaw are one
        return np.array([0.0, pitch, np.arctan2(-turn[0, 1], turn[1, 1])])
    return np.array([np.arctan2(turn[2, 1], turn[2, 2]), pitch, np.arctan2(turn[1, 0], turn[0, 0])])


def stl_file(triangles: FloatArray) -> bytes:
    """Return triangles, shape (n, 3, 3), as a binary STL."""
    rows = np.zeros(len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    rows["corners"] = triangles
    return bytes(80) + struct.pack("<I", len(triangles)) + rows.tobytes()
