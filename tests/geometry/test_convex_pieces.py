"""Convex pieces cover a region, and little beyond it."""

import math
import random

import numpy as np
import pytest
import shapely

from planner.geometry.region import Region, convex_pieces
from tests.builders import rectangle, star


def test_a_convex_region_is_one_piece() -> None:
    (piece,) = convex_pieces(rectangle(0.3, 0.2))
    assert Region.polygon(piece).area == pytest.approx(0.06)


@pytest.mark.parametrize("seed", range(20))
def test_pieces_are_convex_and_cover_all_and_nothing_more(seed: int) -> None:
    region = Region.polygon(star(random.Random(seed), 9))
    pieces = [shapely.Polygon(piece) for piece in convex_pieces(region)]
    for piece in pieces:
        assert piece.exterior.is_ccw
        assert piece.convex_hull.area == pytest.approx(piece.area)
    assert shapely.symmetric_difference(shapely.union_all(pieces), region.shape).area < 1e-5


def test_an_outline_of_many_corners_is_covered_by_far_fewer_pieces() -> None:
    turns = np.linspace(0.0, math.tau, 240, endpoint=False)
    reach = 0.3 + 0.02 * np.sin(9 * turns)
    region = Region.polygon(np.column_stack([reach * np.cos(turns), reach * np.sin(turns)]))
    pieces = convex_pieces(region)
    covered = shapely.union_all([shapely.Polygon(piece) for piece in pieces])
    assert len(pieces) < len(region.triangles) / 2
    assert shapely.difference(region.shape, covered).area < 1e-5
    assert covered.area < 1.1 * region.area
