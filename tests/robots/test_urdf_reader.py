"""What is read of a URDF, and what is refused."""

from pathlib import Path
from xml.etree.ElementTree import Element

import pytest

from planner.errors import RobotError
from planner.robots.card_parts import UrdfFile
from planner.robots.urdf_reader import locate, read_urdf
from planner.robots.urdf_shapes import MESH_BYTES_MAX
from tests.required import required

ARM = """<robot name="arm">
  <link name="body"><visual><geometry><mesh filename="{mesh}"/></geometry></visual></link>
  <link name="hand"/>
  <joint name="elbow" type="revolute">
    <parent link="body"/><child link="hand"/><axis xyz="0 0 1"/>
    <limit lower="{lower}" upper="1" velocity="1" effort="1"/>
  </joint>
</robot>"""


def read(folder: Path, text: str) -> Element:
    (folder / "robot").mkdir(exist_ok=True)
    (folder / "robot" / "body.stl").touch()
    (folder / "secret.stl").touch()
    (folder / "robot" / "arm.urdf").write_text(text)
    return read_urdf(locate(UrdfFile("arm.urdf"), folder / "robot", "urdf"), "urdf")


@pytest.mark.parametrize("mesh", ["body.stl", "./body.stl", "package://body.stl", "package://robot/body.stl"])
def test_the_paths_of_meshes_become_absolute(tmp_path: Path, mesh: str) -> None:
    found = read(tmp_path, ARM.format(mesh=mesh, lower=-1))
    assert required(found.find("link/visual/geometry/mesh")).get("filename") == str(tmp_path / "robot" / "body.stl")


@pytest.mark.parametrize(
    ("mesh", "said"),
    [
        ("../secret.stl", "leads out"),
        ("package://../secret.stl", "leads out"),
        ("/etc/passwd", "not given by a path within"),
        ("file:///etc/passwd", "not given by a path within"),
        ("http://example.org/body.stl", "not given by a path within"),
        ("hand.stl", "no mesh 'hand.stl'"),
    ],
)
def test_no_mesh_is_read_outside_of_the_robots_folder(tmp_path: Path, mesh: str, said: str) -> None:
    with pytest.raises(RobotError, match="link 'body'") as caught:
        read(tmp_path, ARM.format(mesh=mesh, lower=-1))
    assert said in caught.value.message


def test_a_link_to_a_file_outside_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "inner.stl").symlink_to(tmp_path / "secret.stl")
    with pytest.raises(RobotError, match="leads out"):
        read(tmp_path, ARM.format(mesh="inner.stl", lower=-1))


@pytest.mark.parametrize("lower", ["nan", "-inf", "low", "1 nan"])
def test_limits_that_are_no_numbers_are_told_with_their_joint(tmp_path: Path, lower: str) -> None:
    with pytest.raises(RobotError, match="joint 'elbow': limit has lower"):
        read(tmp_path, ARM.format(mesh="body.stl", lower=lower))


def test_a_document_type_is_refused_and_with_it_every_entity(tmp_path: Path) -> None:
    bomb = '<!DOCTYPE robot [<!ENTITY a "ha"><!ENTITY b "&a;&a;">]>' + ARM.format(mesh="&b;", lower=-1)
    with pytest.raises(RobotError, match="document type"):
        read(tmp_path, bomb)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<robot>", "is no XML"),
        ("", "is no XML"),
        ("<svg/>", "is no URDF"),
        ("<robot>" + "<link/>" * 60_000 + "</robot>", "more than 50000 elements"),
        ("<robot>" * 1000 + "</robot>" * 1000, "nests more than"),
    ],
)
def test_what_is_no_urdf_is_refused(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(RobotError, match=said):
        read(tmp_path, text)


def test_a_mesh_of_a_million_triangles_is_refused(tmp_path: Path) -> None:
    (tmp_path / "robot").mkdir()
    with (tmp_path / "robot" / "huge.stl").open("wb") as file:
        file.truncate(84 + 50 * 1_000_000)
    assert MESH_BYTES_MAX < 84 + 50 * 1_000_000
    with pytest.raises(RobotError, match=r"huge\.stl"):
        read(tmp_path, ARM.format(mesh="huge.stl", lower=-1))


def test_a_missing_shape_for_collisions_is_left_out_where_the_link_is_seen(tmp_path: Path) -> None:
    more = '</visual><collision><geometry><mesh filename="gone.stl"/></geometry></collision>'
    found = read(tmp_path, ARM.format(mesh="body.stl", lower=-1).replace("</visual>", more))
    assert found.find("link/collision") is None
    assert found.find("link/visual") is not None


@pytest.mark.parametrize(
    "text",
    [
        '<robot name="arm" xmlns:xacro="x"><link name="${prefix}body"/></robot>',
        '<robot name="arm"><xacro:include filename="parts.xacro"/><xacro:arm name="left"/></robot>',
        ARM.format(mesh="$(find arm)/body.stl", lower=-1),
    ],
)
def test_xacro_that_was_not_expanded_is_called_so(tmp_path: Path, text: str) -> None:
    with pytest.raises(RobotError, match=r"arm\.urdf is xacro that was not expanded"):
        read(tmp_path, text)


def test_what_xacro_leaves_behind_is_no_xacro(tmp_path: Path) -> None:
    text = ARM.format(mesh="body.stl", lower=-1).replace(
        '<robot name="arm">', '<robot name="arm" xmlns:xacro="x"><xacro:arg name="prefix" default="$(arg side)"/>'
    )
    assert required(read(tmp_path, text).find("link")).get("name") == "body"
