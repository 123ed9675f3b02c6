"""The poses of grips agree with the plan, with forward kinematics, and with each other in all frames and formats."""

import json
from functools import cache
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
import yaml
from scipy.spatial.transform import Rotation

from app.files.grasp_poses import STANDOFF_M, grasp_poses, poses_json, poses_yaml
from planner.errors import UnsolvedPlanError
from tests.small_plan import CARD, small_plan, unsolved

MOMENTS = ("pre_grasp", "grasp", "lift", "place", "retreat")


@cache
def told() -> dict[str, Any]:
    poses: dict[str, Any] = json.loads(poses_json(small_plan()))
    return poses


def grips() -> list[tuple[dict[str, Any], dict[str, Any]]]:
    return [(step, grip) for step in told()["steps"] for grip in step["grips"]]


def placed(pose: dict[str, Any]) -> np.ndarray[Any, Any]:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = Rotation.from_quat(pose["quaternion"]).as_matrix(), pose["position"]
    return matrix


def test_yaml_says_what_json_says() -> None:
    assert yaml.safe_load(poses_yaml(small_plan())) == told()
    assert told()["version"] == 1 and told()["garment"] == "letter-towel" and told()["robot"] == "pr2"


def test_each_fold_is_there_with_the_hands_that_the_plan_gives_it() -> None:
    for step, planned in zip(told()["steps"], small_plan().steps, strict=True):
        assert (step["kind"], step["fold"]) == (planned.kind, planned.fold)
        assert [grip["arm"] for grip in step["grips"]] == [grip.arm for grip in planned.grips]
        for grip, wanted in zip(step["grips"], planned.grips, strict=True):
            assert grip["grasp"]["in_table"]["position"] == pytest.approx(wanted.pick, abs=1e-4)
            assert grip["place"]["in_table"]["position"] == pytest.approx(wanted.place, abs=1e-4)
            assert wanted.apex is not None
            assert grip["lift"]["in_table"]["position"] == pytest.approx(wanted.apex, abs=2e-3)


def test_tools_are_where_forward_kinematics_of_the_urdf_says() -> None:
    path = small_plan().trajectory
    assert path is not None
    model = pin.buildModelFromUrdf(str(CARD.urdf_path))
    data = model.createData()
    for _, grip in grips():
        arm = next(arm for arm in CARD.arms if arm.name == grip["arm"])
        for pose in (grip[moment] for moment in MOMENTS if grip[moment] is not None):
            q = pin.neutral(model)
            for name, value in path.joints_at(pose["t_s"]).items():
                joint = model.joints[model.getJointId(name)]
                q[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else (np.cos(value), np.sin(value))
            pin.framesForwardKinematics(model, data, q)
            found = data.oMf[model.getFrameId(arm.tool_frame)].homogeneous
            np.testing.assert_allclose(placed(pose["in_base"]), found, atol=1e-4)


def test_both_frames_say_the_same() -> None:
    for _, grip in grips():
        for pose in (grip[moment] for moment in MOMENTS if grip[moment] is not None):
            base = pose["base_in_table"]
            base_in_table = np.eye(4)
            base_in_table[:3, :3] = Rotation.from_euler("z", base["yaw_rad"]).as_matrix()
            base_in_table[:3, 3] = (base["x_m"], base["y_m"], -small_plan().scene.table.height_m)
            np.testing.assert_allclose(base_in_table @ placed(pose["in_base"]), placed(pose["in_table"]), atol=1e-7)


def test_hands_come_from_a_distance_open_and_go_with_their_fingers_closed() -> None:
    for step, grip in grips():
        if grip["held_before"]:
            assert grip["pre_grasp"] is None and step["step"] > 0
            continue
        before, grasp = grip["pre_grasp"], grip["grasp"]
        assert before["t_s"] < grasp["t_s"] < grip["lift"]["t_s"] < grip["place"]["t_s"]
        apart = np.subtract(before["in_table"]["position"], grasp["in_table"]["position"])
        assert STANDOFF_M <= np.linalg.norm(apart) <= STANDOFF_M + 0.02
        assert before["opening_m"] > grasp["opening_m"] == grip["lift"]["opening_m"]


def test_cloth_that_is_held_on_is_told_on_both_sides() -> None:
    first, second = told()["steps"]
    assert all(grip["held_after"] and grip["retreat"] is None for grip in first["grips"])
    assert all(grip["held_before"] and grip["pre_grasp"] is None for grip in second["grips"])


def test_without_a_plan_there_are_no_poses() -> None:
    with pytest.raises(UnsolvedPlanError):
        grasp_poses(unsolved())
