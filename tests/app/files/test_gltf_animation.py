"""The animation as glTF: foreign readers open it, and its robot moves as forward kinematics says."""

import io
from functools import cache
from itertools import pairwise

import numpy as np
import pinocchio as pin
import pytest
import trimesh
from pygltflib import GLTF2
from scipy.spatial.transform import Rotation, Slerp

from app.files.gltf_animation import animation_glb
from planner.motion.timeline import Timeline
from tests.small_plan import CARD, small_plan

SHARES = (0.0, 0.327, 0.722, 1.0)
"""Of the plan's duration."""
UPRIGHT = Rotation.from_euler("x", -90.0, degrees=True).as_matrix()
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


@cache
def timeline() -> Timeline:
    return Timeline.of(small_plan())


@pytest.fixture(scope="module")
def glb() -> bytes:
    return animation_glb(small_plan(), lambda: False)


class Player:
    """Plays a glTF file as its specification says."""

    def __init__(self, glb: bytes) -> None:
        self.gltf = GLTF2.load_from_bytes(glb)
        assert self.gltf is not None
        self._blob = self.gltf.binary_blob()
        self._above = {child: n for n, node in enumerate(self.gltf.nodes) for child in node.children or ()}
        (animation,) = self.gltf.animations
        self._channels = {
            (channel.target.node, channel.target.path): animation.samplers[channel.sampler]
            for channel in animation.channels
        }
        assert len(self._channels) == len(animation.channels)

    def numbers(self, accessor: int) -> np.ndarray:
        told = self.gltf.accessors[accessor]
        view = self.gltf.bufferViews[told.bufferView]
        width = WIDTHS[told.type]
        rows = np.frombuffer(self._blob, np.float32, told.count * width, view.byteOffset or 0)
        return rows.reshape(told.count, width).astype(float)

    def value(self, node: int, path: str, t_s: float) -> np.ndarray:
        sampler = self._channels.get((node, path))
        if sampler is None:
            return np.array(getattr(self.gltf.nodes[node], path), dtype=float)
        times, values = self.numbers(sampler.input)[:, 0], self.numbers(sampler.output)
        assert np.all(np.diff(times) > 0.0)
        t = float(np.clip(t_s, times[0], times[-1]))
        if sampler.interpolation == "STEP":
            row: np.ndarray = values[np.searchsorted(times, t, side="right") - 1]
            return row
        if path == "rotation":
            turned: np.ndarray = Slerp(times, Rotation.from_quat(values))(t).as_quat()
            return turned
        return np.array([np.interp(t, times, column) for column in values.T])

    def pose(self, name: str, t_s: float) -> np.ndarray:
        """Return a node's pose in the scene."""
        node: int | None = next(n for n, one in enumerate(self.gltf.nodes) if one.name == name)
        whole = np.eye(4)
        while node is not None:
            local = np.eye(4)
            local[:3, :3] = Rotation.from_quat(self.value(node, "rotation", t_s)).as_matrix()
            local[:3, :3] *= self.value(node, "scale", t_s)
            local[:3, 3] = self.value(node, "translation", t_s)
            whole, node = local @ whole, self._above.get(node)
        return whole


@pytest.fixture(scope="module")
def player(glb: bytes) -> Player:
    return Player(glb)


def test_it_is_a_scene_for_other_readers_and_small(glb: bytes) -> None:
    scene = trimesh.load_scene(io.BytesIO(glb), file_type="glb")
    assert len(glb) < 20e6
    robot = [name for name in scene.graph.nodes_geometry if "visual" in name]
    assert len(robot) > 30
    low, high = scene.bounds
    assert low[1] == pytest.approx(-small_plan().scene.table.height_m, abs=0.02), "the floor: y is up"
    assert high[1] < 1.0


@pytest.mark.parametrize("share", SHARES)
def test_links_are_where_forward_kinematics_says(player: Player, share: float) -> None:
    t_s = share * timeline().duration_s
    model = pin.buildModelFromUrdf(str(CARD.urdf_path), mimic=True)
    data, q, sample = model.createData(), pin.neutral(model), timeline().at(t_s)
    for name, value in sample.joints.items():
        joint = model.joints[model.getJointId(name)]
        q[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else (np.cos(value), np.sin(value))
    pin.framesForwardKinematics(model, data, q)
    world = np.eye(4)
    world[:3, :3] = UPRIGHT @ Rotation.from_euler("z", sample.base.yaw_rad).as_matrix()
    world[:3, 3] = UPRIGHT @ (sample.base.x_m, sample.base.y_m, -small_plan().scene.table.height_m)
    fingers = ("l_gripper_l_finger_tip_link", "r_gripper_r_finger_link")
    for name in (*fingers, "head_tilt_link", *(arm.tool_frame for arm in CARD.arms)):
        expected = world @ data.oMf[model.getFrameId(name)].homogeneous
        # Between keyframes 1/60 s apart a joint that speeds up with 8 rad/s2 is 0.3 mrad off its cubic.
        np.testing.assert_allclose(player.pose(name, t_s), expected, atol=4e-4, err_msg=name)


@pytest.mark.parametrize("share", SHARES)
def test_one_shape_of_the_cloth_is_seen_and_it_is_that_of_this_moment(player: Player, share: float) -> None:
    t_s = share * timeline().duration_s
    nodes = [(n, node) for n, node in enumerate(player.gltf.nodes) if (node.name or "").startswith("cloth ")]
    seen = [node for n, node in nodes if np.any(player.value(n, "scale", t_s) != 0.0)]
    (node,) = seen
    front, back = player.gltf.meshes[node.mesh].primitives
    assert front.attributes.POSITION == back.attributes.POSITION
    shown = player.numbers(front.attributes.POSITION)
    vertices = timeline().at(t_s).cloth.vertices
    for corner in np.vstack([vertices.min(axis=0), vertices.max(axis=0)]):
        assert np.abs(np.vstack([shown.min(axis=0), shown.max(axis=0)]) - corner).max(axis=1).min() < 0.03


def test_keyframes_turn_the_short_way(player: Player) -> None:
    (animation,) = player.gltf.animations
    for channel in animation.channels:
        if channel.target.path == "rotation":
            turns = player.numbers(animation.samplers[channel.sampler].output)
            np.testing.assert_allclose(np.linalg.norm(turns, axis=1), 1.0, atol=1e-5)
            assert all(first @ second > 0.0 for first, second in pairwise(turns))


def test_arms_that_look_alike_share_their_meshes(player: Player) -> None:
    nodes = {node.name: node for node in player.gltf.nodes}
    left, right = nodes["l_forearm_link visual 0"], nodes["r_forearm_link visual 0"]
    assert left.mesh is not None and left.mesh == right.mesh


def test_a_film_that_is_stopped_is_empty() -> None:
    assert animation_glb(small_plan(), lambda: True) == b""
