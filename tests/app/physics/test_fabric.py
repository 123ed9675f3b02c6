"""How finely cloth is simulated."""

import pytest

from app.physics.fabric import Resolution
from planner import load_garment
from planner.geometry.woven_mesh import woven_mesh


@pytest.mark.parametrize(("area_m2", "rows_m"), [(0.02, 0.012), (0.18, 0.015), (0.9, 0.02)])
def test_rows_are_as_near_as_a_cloth_has_points_for(area_m2: float, rows_m: float):
    assert Resolution.of(area_m2).edge_m == pytest.approx(rows_m)


@pytest.mark.parametrize("name", ["tie", "shirt", "letter-towel", "t-shirt"])
def test_small_garments_have_about_as_many_points_as_large_ones(name: str):
    pattern = load_garment(name).pattern
    points, _ = woven_mesh(pattern, Resolution.of(pattern.area).edge_m)
    assert 800 <= len(points) <= 1000
