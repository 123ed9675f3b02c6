import numpy as np
import pytest
from numpy.typing import NDArray

from planner.cloth.garment_files import load_garment
from planner.geometry.pose import FloatArray
from planner.geometry.region import Region
from planner.geometry.woven_mesh import woven_mesh


def corners_of(name: str, edge_m: float, seed: int = 0) -> tuple[FloatArray, NDArray[np.int64], FloatArray]:
    points, triangles = woven_mesh(load_garment(name).pattern, edge_m, seed)
    return points, triangles, points[triangles]


@pytest.mark.parametrize("name", ["t-shirt", "jeans", "skirt", "vest", "tie"])
def test_a_mesh_covers_the_pattern_and_no_more_without_slivers(name: str) -> None:
    points, triangles, corners = corners_of(name, 0.02)
    pattern = load_garment(name).pattern
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / 2.0
    assert (areas > 0.0).all()
    assert areas.sum() == pytest.approx(pattern.area, rel=1e-9)
    assert Region.union(Region.polygon(one) for one in corners).area == pytest.approx(pattern.area, rel=1e-6)
    assert len(np.unique(triangles)) == len(points)
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    assert lengths.max() < 2.0 * 0.02
    assert lengths.min() > 0.3 * 0.02


def test_corners_of_the_outline_are_points_of_its_mesh() -> None:
    points, _, _ = corners_of("t-shirt", 0.03)
    for corner in load_garment("t-shirt").pattern.ring:
        assert np.hypot(*(points - corner).T).min() < 1e-9


def test_rows_lie_elsewhere_with_another_seed_and_the_same_with_the_same() -> None:
    assert np.array_equal(corners_of("skirt", 0.03, 1)[0], corners_of("skirt", 0.03, 1)[0])
    assert not np.array_equal(corners_of("skirt", 0.03, 1)[0], corners_of("skirt", 0.03, 2)[0])


def test_diagonals_run_both_ways_so_that_cloth_folds_alike_along_either_bias() -> None:
    _, _, corners = corners_of("hand-towel", 0.02)
    edges = np.roll(corners, -1, axis=1) - corners
    slants = edges[(np.abs(edges) > 0.009).all(axis=2)].prod(axis=1)
    rising, falling = int((slants > 0.0).sum()), int((slants < 0.0).sum())
    assert rising + falling > 1000
    assert rising == pytest.approx(falling, rel=0.1)


@pytest.mark.parametrize("seed", range(6))
def test_the_first_row_along_an_edge_is_nearer_to_it_than_rows_are_to_each_other(seed: int) -> None:
    edge_m = 0.02
    points, _, _ = corners_of("hand-towel", edge_m, seed)
    for axis in (0, 1):
        rows = np.unique(np.round(points[:, axis], 6))
        for gaps in (np.diff(rows[:3]), np.diff(rows[::-1][:3] * -1.0)):
            assert 0.65 * edge_m - 1e-5 <= gaps[0] <= 0.95 * edge_m + 1e-5
            assert 0.59 * edge_m <= gaps[1] <= 1.15 * edge_m + 1e-5
