"""How finely cloth is simulated."""

import pytest

from app.rehearsal.physics.fabric import Fabric, Resolution
from planner import load_garment
from planner.geometry.woven_mesh import woven_mesh


@pytest.mark.parametrize(("area_m2", "rows_m"), [(0.02, 0.012), (0.18, 0.015), (0.9, 0.018)])
def test_rows_are_as_near_as_a_cloth_has_points_for(area_m2: float, rows_m: float) -> None:
    assert Resolution.of(area_m2).edge_m == pytest.approx(rows_m)


@pytest.mark.parametrize("name", ["tie", "shirt", "letter-towel", "t-shirt"])
def test_small_garments_have_about_as_many_points_as_large_ones(name: str) -> None:
    pattern = load_garment(name).pattern
    points, _ = woven_mesh(pattern, Resolution.of(pattern.area).edge_m)
    assert 800 <= len(points) <= 1150  # rows that lie at edges come in addition


@pytest.mark.parametrize(
    ("thickness_m", "layer_m"), [(0.0001, 0.0014), (0.0006, 0.0016), (0.001, 0.002), (0.005, 0.006)]
)
def test_layers_lie_a_millimetre_further_apart_than_they_are_thick(thickness_m: float, layer_m: float) -> None:
    assert Fabric(thickness_m=thickness_m).layer_m == pytest.approx(layer_m)
