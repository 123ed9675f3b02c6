"""A robot's card as JSON, and the cards that are shipped."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yourdfpy

from planner.errors import RobotError
from planner.robots.card import ParallelogramGripper
from planner.robots.card_file import CardFile
from planner.robots.card_parts import CameraFile, ParallelogramDrive
from planner.robots.chain import tool_poses
from planner.robots.described_robot import DescribedRobot, read_robot
from planner.robots.known_robots import shipped_card, shipped_robots
from planner.robots.load_robot import load_robot

SHIPPED = ("baxter", "panda-pair", "pr2", "so101-pair", "tiago-pro", "ur5e-pair", "ur5e-single")


def card_json() -> dict[str, Any]:
    return read_robot("panda-pair").card.to_dict()


def test_the_robots_that_people_have_are_shipped() -> None:
    assert shipped_robots() == SHIPPED


@pytest.mark.parametrize("name", SHIPPED)
def test_a_card_reads_back_from_its_json(name: str) -> None:
    card = read_robot(name).card
    assert CardFile.from_dict(json.loads(json.dumps(card.to_dict()))) == card
    assert card.name == name


@pytest.mark.parametrize("name", SHIPPED)
def test_two_kinematics_libraries_agree_on_every_tool(name: str, tmp_path: Path) -> None:
    robot, rng = read_robot(name), np.random.default_rng(7)
    path = tmp_path / "robot.urdf"
    path.write_text(robot.urdf)
    seen = yourdfpy.URDF.load(str(path), load_meshes=False)
    for arm in robot.arms:
        joints = rng.uniform(np.maximum(arm.chain.low, -6.0), np.minimum(arm.chain.high, 6.0), (5, len(arm.chain.low)))
        points, rotations = tool_poses(arm.chain, joints)
        tool = arm.card.tool
        for row, point, rotation in zip(joints, points, rotations, strict=True):
            values = dict.fromkeys(seen.actuated_joint_names, 0.0) | dict(robot.card.resting)
            seen.update_cfg(values | dict(zip(arm.card.joints, row.tolist(), strict=True)))
            pose = seen.get_transform(tool.link, "pleat_base")
            np.testing.assert_allclose(pose[:3, :3] @ tool.offset_m + pose[:3, 3], point + arm.root, atol=1e-9)
            np.testing.assert_allclose(pose[:3, :3] @ tool.approach, rotation[:, 0], atol=1e-9)
            np.testing.assert_allclose(pose[:3, :3] @ tool.closing, rotation[:, 1], atol=1e-9)


def test_the_card_of_the_pr2_says_what_its_planner_takes() -> None:
    robot, known = read_robot("pr2"), load_robot("pr2").card
    assert robot.lift_limits_m == known.lift_limits_m
    assert robot.card.base.radius_m == known.base_radius_m
    assert dict(robot.card.resting) == dict(known.resting)
    for arm, same in zip(robot.card.arms, known.arms, strict=True):
        assert (arm.name, arm.joints, arm.lifting) == (same.name, same.joint_names, same.lifting)
        assert arm.tool.link == same.tool_frame
        np.testing.assert_allclose(arm.home, same.home)
        assert arm.gripper.drive.joint == same.gripper.joint_name
        assert isinstance(arm.gripper.drive, ParallelogramDrive)
        assert isinstance(same.gripper, ParallelogramGripper)
        assert arm.gripper.drive.link_x_m == pytest.approx(same.gripper.link_x_m)
        assert arm.gripper.drive.link_y_m == pytest.approx(same.gripper.link_y_m)
        assert arm.gripper.opening_max_m == same.gripper.opening_max_m


@pytest.mark.parametrize(
    ("path", "value", "field"),
    [
        (("colour",), "red", "colour"),
        (("pleat_robot",), 2, "pleat_robot"),
        (("name",), "../x", "name"),
        (("arms",), [], "arms"),
        (("arms", 0, "home"), [0.0], "arms[0].home"),
        (("arms", 1, "name"), "left", "arms"),
        (("arms", 0, "gripper", "drive", "kind"), "magnet", "arms[0].gripper.drive"),
        (("arms", 0, "gripper", "opening_max_m"), "wide", "arms[0].gripper.opening_max_m"),
        (("base", "radius_m"), -1.0, "base.radius_m"),
        (("mounts",), [], "mounts"),
        (("scene", "table", "height_m"), 1e300, "scene.table.height_m"),
        (("scene", "stations"), {}, "scene.stations"),
        (("arms", 0, "name"), "", "arms[0].name"),
        (("title",), "x" * 10_000, "title"),
        (("arms", 0, "tool", "offset_m"), [1e9, 0.0, 0.0], "arms[0].tool.offset_m"),
        (
            ("arms", 0, "gripper", "drive"),
            {"kind": "parallelogram", "joint": "grip", "link_x_m": 0.001, "link_y_m": 0.0},
            "arms[0].gripper.drive.link_x_m",
        ),
    ],
)
def test_a_card_that_is_wrong_is_refused_by_its_field(path: tuple[str | int, ...], value: object, field: str) -> None:
    data = card_json()
    inner: Any = data
    for part in path[:-1]:
        inner = inner[part]
    inner[path[-1]] = value
    with pytest.raises(RobotError) as caught:
        CardFile.from_dict(data)
    assert caught.value.field.startswith(field)


def test_a_fixed_base_has_one_station() -> None:
    data = card_json()
    data["scene"]["stations"]["behind"] = {"x_m": 1.0, "y_m": 0.0, "yaw_rad": 0.0}
    with pytest.raises(RobotError, match="one station"):
        CardFile.from_dict(data)


@pytest.mark.parametrize(
    ("change", "field", "said"),
    [
        (lambda d: d["arms"][0]["joints"].__setitem__(6, "left_elbow"), "arms[0].joints[6]", "left_elbow"),
        (lambda d: d["arms"][0]["joints"].__setitem__(1, "left_elbow"), "arms[0].joints[1]", "left_elbow"),
        (lambda d: d["arms"][0].__setitem__("lifting", ["left_elbow"]), "arms[0].lifting[0]", "left_elbow"),
        (lambda d: d["arms"][1]["tool"].__setitem__("link", "right_thumb"), "arms[1].tool.link", "right_thumb"),
        (lambda d: d["arms"][1]["tool"].__setitem__("link", "left_panda_hand_tcp"), "arms[1].tool.link", "carried by"),
        (lambda d: d["arms"][0]["tool"].__setitem__("closing", [0.0, 0.0, 2.0]), "arms[0].tool.closing", "along"),
        (lambda d: d["arms"][0]["home"].__setitem__(3, 0.5), "arms[0].home[3]", "left_panda_joint4"),
        (lambda d: d["arms"][0]["joints"].insert(0, d["arms"][0]["joints"].pop(1)), "arms[0].joints[1]", "follow"),
        (
            lambda d: d["arms"][0]["gripper"]["drive"].__setitem__("joint", "claw"),
            "arms[0].gripper.drive.joint",
            "claw",
        ),
        (lambda d: d.__setitem__("lift", "left_panda_joint1"), "lift", "straight up"),
        (lambda d: d["resting"].__setitem__("neck", 0.0), "resting.neck", "neck"),
        (lambda d: d["resting"].__setitem__("left_panda_joint1", 0.0), "resting.left_panda_joint1", "does not rest"),
        (
            lambda d: d["resting"].__setitem__("left_panda_finger_joint2", 9.0),
            "resting.left_panda_finger_joint2",
            "limits",
        ),
        (lambda d: d["arms"].__setitem__(1, d["arms"][0] | {"name": "right"}), "arms[1].joints[0]", "already"),
        (
            lambda d: d["arms"][0]["gripper"]["drive"].__setitem__("joint", "left_panda_joint7"),
            "arms[0].gripper.drive.joint",
            "arms[0].joints[6] already",
        ),
        (
            lambda d: d["arms"][0]["gripper"]["drive"].__setitem__("opened", 5.0),
            "arms[0].gripper.drive.opened",
            "limits",
        ),
        (
            lambda d: d["arms"][0]["tool"].__setitem__("approach", [1e300, 0.0, 0.0]),
            "arms[0].tool.approach",
            "direction",
        ),
        (lambda d: d["scene"].__setitem__("torso_m", 0.3), "scene.torso_m", "without a lift"),
        (lambda d: d["urdf"].__setitem__("path", "a\0b"), "urdf.path", "no file"),
        (lambda d: d["urdf"].__setitem__("path", "a" * 5000), "urdf.path", "no file"),
        (lambda d: d["mounts"].pop(), "arms[1].joints[0]", "right_panda_joint1"),
        (lambda d: d["urdf"].__setitem__("path", "../../../etc/passwd"), "urdf.path", "leads out"),
        (lambda d: d["urdf"].__setitem__("package", "no-such-package"), "urdf.package", "not installed"),
        (lambda d: d["urdf"].__setitem__("package", None), "urdf.path", "no file"),
    ],
)
def test_what_the_urdf_lacks_is_told_by_name(
    change: Callable[[dict[str, Any]], object], field: str, said: str, tmp_path: Path
) -> None:
    data = card_json()
    change(data)
    with pytest.raises(RobotError) as caught:
        read_robot(str(_written(tmp_path, data)))
    assert caught.value.field.startswith(field)
    assert said in caught.value.message


def test_mounts_without_names_of_their_own_are_refused(tmp_path: Path) -> None:
    data = read_robot("ur5e-single").card.to_dict()
    data["tools"].append(data["tools"][0])
    with pytest.raises(RobotError, match="two links are called 'gripper_base_link'"):
        read_robot(str(_written(tmp_path, data)))


def test_an_unknown_robot_is_told_with_the_known_ones() -> None:
    with pytest.raises(RobotError, match="ur5e-pair"):
        read_robot("r2d2")


@pytest.mark.parametrize("text", ["", "{", "[" * 100_000, "\xff", '{"pleat_robot": NaN}'])
def test_a_file_that_is_no_card_is_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "card.json"
    path.write_text(text)
    with pytest.raises(RobotError):
        read_robot(str(path))


def _written(folder: Path, data: dict[str, Any]) -> Path:
    path = folder / "card.json"
    path.write_text(json.dumps(data))
    return path


def test_a_camera_on_a_link_that_is_not_there_is_refused_by_its_field() -> None:
    with pytest.raises(RobotError) as refused:
        DescribedRobot.of(replace(shipped_card("ur5e-pair"), camera=CameraFile(link="nowhere")), Path())
    assert refused.value.field == "camera.link"
