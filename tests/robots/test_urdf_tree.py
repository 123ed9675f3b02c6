"""What is refused of a URDF's links and joints, by name, and what is brought into a common form."""

from pathlib import Path
from xml.etree.ElementTree import Element

import pytest

from planner.errors import RobotError
from planner.robots.card_parts import UrdfFile
from planner.robots.urdf_reader import locate, read_urdf
from tests.required import required

LIMIT = '<limit lower="-1" upper="1" velocity="2" effort="3"/>'
ARM = f"""<robot name="arm"><link name="body"/><link name="hand"/><link name="thumb"/>
  <joint name="elbow" type="revolute"><parent link="body"/><child link="hand"/><axis xyz="0 0 1"/>{LIMIT}</joint>
  <joint name="grip" type="prismatic"><parent link="hand"/><child link="thumb"/><axis xyz="0 1 0"/>{LIMIT}</joint>
</robot>"""


def read(folder: Path, text: str) -> Element:
    (folder / "arm.urdf").write_text(text)
    return read_urdf(locate(UrdfFile("arm.urdf"), folder, "urdf"), "urdf")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('<link name="hand"/>', "<link/>", "a link has no name"),
        ('<link name="hand"/>', '<link name="hand"/><link name="hand"/>', "two links are called 'hand'"),
        ('name="grip"', 'name="elbow"', "two joints are called 'elbow'"),
        ('name="grip" type="prismatic"', 'name="grip"', "joint 'grip' has no type"),
        ('type="prismatic"', 'type="screw"', "joint 'grip' has the type 'screw'"),
        ('<child link="hand"/>', "", "joint 'elbow' has no child link"),
        ('<parent link="body"/>', '<parent link="foot"/>', "joint 'elbow': there is no link 'foot'"),
        ('<parent link="body"/>', '<parent link="thumb"/>', "in a ring: 'hand', 'thumb'"),
        ('<child link="thumb"/>', '<child link="hand"/>', "link 'hand' hangs from two joints, 'elbow' and 'grip'"),
        ('<link name="hand"/>', '<link name="hand"/><link name="hat"/>', "2 root links, not one: 'body', 'hat'"),
        ('xyz="0 0 1"', 'xyz="0 0 0"', "joint 'elbow': its axis has no direction"),
        ('xyz="0 0 1"', 'xyz="0 1"', "joint 'elbow': axis has xyz '0 1', not three numbers"),
        (LIMIT, "", "joint 'elbow' is revolute and has no limit"),
        (LIMIT, LIMIT + '<origin xyz="0 0 1e9"/>', "joint 'elbow': origin has xyz '0 0 1e9'"),
        (LIMIT, LIMIT + '<mimic joint="elbow"/>', "joint 'elbow' mimics itself"),
        (LIMIT, LIMIT + '<mimic joint="grip" offset="nan"/>', "joint 'elbow': mimic has offset 'nan'"),
    ],
)
def test_what_makes_no_tree_is_refused_by_name(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(RobotError) as caught:
        read(tmp_path, ARM.replace(old, new, 1))
    assert caught.value.field == "urdf"
    assert said in caught.value.message


def test_a_robot_without_links_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RobotError, match="has no link"):
        read(tmp_path, "<robot/>")


def test_numbers_that_planning_does_not_need_may_be_missing_or_wrong(tmp_path: Path) -> None:
    mass = '<link name="hand"><inertial><mass value="much"/></inertial></link>'
    text = ARM.replace('<link name="hand"/>', mass).replace(' velocity="2" effort="3"', "")
    found = read(tmp_path, text)
    assert found.find("link/inertial") is None
    limit = required(found.find("joint/limit"))
    assert limit.attrib == {"lower": "-1", "upper": "1", "effort": "0.0", "velocity": "0.0"}


def test_a_joint_of_many_turns_has_no_end(tmp_path: Path) -> None:
    kinds = [
        required(read(tmp_path, ARM.replace('lower="-1"', f'lower="{low}"', 1)).find("joint")).get("type")
        for low in (-12.6, -1e16)
    ]
    assert kinds == ["revolute", "continuous"]


def test_a_joint_that_mimics_one_that_mimics_follows_the_one_that_is_driven(tmp_path: Path) -> None:
    # third = 2 second + .1 = 2 (-3 elbow + .2) + .1 = -6 elbow + .5
    joints = "".join(
        f'<link name="of {name}"/><joint name="{name}" type="revolute"><parent link="body"/><child link="of {name}"/>'
        f'{LIMIT}<mimic joint="{driver}" multiplier="{factor}" offset="{offset}"/></joint>'
        for name, driver, factor, offset in (("third", "second", 2, 0.1), ("second", "elbow", -3, 0.2))
    )
    found = read(tmp_path, ARM.replace("</robot>", joints + "</robot>"))
    third = required(found.find("joint[@name='third']/mimic"))
    assert third.get("joint") == "elbow"
    assert float(third.attrib["multiplier"]) == pytest.approx(-6.0)
    assert float(third.attrib["offset"]) == pytest.approx(0.5)


@pytest.mark.parametrize("driver", ["nobody", "rigid"])
def test_a_joint_that_mimics_what_does_not_move_rests(tmp_path: Path, driver: str) -> None:
    rigid = '<link name="nail"/><joint name="rigid" type="fixed"><parent link="body"/><child link="nail"/></joint>'
    mimic = LIMIT + f'<mimic joint="{driver}"/>'
    found = read(tmp_path, ARM.replace(LIMIT, mimic, 1).replace("</robot>", rigid + "</robot>"))
    assert found.find("joint[@name='elbow']/mimic") is None
