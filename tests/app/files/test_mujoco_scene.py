"""A plan as a MuJoCo scene: MuJoCo reads it, and has robot and cloth where the plan has them."""

from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from app.files.folder_file import unpack
from app.files.mujoco_scene import mujoco_scene
from planner.errors import UnsolvedPlanError
from planner.geometry.pose import FloatArray
from planner.motion.timeline import Timeline
from tests.small_plan import CARD, small_plan, unsolved

mujoco = pytest.importorskip("mujoco")


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


def test_a_plan_that_is_not_solved_has_no_scene() -> None:
    with pytest.raises(UnsolvedPlanError):
        mujoco_scene(unsolved())
