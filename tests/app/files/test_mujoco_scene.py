"""A plan as a MuJoCo scene: MuJoCo reads it, and has robot and cloth where the plan has them."""

import csv
import shutil
import sys
import textwrap
import types
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

import app.files.mujoco_scene as mujoco_scene_module
from app.files.folder_file import unpack
from app.files.mujoco_scene import mujoco_scene
from app.ui.robot_model import load_robot_model
from planner import make_plan
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import FloatArray
from planner.motion.timeline import Timeline
from tests.builders import garment
from tests.required import required
from tests.small_plan import CARD, small_plan, unsolved

mujoco = pytest.importorskip("mujoco")

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("mjcf") / "scene"
    unpack(mujoco_scene(small_plan()), path)
    return path


@pytest.fixture(scope="module")
def model(folder: Path) -> Any:
    return mujoco.MjModel.from_xml_path(str(folder / "scene.xml"))


@pytest.fixture(scope="module")
def rows(folder: Path) -> FloatArray:
    return np.loadtxt(folder / "motion.csv", delimiter=",", skiprows=1)


def planned_pose(frame: str, t_s: float) -> FloatArray:
    """Return where the plan has a frame of the robot, table frame, shape (4, 4), by other kinematics."""
    robot = pin.buildModelFromUrdf(str(CARD.urdf_path), mimic=True)
    data, q, sample = robot.createData(), pin.neutral(robot), Timeline.of(small_plan()).at(t_s)
    for name, value in sample.joints.items():
        joint = robot.joints[robot.getJointId(name)]
        q[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else (np.cos(value), np.sin(value))
    pin.framesForwardKinematics(robot, data, q)
    base = pin.SE3(
        pin.utils.rotate("z", sample.base.yaw_rad),
        np.array([sample.base.x_m, sample.base.y_m, -small_plan().scene.table.height_m]),
    )
    return np.asarray((base * data.oMf[robot.getFrameId(frame)]).homogeneous)


@pytest.mark.parametrize("share", (0.0, 0.31, 0.74, 1.0))
def test_links_are_where_the_plan_has_them(model: Any, rows: FloatArray, share: float) -> None:
    data, row = mujoco.MjData(model), rows[round(share * (len(rows) - 1))]
    data.qpos[: len(row) - 1] = row[1:]
    mujoco.mj_forward(model, data)
    fingers = ("l_gripper_l_finger_tip_link", "r_gripper_r_finger_link")
    for name in (*fingers, *(arm.tool_frame for arm in CARD.arms)):
        wanted = planned_pose(name, row[0])
        np.testing.assert_allclose(data.body(name).xpos, wanted[:3, 3], atol=1e-6, err_msg=name)
        np.testing.assert_allclose(data.body(name).xmat.reshape(3, 3), wanted[:3, :3], atol=1e-6, err_msg=name)


def test_the_motion_has_a_row_for_each_time_step_in_the_order_of_the_models_joints(
    folder: Path, model: Any, rows: FloatArray
) -> None:
    np.testing.assert_allclose(np.diff(rows[:-1, 0]), model.opt.timestep, atol=1e-6)
    assert (rows[0, 0], rows[-1, 0]) == (0.0, pytest.approx(small_plan().cost_s))
    with (folder / "motion.csv").open() as file:
        names = file.readline().strip().split(",")[1:]
    assert [int(model.joint(name).qposadr[0]) for name in names] == list(range(len(names)))
    assert {"base_x_m", "base_yaw_rad", *CARD.arms[0].joint_names, CARD.arms[1].gripper.joint_name} <= set(names)


def test_keyframes_have_robot_and_cloth_as_each_step_leaves_them(model: Any, rows: FloatArray) -> None:
    plan = small_plan()
    assert [model.key(number).name for number in range(model.nkey)] == [
        "start",
        *(f"after_step_{number}" for number in range(len(plan.steps))),
    ]
    data = mujoco.MjData(model)
    worlds = [(0.0, plan.task.start), *((step.end_s, step.after) for step in plan.steps)]
    for number, (t_s, world) in enumerate(worlds):
        mujoco.mj_resetDataKeyframe(model, data, number)
        mujoco.mj_forward(model, data)
        assert data.time == pytest.approx(t_s)
        tool = CARD.arms[0].tool_frame
        np.testing.assert_allclose(data.body(tool).xpos, planned_pose(tool, t_s)[:3, 3], atol=1e-6)
        corners = np.vstack([layer.ring for layer in plan.sequence.cloth(world.done).layers])
        seen, wanted = data.flexvert_xpos[:, :2], world.placement.to_outer(corners)
        row_m = 0.018  # a crease runs between two rows of the mesh
        np.testing.assert_allclose(seen.min(axis=0), wanted.min(axis=0), atol=row_m)
        np.testing.assert_allclose(seen.max(axis=0), wanted.max(axis=0), atol=row_m)


def grips_of(folder: Path) -> list[dict[str, str]]:
    with (folder / "grips.csv").open() as file:
        return list(csv.DictReader(file))


def test_ties_have_the_cloth_where_the_tool_is_when_it_closes(folder: Path, model: Any, rows: FloatArray) -> None:
    data, grips = mujoco.MjData(model), grips_of(folder)
    assert {grip["equality"].partition("_")[0] for grip in grips} == {arm.name for arm in CARD.arms}
    assert len(grips) == model.neq and not model.eq_active0.any()
    for grip in grips:
        t_s = float(grip["from_s"])
        assert 0.0 < t_s < float(grip["to_s"]) <= required(small_plan().cost_s)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        row = rows[np.abs(rows[:, 0] - t_s).argmin()]
        data.qpos[: len(row) - 1] = row[1:]
        mujoco.mj_forward(model, data)
        tie = model.equality(grip["equality"]).id
        ends = data.site_xpos[[model.eq_obj1id[tie], model.eq_obj2id[tie]]]
        assert np.linalg.norm(ends[0] - ends[1]) < 1e-3


def cloth_of(model: Any, keyframe: int) -> FloatArray:
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, keyframe)
    mujoco.mj_forward(model, data)
    return np.array(data.flexvert_xpos)


class Viewer:
    """Stands in for MuJoCo's window; ends the replay at a time of the simulation."""

    class EndError(Exception):
        pass

    def __init__(self, data: Any, end_s: float) -> None:
        self.data, self.end_s = data, end_s

    def __enter__(self) -> "Viewer":
        return self

    def __exit__(self, *_: object) -> None: ...

    def sync(self) -> None:
        if self.data.time >= self.end_s:
            raise Viewer.EndError


@pytest.mark.slow
def test_the_replay_of_the_documentation_lifts_the_cloth_where_the_plan_holds_it(
    folder: Path, rows: FloatArray, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Replay the first 1.5 s from the moment at which the grippers close: the engine takes seconds for each."""
    closes_s = min(float(grip["from_s"]) for grip in grips_of(folder))
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    heading = (folder / "motion.csv").read_text().partition("\n")[0]
    held = rows[rows[:, 0] >= closes_s]
    np.savetxt(tmp_path / "motion.csv", held, delimiter=",", header=heading, comments="", fmt="%.9g")
    code = (ROOT / "docs/exports.md").read_text().split("This folds the cloth:")[1].split("The robot touches")[0]
    shown: list[Viewer] = []

    def launch_passive(_model: Any, data: Any) -> Viewer:
        shown.append(Viewer(data, data.time + 1.5))
        return shown[0]

    viewer = types.ModuleType("mujoco.viewer")
    monkeypatch.setitem(sys.modules, "mujoco.viewer", viewer)
    monkeypatch.setattr(viewer, "launch_passive", launch_passive, raising=False)
    monkeypatch.setattr(mujoco, "viewer", viewer, raising=False)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(Viewer.EndError):
        exec(textwrap.dedent(code), {})
    data = shown[0].data
    model = data.model
    moved = np.linalg.norm(data.flexvert_xpos - cloth_of(model, 0), axis=1)
    assert np.median(moved) < 0.01, "what no hand holds lies still"
    for tie in range(model.neq):
        at_tool, at_cloth = data.site_xpos[[model.eq_obj1id[tie], model.eq_obj2id[tie]]]
        assert at_cloth[2] > 0.04
        assert np.linalg.norm(at_tool - at_cloth) < 0.02


def test_a_link_may_be_called_as_mujoco_calls_its_root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    root, *others = load_robot_model(CARD.urdf_path, CARD.package_dir)
    monkeypatch.setattr(mujoco_scene_module, "load_robot_model", lambda *_: (replace(root, name="world"), *others))
    unpack(mujoco_scene(small_plan()), tmp_path)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml"))
    assert model.body(model.body("world_link").parentid[0]).name == "robot"


def test_a_plan_without_steps_is_a_scene_at_rest(tmp_path: Path) -> None:
    plan = make_plan(garment([(0.0, 0.0), (0.2, 0.0), (0.2, 0.16), (0.0, 0.16)]))
    unpack(mujoco_scene(plan), tmp_path)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml"))
    assert (model.nkey, model.neq) == (1, 0)
    assert np.loadtxt(tmp_path / "motion.csv", delimiter=",", skiprows=1, ndmin=2).shape[0] == 1


def test_a_plan_that_is_not_solved_has_no_scene() -> None:
    with pytest.raises(UnsolvedPlanError):
        mujoco_scene(unsolved())
