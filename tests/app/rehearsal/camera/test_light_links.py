"""A robot's links with few points, kept in the user's cache."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from app.rehearsal.camera import light_links as module
from app.rehearsal.camera.light_links import light_links
from app.ui import robot_model
from app.ui.robot_model import Link, load_robot_model
from planner.robots.load_robot import load_robot


def same(one: tuple[Link, ...], other: tuple[Link, ...]) -> bool:
    """Return whether two robots have the same links to the last digit."""
    scalars = [name for name in Link.__slots__ if name not in ("axis", "visuals")]
    return len(one) == len(other) and all(
        [getattr(a, name) for name in scalars] == [getattr(b, name) for name in scalars]
        and np.array_equal(a.axis, b.axis)
        and [visual.pose for visual in a.visuals] == [visual.pose for visual in b.visuals]
        and all(np.array_equal(x.vertices, y.vertices) for x, y in zip(a.visuals, b.visuals, strict=True))
        for a, b in zip(one, other, strict=True)
    )


def test_links_are_read_once_and_then_from_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    card = load_robot("pr2").card
    first = light_links(card.urdf_path, card.package_dir, tmp_path)

    def refuse(*_: object) -> tuple[Link, ...]:
        raise AssertionError("the meshes are read again")

    monkeypatch.setattr(module, "load_robot_model", refuse)
    assert same(light_links(card.urdf_path, card.package_dir, tmp_path), first)


def test_links_keep_their_joints_and_the_size_of_each_part(tmp_path: Path) -> None:
    card = load_robot("pr2").card
    whole, light = (
        load_robot_model(card.urdf_path, card.package_dir),
        light_links(card.urdf_path, card.package_dir, tmp_path),
    )
    assert [(link.node, link.joint) for link in light] == [(link.node, link.joint) for link in whole]
    parts = [[one.vertices for link in links for one in link.visuals] for links in (whole, light)]
    for many, few in zip(*parts, strict=True):
        assert len(few) < 810
        assert np.array_equal([few.min(axis=0), few.max(axis=0)], [many.min(axis=0), many.max(axis=0)])


def test_a_cache_that_cannot_be_read_is_made_again(tmp_path: Path) -> None:
    card = load_robot("pr2").card
    first = light_links(card.urdf_path, card.package_dir, tmp_path)
    (kept,) = (tmp_path / "links").iterdir()
    kept.write_bytes(kept.read_bytes()[:1000])
    assert same(light_links(card.urdf_path, card.package_dir, tmp_path), first)
    assert kept.stat().st_size > 1000


def test_another_urdf_or_mesh_is_another_robot_to_the_cache(tmp_path: Path) -> None:
    look = '<visual><geometry><mesh filename="package://{}"/></geometry></visual>'
    box = f'<robot name="box"><link name="a">{look}</link></robot>'
    corners = "vertex 0 0 0\nvertex {0} 0 0\nvertex 0 {0} 0.1"
    mesh = f"solid a\nfacet normal 0 0 1\nouter loop\n{corners}\nendloop\nendfacet\nendsolid\n"
    urdf = tmp_path / "box.urdf"
    urdf.write_text(box.format("a.stl"))
    lengths = []
    for length in (1.0, 2.0):
        (tmp_path / "a.stl").write_text(mesh.format(length))
        robot_model._model.cache_clear()  # a process of its own
        (link,) = light_links(urdf, tmp_path, tmp_path / "kept")
        lengths.append(float(link.visuals[0].vertices.max()))
    assert lengths == [1.0, 2.0]
    shutil.copy(tmp_path / "a.stl", tmp_path / "b.stl")
    urdf.write_text(box.format("b.stl"))
    light_links(urdf, tmp_path, tmp_path / "kept")
    assert len(list((tmp_path / "kept" / "links").iterdir())) == 3
