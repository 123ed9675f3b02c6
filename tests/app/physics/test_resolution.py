"""The mesh of a rehearsal is as fine as its cloth's area allows."""

import pytest

from app.physics.fabric import EDGES_M, VERTICES, Resolution
from planner import load_garment
from planner.geometry.woven_mesh import woven_mesh


@pytest.mark.parametrize(("area_m2", "edge_m"), [(0.1, EDGES_M[0]), (0.5, (0.5 / VERTICES) ** 0.5), (2.0, EDGES_M[1])])
def test_a_larger_cloth_has_a_coarser_mesh_between_two_bounds(area_m2: float, edge_m: float):
    assert Resolution.of(area_m2).edge_m == pytest.approx(edge_m)
    assert EDGES_M[0] < (0.5 / VERTICES) ** 0.5 < EDGES_M[1]


@pytest.mark.parametrize("name", ["tie", "scarf", "big-towel"])
def test_a_mesh_has_about_as_many_vertices_as_its_edge_is_worked_out_for(name: str):
    pattern = load_garment(name).pattern
    edge_m = Resolution.of(pattern.area).edge_m
    points, _ = woven_mesh(pattern, edge_m, 0)
    assert len(points) == pytest.approx(pattern.area / edge_m**2, rel=0.3)
