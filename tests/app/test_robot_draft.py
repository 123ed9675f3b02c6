"""``pleat robot draft``: a card drafted of a URDF that nobody has described."""

import io
import json
import re
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from app.files.mjcf import urdf_of_mjcf
from app.ui.robot_model import load_robot_model
from planner.errors import RobotError
from planner.robots.card_robot import CardRobot
from planner.robots.collision import described_parts
from planner.robots.collision.part_source import Part, make_parts
from planner.robots.described_robot import DescribedRobot, read_described
from planner.robots.tool_point import tool_points
from planner.robots.urdf_reader import read_urdf
from planner.robots.urdf_shapes import Source
from tests.app.test_cli import pleat
from tests.robots.drafted import TOOL_AHEAD_M, pair_urdf, single_urdf
from tests.robots.drafted import arm as arm_urdf

CUBE = b"solid a\n" + b"".join(
    f"facet normal 0 0 1\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\nendloop\nendfacet\n".encode()
    for a, b, c in (("0 0 0", ".05 0 0", "0 .05 0"), ("0 0 0", ".05 0 0", "0 0 .05"), (".05 0 0", "0 .05 0", "0 0 .05"))
)


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Return the folder of a drafted pair, and what was said of it."""
    folder = tmp_path_factory.mktemp("draft")
    (folder / "pair.urdf").write_text(pair_urdf())
    result = pleat("robot", "draft", str(folder / "pair.urdf"), "--out", str(folder / "Two arms"))
    assert result.exit_code == 0, result.output
    return folder / "Two arms", result.stdout


def test_arms_are_the_chains_that_end_in_grippers_from_left_to_right(pair: tuple[Path, str]) -> None:
    card = read_described(pair[0] / "robot.json").card
    assert (card.name, card.title, card.base.kind) == ("two-arms", "Two arms", "fixed")
    assert (card.lift, card.scene.torso_m) == ("rise", 0.01)
    assert [arm.name for arm in card.arms] == ["left", "right"]
    for arm, before in zip(card.arms, "lr", strict=True):
        assert arm.joints == tuple(f"{before}_{name}" for name in ("pan", "lift", "bow", "bend", "tilt", "roll"))


def test_a_robot_without_looks_is_shown_by_its_shapes_for_collisions(pair: tuple[Path, str]) -> None:
    shown = CardRobot(read_described(pair[0] / "robot.json")).card
    seen = {link.name for link in load_robot_model(shown.urdf_path, shown.package_dir) if link.visuals}
    assert {"column", "torso", "l_pan_part", "r_b_part"} <= seen


def test_the_tool_point_is_at_the_fingertips_between_the_fingers(pair: tuple[Path, str]) -> None:
    robot = read_described(pair[0] / "robot.json")
    for arm in robot.card.arms:
        assert arm.tool.approach == (0.0, 0.0, 1.0) and np.abs(arm.tool.closing).tolist() == [1.0, 0.0, 0.0]
        assert arm.tool.offset_m == pytest.approx((0.0, 0.0, TOOL_AHEAD_M - 0.005), abs=1e-3)
        assert arm.gripper.opening_max_m == pytest.approx(0.08, abs=1e-3)
    assert not any(point.is_off for point in tool_points(robot))


def test_every_finger_moves_with_the_gripper_though_the_urdf_does_not_say_so(pair: tuple[Path, str]) -> None:
    urdf = ElementTree.parse(pair[0] / "urdf" / "two-arms.urdf")
    mimics = {joint.get("name"): found for joint in urdf.iter("joint") if (found := joint.find("mimic")) is not None}
    assert set(mimics) == {"l_finger_b", "r_finger_b"}
    assert {one.get("joint") for one in mimics.values()} == {"l_finger_a", "r_finger_a"}
    assert all(float(one.get("multiplier", "")) == 1.0 for one in mimics.values())
    assert "with 'l_finger_a' move 'l_finger_b'" in pair[1]


def test_at_home_nothing_touches_and_the_base_stands_clear_of_the_table(pair: tuple[Path, str]) -> None:
    robot = read_described(pair[0] / "robot.json")
    collisions = CardRobot(robot).collisions(robot.card.scene.table, robot.card.scene.torso_m)
    ((_, station),) = robot.card.scene.stations
    homes = np.concatenate([np.array(arm.home) for arm in robot.card.arms])
    assert np.abs(homes).max() > 0.1
    assert collisions.body_free(station) and collisions.free(station, homes[None]).all()


def test_a_robot_with_high_shoulders_stands_before_a_high_table(pair: tuple[Path, str], tmp_path: Path) -> None:
    (tmp_path / "tall.urdf").write_text(pair_urdf().replace('<origin xyz="0 0 0.8"/>', '<origin xyz="0 0 1.3"/>'))
    result = pleat("robot", "draft", str(tmp_path / "tall.urdf"), "--out", str(tmp_path / "tall"))
    assert result.exit_code == 0, result.output
    low, high = (
        read_described(folder / "robot.json").card.scene.table.height_m for folder in (pair[0], tmp_path / "tall")
    )
    assert high == pytest.approx(min(low + 0.5, 0.95))


def test_arms_that_face_each_other_have_the_table_between_them(tmp_path: Path) -> None:
    near, far = (
        text.replace('xyz="0 0.0 0.0"', f'xyz="{x_m} 0.0 0.0"')
        for text, x_m in ((single_urdf(), -0.6), (arm_urdf("far_", "plate", 0.0, 0.0), 0.6))
    )
    (tmp_path / "facing.urdf").write_text(near.replace("</robot>", f"{far}</robot>"))
    result = pleat("robot", "draft", str(tmp_path / "facing.urdf"), "--out", str(tmp_path / "facing"))
    assert result.exit_code == 0, result.output
    card = read_described(tmp_path / "facing" / "robot.json").card
    ((_, station),) = card.scene.stations
    assert len(card.arms) == 2
    assert station.x_m == 0.0


def test_what_was_guessed_and_what_is_not_known_is_said(pair: tuple[Path, str]) -> None:
    for told in ("Guessed: it stands on the floor", "Guessed: a table", "Not known: how flat", "pleat robot check"):
        assert told in pair[1]


def test_an_archive_in_ros_layout_is_drafted_with_its_meshes_whose_parts_are_made_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[str] = []

    def counted(robot: DescribedRobot) -> list[Part]:
        made.append(robot.card.name)
        return make_parts(robot)

    monkeypatch.setattr(described_parts, "make_parts", counted)
    monkeypatch.setattr(described_parts, "cache_folder", lambda: tmp_path / "cache")
    urdf = single_urdf(speed=0.0).replace(
        '<link name="plate">',
        '<link name="plate"><visual><geometry><mesh filename="package://one_description/meshes/Plate.stl"/></geometry>'
        "</visual>",
    )
    urdf = urdf.replace("</robot>", '<gazebo><plugin filename="libcontrol.so"/></gazebo></robot>')  # is no mesh
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("one_description/urdf/one.urdf", urdf)
        archive.writestr("one_description/meshes/Plate.stl", CUBE)
        archive.writestr("one_description/package.xml", "<package/>")
    (tmp_path / "one.zip").write_bytes(packed.getvalue())
    result = pleat("robot", "draft", str(tmp_path / "one.zip"), "--out", str(tmp_path / "one"))
    assert result.exit_code == 0, result.output
    assert (tmp_path / "one" / "meshes" / "Plate.stl").read_bytes() == CUBE
    robot = read_described(tmp_path / "one" / "robot.json")
    assert len(made) == 1, "of the draft, and of the card that is checked"
    (arm,) = robot.card.arms
    assert arm.speeds == (1.0,) * 6 and "the URDF has none for some of them" in result.stdout
    assert arm.gripper.drive.joint == "slide_a", "joints that slide opposite each other need no name"
    assert robot.card.mounts[0].z_m == pytest.approx(0.75 + 0.02), "it stands on the table with its plate"


def test_a_gripper_may_have_one_jaw_and_parts_without_a_shape(tmp_path: Path) -> None:
    urdf = single_urdf(fingers="{}jaw_{}")
    urdf = urdf.replace('name="jaw_b" type="prismatic"', 'name="jaw_b" type="fixed"')
    screw = urdf[urdf.index('<joint name="jaw_a"') :].partition("</joint>")[0].replace("jaw_a", "gripper_screw")
    urdf = urdf.replace("</robot>", f'{screw.replace("a_part", "screw")}</joint><link name="screw"/></robot>')
    (tmp_path / "one.urdf").write_text(urdf)
    result = pleat("robot", "draft", str(tmp_path / "one.urdf"), "--out", str(tmp_path / "one"))
    assert result.exit_code == 0, result.output
    (arm,) = read_described(tmp_path / "one" / "robot.json").card.arms
    assert arm.gripper.drive.joint == "jaw_a" and arm.gripper.opening_max_m == pytest.approx(0.04, abs=1e-3)
    assert arm.tool.approach == (0.0, 0.0, 1.0) and abs(arm.tool.closing[0]) == 1.0
    assert arm.tool.offset_m == pytest.approx((0.0, 0.0, TOOL_AHEAD_M - 0.005), abs=1e-3)


def test_more_than_two_fingers_are_two_jaws_with_a_doubt(tmp_path: Path) -> None:
    urdf = single_urdf(fingers="{}finger_{}")
    third = urdf[urdf.index('<joint name="finger_b"') : urdf.index("</robot>")]
    (tmp_path / "one.urdf").write_text(
        urdf.replace("</robot>", re.sub("finger_b|b_part", r"\g<0>_too", third) + "</robot>")
    )
    result = pleat("robot", "draft", str(tmp_path / "one.urdf"), "--out", str(tmp_path / "one"))
    assert result.exit_code == 0, result.output
    assert "Not known: whether the 3 fingers at 'roll'" in result.stdout
    assert "with 'finger_a' move 'finger_b', 'finger_b_too'" in result.stdout


XACRO = ' xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:property name="deep" value="${2*3}"/'


def test_xacro_is_expanded_by_the_library_where_that_is_installed(tmp_path: Path) -> None:
    pytest.importorskip("xacro")
    (tmp_path / "one.urdf.xacro").write_text(
        single_urdf(before=XACRO)
        .replace('name="plate"', 'name="plate${deep}"', 1)
        .replace('link="plate"', 'link="plate6"')
    )
    result = pleat("robot", "draft", str(tmp_path / "one.urdf.xacro"), "--out", str(tmp_path / "out"))
    assert result.exit_code == 0, result.output
    assert "plate6" in (tmp_path / "out" / "urdf" / "out.urdf").read_text()


def test_xacro_without_the_library_says_how_to_expand_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xacro", None)
    (tmp_path / "one.xacro").write_text(single_urdf(before=XACRO))
    result = pleat("robot", "draft", str(tmp_path / "one.xacro"), "--out", str(tmp_path / "out"))
    assert result.exit_code == 2 and "must be expanded by xacro" in result.stderr and "[xacro]" in result.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("a.urdf", single_urdf().replace('type="prismatic"', 'type="fixed"'), "ends in a gripper"),
        ("a.urdf", "<robot", "no XML"),
        (
            "a.urdf",
            re.sub('axis xyz="-?1 0 0"/><limit lower="0.0"', 'axis xyz="0 0 1"/><limit lower="0.0"', single_urdf()),
            ": no gripper",
        ),
        ("a.urdf", single_urdf().replace('upper="0.04"', 'upper="0.001"'), "open by 2 mm: no gripper"),
        ("a.xml", '<mujoco model="arm"><worldbody/></mujoco>', "ends in a gripper"),
        ("a.xml", "<mujoco><worldbody><body><joint type='ball'/><geom size='1'/></body></worldbody></mujoco>", "ball"),
        ("a.xml", "<mujoco><nonsense/></mujoco>", "MuJoCo refuses a.xml"),
        ("a.zip", "PK", "zip"),
        ("a.urdf", single_urdf().replace('box size="0.01 0.02 0.06"', 'mesh filename="finger.stl"'), "finger.stl"),
    ],
)
def test_what_is_no_robot_with_grippers_is_refused(tmp_path: Path, name: str, text: str, told: str) -> None:
    (tmp_path / name).write_text(text)
    result = pleat("robot", "draft", str(tmp_path / name), "--out", str(tmp_path / "out"))
    assert result.exit_code == 2 and told in result.stderr, result.output
    assert not (tmp_path / "out").exists()


def test_mujocos_xml_is_drafted_like_the_urdf_of_the_same_robot(tmp_path: Path) -> None:
    (tmp_path / "one.urdf").write_text(single_urdf())
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "one.urdf"))  # MuJoCo reads URDFs too
    mujoco.mj_saveLastXML(str(tmp_path / "one.xml"), model)
    assert "<mujoco" in (tmp_path / "one.xml").read_text()
    cards = []
    for name in ("one.urdf", "one.xml"):
        result = pleat("robot", "draft", str(tmp_path / name), "--out", str(tmp_path / name[:3] / name[4:]))
        assert result.exit_code == 0, result.output
        cards.append(read_described(tmp_path / name[:3] / name[4:] / "robot.json").card)
    (from_urdf,), (from_mjcf,) = (card.arms for card in cards)
    assert from_mjcf.joints == from_urdf.joints and from_mjcf.gripper.drive == from_urdf.gripper.drive
    assert from_mjcf.tool.offset_m == pytest.approx(from_urdf.tool.offset_m, abs=1e-3)
    assert (from_mjcf.tool.approach, from_mjcf.gripper.opening_max_m) == (
        from_urdf.tool.approach,
        from_urdf.gripper.opening_max_m,
    )


MJCF = """<mujoco><worldbody><geom type="plane" size="1 1 1"/><body name="a" pos="0.1 0 0.5" quat="0.5 0.5 0.5 0.5">
  <freejoint/><geom type="capsule" size="0.01 0.05"/>
  <body name="b" pos="0 0.2 0" euler="20 -30 40"><joint name="x" pos="0.03 0 0.01" axis="0 0 1" range="-90 90"/>
    <joint name="y" type="slide" pos="0.1 0.2 0" axis="1 0 0" range="0 0.3"/><geom type="box" size="0.01 0.02 0.03"/>
    <body name="c" pos="0.3 0 0.1" euler="0 90 10"><joint name="z" pos="0 0.05 0" axis="0 1 0"/>
      <geom type="mesh" mesh="m" pos="0 0.1 0"/></body></body></body></worldbody>
  <asset><mesh name="m" vertex="0 0 0  0.1 0 0  0 0.1 0  0 0 0.1"/></asset>
  <equality><joint joint1="z" joint2="x" polycoef="0.1 0.5 0 0 0"/></equality></mujoco>"""


def test_a_robot_in_mujocos_xml_stands_as_mujoco_has_it(tmp_path: Path) -> None:
    (tmp_path / "odd.xml").write_text(MJCF)
    text = read_urdf(Source(urdf_of_mjcf(tmp_path / "odd.xml", tmp_path), tmp_path), "urdf")
    ours = pin.buildModelFromXML(ElementTree.tostring(text, encoding="unicode"))
    theirs = mujoco.MjModel.from_xml_string(MJCF)
    data, q = mujoco.MjData(theirs), {"x": 0.7, "y": 0.2, "z": -0.4}
    for name, value in q.items():
        data.joint(name).qpos = value
    mujoco.mj_forward(theirs, data)
    config = pin.neutral(ours)
    for name, value in q.items():
        joint = ours.joints[ours.getJointId(name)]
        config[joint.idx_q : joint.idx_q + joint.nq] = [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
    own = ours.createData()
    pin.framesForwardKinematics(ours, own, config)
    for geom, link in ((2, "b"), (3, "c")):
        frame = own.oMf[ours.getFrameId(link)]
        shape = next(one for one in text.iter("link") if one.get("name") == link).find("collision/origin")
        assert shape is not None
        xyz, rpy = (np.array([float(number) for number in shape.get(key, "").split()]) for key in ("xyz", "rpy"))
        np.testing.assert_allclose(frame.translation + frame.rotation @ xyz, data.geom_xpos[geom], atol=1e-9)
        turned = frame.rotation @ pin.rpy.rpyToMatrix(rpy)
        np.testing.assert_allclose(turned, data.geom_xmat[geom].reshape(3, 3), atol=1e-9)
    mimic = next(joint for joint in text.iter("joint") if joint.get("name") == "z").find("mimic")
    assert mimic is not None and mimic.attrib == {"joint": "x", "multiplier": "0.5", "offset": "0.1"}


def test_mujocos_xml_without_mujoco_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    (tmp_path / "odd.xml").write_text(MJCF)
    with pytest.raises(RobotError, match="pip install"):
        urdf_of_mjcf(tmp_path / "odd.xml", tmp_path)


def test_a_folder_with_something_in_it_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "robot.json").write_text(json.dumps({"mine": True}))
    (tmp_path / "one.urdf").write_text(single_urdf())
    result = pleat("robot", "draft", str(tmp_path / "one.urdf"), "--out", str(tmp_path / "out"))
    assert result.exit_code == 2 and "not empty" in result.stderr
    assert json.loads((tmp_path / "out" / "robot.json").read_text()) == {"mine": True}
    assert pleat("robot", "draft", str(tmp_path / "no.urdf"), "--out", str(tmp_path / "new")).exit_code == 2
