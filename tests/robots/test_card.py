"""The robot's card agrees with the URDF."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
import yourdfpy

from planner.errors import FoldingError, RequestError
from planner.robots.load_robot import load_robot
from planner.robots.pr2 import description
from tests.required import required
from tests.robots.model import limits, pin_tool_pose, random_joints

CARD = load_robot("pr2").card
HOMES = [np.array(arm.home) for arm in CARD.arms]


@pytest.fixture(scope="module")
def urdf() -> yourdfpy.URDF:
    return yourdfpy.URDF.load(str(CARD.urdf_path), load_meshes=False, build_scene_graph=True)


def test_joint_values_name_every_actuated_joint(urdf: yourdfpy.URDF) -> None:
    values = CARD.joint_values(0.1, HOMES, [0.0, 0.05])
    assert set(values) == set(urdf.actuated_joint_names)
    assert len(values) == 20
    assert all(type(value) is float for value in values.values())


def test_joint_values_want_joints_for_each_arm() -> None:
    with pytest.raises(ValueError, match="shorter"):
        CARD.joint_values(0.1, [np.zeros(7)], [0.0, 0.0])


@pytest.mark.parametrize("opening_m", [0.0, 0.01, 0.05, 0.09])
@pytest.mark.parametrize("arm", [0, 1])
def test_fingertips_are_the_opening_apart(urdf: yourdfpy.URDF, arm: int, opening_m: float) -> None:
    prefix = "lr"[arm]
    closed = _fingertip_distance(urdf, prefix, 0.0)
    assert _fingertip_distance(urdf, prefix, opening_m) - closed == pytest.approx(opening_m, abs=1e-9)


def _fingertip_distance(urdf: yourdfpy.URDF, prefix: str, opening_m: float) -> float:
    urdf.update_cfg(CARD.joint_values(0.0, HOMES, [opening_m, opening_m]))
    tips = [urdf.get_transform(f"{prefix}_gripper_{f}_finger_tip_link")[:3, 3] for f in "lr"]
    return float(np.linalg.norm(tips[0] - tips[1]))


def test_an_opening_out_of_range_is_kept_in_range() -> None:
    gripper = CARD.arms[0].gripper
    assert gripper.angle(1.0) == gripper.angle(gripper.opening_max_m)
    assert gripper.angle(-1.0) == 0.0


def test_two_kinematics_libraries_agree_on_the_tools(urdf: yourdfpy.URDF) -> None:
    rng = np.random.default_rng(3)
    for _ in range(30):
        joints = [random_joints(CARD, arm, rng) for arm in (0, 1)]
        torso_m = rng.uniform(*CARD.lift_limits_m)
        urdf.update_cfg(CARD.joint_values(torso_m, joints, [0.02, 0.04]))
        for arm, card in enumerate(CARD.arms):
            position, rotation = pin_tool_pose(CARD, arm, joints[arm], torso_m)
            seen = urdf.get_transform(card.tool_frame, "base_footprint")
            np.testing.assert_allclose(seen[:3, 3], position, atol=1e-9)
            np.testing.assert_allclose(seen[:3, :3], rotation, atol=1e-9)


@pytest.mark.parametrize("torso_m", [0.0, 0.31])
def test_the_arms_at_home_are_above_the_table_and_clear_of_the_head(urdf: yourdfpy.URDF, torso_m: float) -> None:
    urdf.update_cfg(CARD.joint_values(torso_m, HOMES, [0.0, 0.0]))
    for prefix in "lr":
        assert urdf.get_transform(f"{prefix}_gripper_tool_frame")[2, 3] > 1.0
        for link in ("elbow_flex", "forearm_roll", "wrist_flex"):
            place = urdf.get_transform(f"{prefix}_{link}_link")[:3, 3]
            assert place[2] > 0.79 + 0.07
            assert abs(place[1]) > 0.35


def test_home_is_within_the_soft_limits() -> None:
    safe = {
        joint.get("name"): joint.find("safety_controller")
        for joint in ElementTree.parse(CARD.urdf_path).getroot().findall("joint")
    }
    for arm in CARD.arms:
        for name, value in zip(arm.joint_names, arm.home, strict=True):
            low, high = (required(safe[name]).get(f"soft_{end}_limit") for end in ("lower", "upper"))
            assert low is None or float(low) < value < float(required(high))


def test_the_arms_are_mirror_images() -> None:
    left, right = (limits(CARD, arm) for arm in (0, 1))
    mirror = np.array([-1, 1, -1, 1, -1, 1, -1])
    low, high = (
        np.minimum(right[0] * mirror, right[1] * mirror),
        np.maximum(right[0] * mirror, right[1] * mirror),
    )
    np.testing.assert_allclose(low, left[0])
    np.testing.assert_allclose(high, left[1])
    assert CARD.arms[0].speeds_rad_s == CARD.arms[1].speeds_rad_s
    assert CARD.arms[0].is_continuous == CARD.arms[1].is_continuous == tuple(np.isinf(left[0]))


def test_an_unknown_robot_is_refused() -> None:
    with pytest.raises(RequestError, match="nobody"):
        load_robot("nobody")


def test_a_missing_description_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(description, "_DISTRIBUTION", "no-such-robot-data")
    with pytest.raises(FoldingError, match="no-such-robot-data"):
        description.urdf_path()
