"""Meshes of robots as they are sent to a browser."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from app.ui.robot_mesh import MOST_TRIANGLES, creased, read_mesh

WHOLE = (1.0, 1.0, 1.0)


def split_edges(path: Path, mesh: trimesh.Trimesh) -> str:
    """Write a mesh as makers export them, each triangle with vertices of its own; return the file's path."""
    mesh.unmerge_vertices()
    mesh.export(path)
    return str(path)


def test_a_box_has_a_vertex_for_each_side_of_its_edges(tmp_path: Path) -> None:
    mesh = read_mesh(split_edges(tmp_path / "box.stl", trimesh.creation.box()), WHOLE)
    assert len(mesh.vertices) == 8
    vertices, triangles = creased(mesh)
    assert len(vertices) == 24
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for vertex in range(24):
        around = normals[(triangles == vertex).any(axis=1)]
        assert np.ptp(around, axis=0).max() < 1e-12


def test_a_ball_has_no_sharp_edges(tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere(subdivisions=3)
    mesh = read_mesh(split_edges(tmp_path / "ball.stl", ball.copy()), (2.0, 2.0, 2.0))
    vertices, triangles = creased(mesh)
    assert len(vertices) == len(ball.vertices)
    assert len(triangles) == len(ball.faces)
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 2.0, rtol=1e-6)


def test_triangles_keep_their_corners() -> None:
    mesh = trimesh.creation.cylinder(0.05, 0.2)
    vertices, triangles = creased(mesh)
    np.testing.assert_array_equal(vertices[triangles], mesh.vertices[mesh.faces])


def test_a_fine_mesh_becomes_coarser_and_keeps_its_shape(tmp_path: Path) -> None:
    fine = trimesh.creation.icosphere(subdivisions=6, radius=0.1)
    assert len(fine.faces) > 10 * MOST_TRIANGLES
    mesh = read_mesh(split_edges(tmp_path / "fine.stl", fine.copy()), WHOLE)
    assert 0 < len(mesh.faces) <= MOST_TRIANGLES
    assert np.abs(np.linalg.norm(mesh.vertices, axis=1) - 0.1).max() < 1e-3
    assert mesh.area == pytest.approx(fine.area, rel=0.01)


def test_a_vertex_that_thousands_of_triangles_share_is_quick() -> None:
    """A fan about one vertex, as cables and labels have them: work per triangle, not per pair of triangles."""
    count = 20_000
    turns = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    rim = np.column_stack([np.cos(turns), np.sin(turns), np.zeros(count)])
    index = np.arange(count)
    fan = trimesh.Trimesh(
        np.vstack([rim, [[0.0, 0.0, 0.5]]]),
        np.column_stack([index, (index + 1) % count, np.full(count, count)]),
        process=False,
    )
    vertices, _ = creased(fan)
    assert len(vertices) == count + 1
