"""The animation as USD: the format's own library opens it, and its robot and cloth move as the plan says."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from planner.motion.timeline import Timeline
from tests.small_plan import CARD, small_plan

pytest.importorskip("pxr", reason="the extra `usd` is not installed")

from pxr import Usd, UsdGeom, UsdShade

from app.files.usd_scene import CODES_PER_S, usd_scene

SHARES = (0.0, 0.327, 0.722, 1.0)
"""Of the plan's duration."""


@cache
def timeline() -> Timeline:
    return Timeline.of(small_plan())


@pytest.fixture(scope="module")
def stage(tmp_path_factory: pytest.TempPathFactory) -> Any:
    path: Path = tmp_path_factory.mktemp("usd") / "scene.usd"
    path.write_bytes(usd_scene(small_plan(), lambda: False))
    return Usd.Stage.Open(str(path))


def prim(stage: Any, name: str) -> Any:
    """Return the one prim of this name."""
    (found,) = [one for one in stage.Traverse() if one.GetName() == name]
    return found


def test_the_stage_says_its_units_and_how_long_it_lasts(stage: Any) -> None:
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0 and UsdGeom.GetStageUpAxis(stage) == "Z"
    assert stage.GetTimeCodesPerSecond() == CODES_PER_S
    lasts_s = (stage.GetEndTimeCode() - stage.GetStartTimeCode()) / CODES_PER_S
    assert lasts_s == pytest.approx(timeline().duration_s)
    box = (
        UsdGeom.BBoxCache(0.0, [UsdGeom.Tokens.default_]).ComputeWorldBound(stage.GetDefaultPrim()).ComputeAlignedBox()
    )
    assert box.GetMin()[2] == pytest.approx(-small_plan().scene.table.height_m, abs=0.02), "the floor"


@pytest.mark.parametrize("share", SHARES)
def test_links_are_where_forward_kinematics_says(stage: Any, share: float) -> None:
    t_s = share * timeline().duration_s
    model = pin.buildModelFromUrdf(str(CARD.urdf_path), mimic=True)
    data, q, sample = model.createData(), pin.neutral(model), timeline().at(t_s)
    for name, value in sample.joints.items():
        joint = model.joints[model.getJointId(name)]
        q[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else (np.cos(value), np.sin(value))
    pin.framesForwardKinematics(model, data, q)
    floor_m = -small_plan().scene.table.height_m
    stands = np.array([sample.base.x_m, sample.base.y_m, floor_m])
    world = pin.SE3(pin.utils.rotate("z", sample.base.yaw_rad), stands)
    poses = UsdGeom.XformCache(t_s * CODES_PER_S)
    for name in ("l_gripper_l_finger_tip_link", "head_tilt_link", *(arm.tool_frame for arm in CARD.arms)):
        shown = np.array(poses.GetLocalToWorldTransform(prim(stage, name))).T
        expected = (world * data.oMf[model.getFrameId(name)]).homogeneous
        # Between keyframes 1/60 s apart a joint that speeds up with 8 rad/s2 is 0.3 mrad off its cubic.
        np.testing.assert_allclose(shown, expected, atol=4e-4, err_msg=name)


@pytest.mark.parametrize("share", SHARES)
def test_the_cloth_is_one_mesh_that_lies_as_the_plan_has_it(stage: Any, share: float) -> None:
    mesh = UsdGeom.Mesh(prim(stage, "cloth"))
    t_s = share * timeline().duration_s
    shown = np.array(mesh.GetPointsAttr().Get(t_s * CODES_PER_S))
    planned = timeline().at(t_s).cloth.vertices
    np.testing.assert_allclose(shown.min(axis=0), planned.min(axis=0), atol=0.03)
    np.testing.assert_allclose(shown.max(axis=0), planned.max(axis=0), atol=0.03)
    assert mesh.GetFaceVertexIndicesAttr().GetNumTimeSamples() == 0
    assert max(mesh.GetFaceVertexIndicesAttr().Get()) == len(shown) - 1


def test_all_that_is_shown_has_a_material(stage: Any) -> None:
    shown = [one for one in stage.Traverse() if one.IsA(UsdGeom.Mesh)]
    assert len(shown) > 30
    assert all(UsdShade.MaterialBindingAPI(one).ComputeBoundMaterial()[0] for one in shown)


def test_an_export_that_is_stopped_is_empty() -> None:
    assert usd_scene(small_plan(), lambda: True) == b""
