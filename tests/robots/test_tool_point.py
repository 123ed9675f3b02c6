"""Where fingers are about their tool point, by hand for grippers made of boxes, and for the shipped robots."""

import json
from pathlib import Path

import pytest

from planner.robots.described_robot import DescribedRobot, read_described, read_robot
from planner.robots.known_robots import shipped_path, shipped_robots
from planner.robots.tool_point import tool_points
from tests.app.robot_archives import box_card

SHORT_M = 0.019

_JOINT = """<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>
  <origin xyz="{at}"/><axis xyz="{axis}"/><limit lower="{low}" upper="{high}" velocity="2" effort="1"/>{mimic}
  </joint>"""

_BOX = """<link name="{name}"><collision><origin xyz="{at}"/><geometry><box size="{size}"/></geometry></collision>
  </link>"""


def urdf(*jaws: str) -> str:
    """Return the URDF of an arm along x with a gripper of some jaws, all links boxes."""
    names = ("shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll")
    parts = [_BOX.format(name="base", at="0 0 0", size="0.04 0.04 0.04")]
    parent = "base"
    for name in names:
        axis = {"shoulder_pan": "0 0 1", "wrist_roll": "1 0 0"}.get(name, "0 1 0")
        own = {"name": name, "kind": "revolute", "parent": parent, "child": f"{name}_link", "axis": axis}
        parts.append(_JOINT.format(**own, at="0.1 0 0.01", low=-2.5, high=2.5, mimic=""))
        if name != names[-1]:
            parts.append(_BOX.format(name=f"{name}_link", at="0 0 0", size="0.04 0.04 0.04"))
        parent = f"{name}_link"
    parts.append('<link name="tool"/><joint name="tip" type="fixed"><parent link="wrist_roll_link"/>')
    parts.append('<child link="tool"/><origin xyz="0.08 0 0"/></joint>')
    return f'<robot name="boxes">{"".join(parts)}{"".join(jaws)}</robot>'


def slider(name: str, at: str, size: str, axis: str, mimic: str = "") -> str:
    """Return a jaw that slides, its box seen from the last link."""
    own = {"name": name, "kind": "prismatic", "parent": "wrist_roll_link", "child": f"{name}_jaw", "axis": axis}
    return _JOINT.format(**own, at="0 0 0", low=0, high=0.04, mimic=mimic) + _BOX.format(
        name=f"{name}_jaw", at=at, size=size
    )


def palm(*boxes: tuple[str, str]) -> str:
    """Return the last link, made of boxes: where each is, and its size."""
    inside = (
        f'<collision><origin xyz="{at}"/><geometry><box size="{size}"/></geometry></collision>' for at, size in boxes
    )
    return f'<link name="wrist_roll_link">{"".join(inside)}</link>'


TWO = (
    palm(("0.02 0 0", "0.04 0.08 0.04")),
    slider("gripper", "0.06 0.006 0", "0.06 0.01 0.02", "0 1 0"),
    slider("other", "0.06 -0.004 0", "0.06 0.01 0.02", "0 -1 0", '<mimic joint="gripper"/>'),
)
"""Two jaws up to 0.09 m ahead, whose inner faces meet at y = 0.001 m."""

ONE = (
    palm(("0.02 0 0", "0.04 0.08 0.04"), ("0.055 -0.008 0", "0.07 0.01 0.02")),
    slider("gripper", "0.06 0.01 0", "0.06 0.01 0.02", "0 1 0"),
)
"""A fixed jaw up to 0.09 m ahead, its inner face at y = -0.003 m, and one that slides, its face at y = 0.005 m."""


def robot(folder: Path, jaws: tuple[str, ...], offset_m: tuple[float, float, float]) -> DescribedRobot:
    card = box_card(urdf={"path": "boxes.urdf"})
    arm = json.loads(json.dumps(card["arms"]))[0]
    arm["joints"] = ["shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll"]
    arm |= {"home": [0.0] * 5, "speeds": [1.0] * 5, "lifting": [], "accelerations": None}
    arm["tool"] = {"link": "tool", "offset_m": list(offset_m), "approach": [1.0, 0.0, 0.0], "closing": [0.0, 1.0, 0.0]}
    drive = {"kind": "linear", "joint": "gripper", "closed": 0.0, "opened": 0.04}
    arm["gripper"] = {**arm["gripper"], "drive": drive, "opening_max_m": 0.08, "speed": None}
    card |= {"arms": [arm], "mounts": [{"name": ""}], "tools": []}
    (folder / "boxes.urdf").write_text(urdf(*jaws))
    (folder / "robot.json").write_text(json.dumps(card))
    return read_described(folder / "robot.json")


@pytest.mark.parametrize("jaws", [TWO, ONE])
def test_fingers_are_where_their_boxes_are(tmp_path: Path, jaws: tuple[str, ...]) -> None:
    [found] = tool_points(robot(tmp_path, jaws, (0.01, 0.001, 0.0)))
    assert found.beyond_m == pytest.approx(0.0)
    assert found.beside_m == pytest.approx(0.0)
    assert not found.is_off


@pytest.mark.parametrize("jaws", [TWO, ONE])
def test_a_tool_point_19_mm_short_and_9_mm_aside_is_told_with_both_numbers(
    tmp_path: Path, jaws: tuple[str, ...]
) -> None:
    [found] = tool_points(robot(tmp_path, jaws, (0.01 - SHORT_M, 0.010, 0.0)))
    assert found.arm == "left"
    assert found.beyond_m == pytest.approx(SHORT_M)
    assert found.beside_m == pytest.approx(-0.009)
    assert found.is_off


def test_what_nothing_meets_has_no_plane(tmp_path: Path) -> None:
    jaws = (palm(("0.02 0 0", "0.02 0.02 0.02")), ONE[1])
    [found] = tool_points(robot(tmp_path, jaws, (0.01, 0.0, 0.0)))
    assert found.beside_m is None and not found.is_off


@pytest.mark.parametrize("name", shipped_robots())
def test_the_shipped_robots_have_their_tool_points_between_the_fingertips(name: str) -> None:
    points = tool_points(read_robot(name))
    assert [point.arm for point in points] == [arm.name for arm in read_robot(name).card.arms]
    assert all(-0.015 <= point.beyond_m < 0.02 and abs(point.beside_m or 0.0) < 0.005 for point in points)


def test_a_shipped_card_whose_tool_point_is_taken_back_is_off_by_as_much(tmp_path: Path) -> None:
    card = json.loads(shipped_path("panda-pair").read_text())
    for arm in card["arms"]:
        arm["tool"]["offset_m"] = [0.0, 0.0, -SHORT_M]
    (tmp_path / "mine.json").write_text(json.dumps(card))
    shipped, short = tool_points(read_robot("panda-pair")), tool_points(read_described(tmp_path / "mine.json"))
    for one, before in zip(short, shipped, strict=True):
        assert one.arm == before.arm
        assert one.beyond_m == pytest.approx(before.beyond_m + SHORT_M)
        assert one.beside_m == pytest.approx(before.beside_m, abs=1e-9)
    assert all(point.is_off for point in short)
