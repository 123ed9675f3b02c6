"""The fewest grips that hold every vertex, and of those the nearest."""

import math
import random
from itertools import combinations

import numpy as np
import pytest
import shapely

from planner.cloth.grips import best_covers, grip_covers
from planner.cloth.must_hold import must_hold
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region
from tests.builders import rectangle, star

UP = (0.0, 1.0)


def top(width_m: float) -> tuple[Region, FloatArray]:
    """A rectangle and its two top corners."""
    piece = rectangle(width_m, 0.3)
    return piece, must_hold(piece, UP, (), 0.0)


def rank(cover: tuple[Point2, ...], vertices: FloatArray) -> list[float]:
    return sorted((min(math.dist(v, g) for g in cover) for v in vertices), reverse=True)


def test_two_vertices_exactly_two_radii_apart_are_held_by_one_grip_half_way():
    piece, vertices = top(0.254)
    found = grip_covers(piece, vertices, 0.127, 2)
    assert found.count == 1
    assert found.covers == (((pytest.approx(0.127), pytest.approx(0.3)),),)


def test_two_vertices_a_millimetre_further_apart_are_gripped_each():
    piece, vertices = top(0.255)
    found = grip_covers(piece, vertices, 0.127, 2)
    assert found.covers == (((0.0, 0.3), (0.255, 0.3)),)


def test_what_needs_no_holding_needs_no_grip():
    found = grip_covers(rectangle(0.4, 0.3), np.empty((0, 2)), 0.127, 2)
    assert found.is_holdable and found.count == 0 and found.covers == ((),)


def test_more_grips_than_arms_are_no_cover():
    piece, vertices = top(0.4)
    found = grip_covers(piece, vertices, 0.127, 1)
    assert not found.is_holdable and found.count is None
    assert found.vertices == ((0.4, 0.3), (0.0, 0.3))


def test_covers_that_mirror_each_other_tie_and_are_both_kept():
    # Three vertices L, M, R: |LM| = |MR| = hypot(.25, .02) = .2508, so one grip half-way holds two of them, not three.
    house = Region.polygon([(0, 0), (0.5, 0), (0.5, 0.5), (0.25, 0.52), (0, 0.5)])
    vertices = must_hold(house, UP, (), 0.0)
    assert len(vertices) == 3
    found = grip_covers(house, vertices, 0.13, 2)
    mirrored = {tuple(sorted((round(0.5 - x, 4), round(y, 4)) for x, y in c)) for c in found.covers}
    assert mirrored == {tuple(sorted((round(x, 4), round(y, 4)) for x, y in c)) for c in found.covers}
    assert len(found.covers) == 2
    assert rank(found.covers[0], vertices) == pytest.approx([0.1254, 0.1254, 0.0], abs=1e-4)


def test_a_round_cloth_has_too_many_vertices_for_two_grips():
    angles = np.linspace(0.0, math.tau, 360, endpoint=False)
    round_cloth = Region.polygon(np.column_stack([0.4 * np.cos(angles), 0.4 * np.sin(angles)]))
    vertices = must_hold(round_cloth, UP, (), 0.0)
    assert len(vertices) > 150
    assert not grip_covers(round_cloth, vertices, 0.127, 2).is_holdable


def test_a_small_round_cloth_is_held_by_one_grip():
    angles = np.linspace(0.0, math.tau, 40, endpoint=False)
    coaster = Region.polygon(np.column_stack([0.05 * np.cos(angles), 0.05 * np.sin(angles)]))
    found = grip_covers(coaster, must_hold(coaster, UP, (), 0.0), 0.127, 2)
    assert found.count == 1


def test_only_the_candidates_given_are_used():
    vertices = np.array([[0.0, 0.3], [0.1, 0.3]])
    held = np.array([[0.05, 0.3], [0.9, 0.9]])
    assert best_covers(held, vertices, 0.127, 2) == (((0.05, 0.3),),)
    assert best_covers(held[1:], vertices, 0.127, 2) == ()


def exhaustive(piece: Region, vertices: FloatArray, radius_m: float, arms: int) -> set[tuple[Point2, ...]]:
    """All best covers by trying every set of candidates, as the model's second section defines them."""
    points = [tuple(v) for v in vertices.tolist()]
    candidates = {(round(x, 5), round(y, 5)): (x, y) for x, y in points}
    for count in (2, 3):
        for some in combinations(points, count):
            centre = shapely.minimum_bounding_circle(shapely.MultiPoint(some)).centroid
            x, y = shapely.shortest_line(centre, piece.shape.boundary).coords[1]
            candidates.setdefault((round(x, 5), round(y, 5)), (x, y))
    for count in range(1, arms + 1):
        ranked = [(rank(c, vertices), c) for c in combinations(candidates.values(), count)]
        good = [(r, c) for r, c in ranked if r[0] <= radius_m + 1e-5]
        if good:
            best = min(r for r, _ in good)
            return {keyed(c) for r, c in good if np.allclose(r, best, atol=1e-5)}
    return set()


def keyed(cover: tuple[Point2, ...]) -> tuple[Point2, ...]:
    return tuple(sorted((round(x, 3) + 0.0, round(y, 3) + 0.0) for x, y in cover))


@pytest.mark.parametrize("radius_m", [0.06, 0.127, 0.3])
def test_the_fast_way_finds_what_trying_everything_finds(radius_m: float):
    rng = random.Random(8)
    for _ in range(40):
        piece = Region.polygon(star(rng, 7))
        if not piece.shape.is_valid:
            continue
        vertices = must_hold(piece, UP, (), 0.0)
        found = grip_covers(piece, vertices, radius_m, 2)
        assert {keyed(c) for c in found.covers} == exhaustive(piece, vertices, radius_m, 2)


def test_every_vertex_is_within_the_radius_of_a_grip():
    rng = random.Random(9)
    for _ in range(60):
        piece = Region.polygon(star(rng, 8))
        if not piece.shape.is_valid:
            continue
        vertices = must_hold(piece, UP, (), 0.1)
        for cover in grip_covers(piece, vertices, 0.2, 2).covers:
            assert rank(cover, vertices)[0] <= 0.2 + 1e-5
            assert all(piece.boundary_distance(grip) < 1e-9 for grip in cover)
