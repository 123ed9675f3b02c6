"""The shapes of links: what is refused, left out, or brought into a form that every parser knows."""

import re
from pathlib import Path
from typing import IO, Any
from xml.etree.ElementTree import Element

import pytest
import trimesh

from planner.errors import RobotError
from planner.robots.card_parts import UrdfFile
from planner.robots.mesh_file import MeshError, read_mesh_file
from planner.robots.urdf_reader import locate, read_urdf
from tests.required import required

CORNERS = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def read(folder: Path, shape: str) -> Element:
    visual = f'<visual><origin xyz="1 0 0" rpy="0 1.5707963267948966 0"/>{shape}</visual>'
    text = f'<robot><link name="rod">{visual}</link></robot>'
    (folder / "arm.urdf").write_text(text)
    return read_urdf(locate(UrdfFile("arm.urdf"), folder, "urdf"), "urdf")


@pytest.mark.parametrize(
    ("shape", "said"),
    [
        ('<box size="-1 1 1"/>', "a box whose numbers make no shape"),
        ('<box size="1 1"/>', "a box whose numbers make no shape"),
        ('<cylinder radius="1"/>', "a cylinder whose numbers make no shape"),
        ('<sphere radius="much"/>', "a sphere whose numbers make no shape"),
        ('<torus radius="1"/>', "unsupported shape 'torus'"),
        ('<mesh filename="rod.blend"/>', "expected a mesh of stl, dae"),
        (f'<mesh filename="{"x" * 5000}.stl"/>', "there is no mesh 'xxx"),
        ("<mesh/>", "there is no mesh ''"),
    ],
)
def test_a_shape_that_is_none_is_refused_by_its_link(tmp_path: Path, shape: str, said: str) -> None:
    (tmp_path / "rod.blend").touch()
    with pytest.raises(RobotError, match="link 'rod'") as caught:
        read(tmp_path, f"<geometry>{shape}</geometry>")
    assert said in caught.value.message
    assert len(caught.value.message) < 250


@pytest.mark.parametrize("shape", ["", "<geometry/>", '<geometry><cylinder radius="0" length="0"/></geometry>'])
def test_a_shape_without_a_size_is_left_out(tmp_path: Path, shape: str) -> None:
    assert read(tmp_path, shape).find("link/visual") is None


def test_a_capsule_is_a_cylinder_and_two_balls(tmp_path: Path) -> None:
    # Along x, as it is pitched by a right angle: its ends are .2 m before and behind x = 1 m.
    shapes = read(tmp_path, '<geometry><capsule radius=".1" length=".4"/></geometry>').findall("link/visual")
    assert [required(shape.find("geometry"))[0].tag for shape in shapes] == ["cylinder", "sphere", "sphere"]
    places = [[float(part) for part in required(shape.find("origin")).attrib["xyz"].split()] for shape in shapes]
    assert places == [pytest.approx([x, 0.0, 0.0], abs=1e-12) for x in (1.0, 0.8, 1.2)]


def test_packages_may_be_named_with_three_slashes(tmp_path: Path) -> None:
    (tmp_path / "rod.stl").touch()
    found = read(tmp_path, '<geometry><mesh filename="package:///rod.stl"/></geometry>')
    assert required(found.find("link/visual/geometry/mesh")).get("filename") == str(tmp_path / "rod.stl")


@pytest.mark.parametrize("kind", ["stl", "obj", "dae", "ply", "off", "glb"])
def test_a_mesh_is_read_in_the_common_formats(tmp_path: Path, kind: str) -> None:
    trimesh.creation.box((0.2, 0.4, 0.6)).export(tmp_path / f"box.{kind}")
    assert read_mesh_file(tmp_path / f"box.{kind}").extents.tolist() == pytest.approx([0.2, 0.4, 0.6], abs=1e-6)


@pytest.mark.parametrize(("unit", "in_m"), [("0.01", 0.01), ("0.0254", 0.0254), ("0.001", 0.001), ("1", 1.0)])
@pytest.mark.parametrize("up", ["Y_UP", "Z_UP"])
def test_the_unit_of_a_collada_file_counts_and_its_upward_axis_does_not(
    tmp_path: Path, unit: str, in_m: float, up: str
) -> None:
    trimesh.creation.box((0.2, 0.4, 0.6)).export(tmp_path / "box.dae")
    text = (tmp_path / "box.dae").read_text()
    asset = f'<asset><unit name="other" meter="{unit}"/><up_axis>{up}</up_axis></asset>'
    changed = re.sub(r"<asset>.*?</asset>", asset, text, flags=re.DOTALL)
    assert asset in changed
    (tmp_path / "box.dae").write_text(changed)
    expected = [0.2 * in_m, 0.4 * in_m, 0.6 * in_m]
    assert read_mesh_file(tmp_path / "box.dae").extents.tolist() == pytest.approx(expected, rel=1e-5)


def test_no_file_that_a_mesh_names_is_opened(tmp_path: Path) -> None:
    inner = tmp_path / "robot"
    inner.mkdir()
    (tmp_path / "secret.mtl").write_text("newmtl gold\nKd 1 0 0\nmap_Kd secret.png\n")
    (inner / "rod.obj").write_text("mtllib ../secret.mtl\nusemtl gold\n" + CORNERS)
    opened: list[str] = []
    real = open

    def watched(file: str | Path, *args: Any, **options: Any) -> IO[Any]:
        opened.append(str(file))
        found: IO[Any] = real(file, *args, **options)
        return found

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("builtins.open", watched)
        assert len(read_mesh_file(inner / "rod.obj").faces) == 4
    assert not [name for name in opened if "secret" in name]


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("rod.gltf", '{"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"../secret.bin"}],"meshes":[{}]}'),
        (
            "rod.dae",
            '<?xml version="1.0"?><!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/passwd">]><COLLADA>&e;</COLLADA>',
        ),
        ("rod.dae", ""),
        ("rod.glb", "nothing"),
        ("rod.obj", CORNERS + "f 1 2 99\n"),
    ],
)
def test_what_is_no_mesh_or_lies_elsewhere_is_refused_by_the_files_name(
    tmp_path: Path, name: str, content: str
) -> None:
    (tmp_path / name).write_text(content)
    with pytest.raises(MeshError, match=name) as caught:
        read_mesh_file(tmp_path / name)
    assert str(tmp_path) not in str(caught.value)
