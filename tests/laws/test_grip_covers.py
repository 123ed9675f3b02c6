"""The chosen grips are those of an exhaustive search, however the cloth is drawn."""

import math
from itertools import combinations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.cloth.grips import Cover, grip_covers
from planner.cloth.must_hold import must_hold
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from tests.laws.law import law
from tests.laws.outlines import Outline, outlines

UP = (0.0, 1.0)
NEAR_M = 1e-4
RADII_M = st.sampled_from((0.03, 0.06, 0.127, 0.3))


def rank(cover: Cover, vertices: list[Point2]) -> list[float]:
    return sorted((min(math.dist(v, g) for g in cover) for v in vertices), reverse=True)


def candidates(ring: Outline, vertices: list[Point2], baseline: Segment | None = None) -> list[Point2]:
    """Return the vertices, and the nearest boundary points to the smallest circles round each two and three of them.

    None on the baseline: a hand there lifts nothing.
    """
    found = {(round(x, 5), round(y, 5)): (x, y) for x, y in vertices}
    edges = [shapely.LineString([a, b]) for a, b in zip(ring, (*ring[1:], ring[0]), strict=True)]
    for count in (2, 3):
        for some in combinations(vertices, count):
            centre = shapely.minimum_bounding_circle(shapely.MultiPoint(some)).centroid
            least = min(edge.distance(centre) for edge in edges)
            for edge in (edge for edge in edges if edge.distance(centre) <= least + 1e-5):
                x, y = shapely.shortest_line(centre, edge).coords[1]
                found.setdefault((round(x, 5), round(y, 5)), (x, y))
    return [p for p in found.values() if baseline is None or baseline.distances(np.array([p]))[0] > 1e-5]


def exhaustive(
    ring: Outline, vertices: list[Point2], radius_m: float, arms: int, baseline: Segment | None = None
) -> list[Cover]:
    """Return all best covers by trying every set of candidates: distances compared largest first, to the tolerance."""
    if not vertices:
        return [()]
    places = candidates(ring, vertices, baseline)
    for count in range(1, arms + 1):
        ranked = [(rank(cover, vertices), cover) for cover in combinations(places, count)]
        good = [(r, cover) for r, cover in ranked if r[0] <= radius_m + 1e-5]
        for column in range(len(vertices)):
            least = min((r[column] for r, _ in good), default=math.inf)
            good = [(r, cover) for r, cover in good if r[column] <= least + 1e-5]
        if good:
            return [cover for _, cover in good]
    return []


def are_same(some: list[Cover], others: list[Cover]) -> bool:
    """Return whether each cover is, to the tolerance, among the others."""
    return all(any(is_near(one, other) for other in others) for one in some) and all(
        any(is_near(one, other) for one in some) for other in others
    )


def is_near(one: Cover, other: Cover) -> bool:
    return len(one) == len(other) and all(min(math.dist(p, q) for q in other) <= NEAR_M for p in one)


def best(ring: Outline, up: Point2, radius_m: float) -> tuple[list[Point2], list[Cover]]:
    """Return the vertices of a hanging piece that must be held, and the covers found."""
    piece = Region.polygon(ring)
    found = grip_covers(piece, must_hold(piece, up, (), 0.0), radius_m, 2)
    return list(found.vertices), list(found.covers)


@given(outlines(most=14), RADII_M)
@law("geometry", short=40, long=800)
def test_the_fast_way_finds_what_trying_everything_finds(ring: Outline, radius_m: float) -> None:
    vertices, covers = best(ring, UP, radius_m)
    assert are_same(covers, exhaustive(ring, vertices, radius_m, 2))


@given(outlines(), RADII_M, st.floats(-math.pi, math.pi), st.booleans())
@law("geometry", short=40, long=700)
def test_cloth_turned_or_mirrored_is_held_at_the_same_places(
    ring: Outline, radius_m: float, turn_rad: float, is_mirrored: bool
) -> None:
    over = Isometry.reflection(Segment((0.1, 0.0), (0.0, 0.3))) if is_mirrored else Isometry()
    way = Isometry.rotation(turn_rad, 0.2, -0.1).after(over)
    up = (way.b, way.d)
    image = [tuple(p) for p in Region.polygon(way.apply(np.array(ring))).moved(Isometry()).whole_ring.tolist()]
    vertices, covers = best(ring, UP, radius_m)
    image_vertices, image_covers = best(tuple(image), up, radius_m)
    assert is_near(tuple(way.apply_point(v) for v in vertices), tuple(image_vertices))
    assert are_same([tuple(way.apply_point(p) for p in cover) for cover in covers], image_covers)


@pytest.mark.parametrize("name", shipped_garment_names())
def test_the_folds_of_a_shipped_garment_are_held_as_trying_everything_holds_them(name: str) -> None:
    sequence, arms, support_rad = FoldSequence.of(load_garment(name)), 2, math.radians(5.0)
    for one in sequence.folds:
        done = (1 << one.index) - 1
        found = sequence.covers(one.index, support_rad, arms)
        ring = tuple((x, y) for x, y in sequence.folded(done, one.index).moving.ring.tolist())
        tried = exhaustive(ring, list(found.vertices), one.grip_radius_m, arms, one.line)
        assert found.covers and are_same(list(found.covers), tried)


def test_two_places_that_are_equally_near_to_a_centre_are_both_candidates() -> None:
    # Two legs 0.1 m wide, 0.06 m apart. The middle of the feet's middles is in the gap, 0.03 m from either leg: a grip
    # at either inner corner is 0.05 m from one foot's middle and 0.11 m from the other's.
    legs = ((0.0, 0.0), (0.1, 0.0), (0.1, 0.3), (0.16, 0.3), (0.16, 0.0), (0.26, 0.0), (0.26, 0.5), (0.0, 0.5))
    feet = np.array([(0.05, 0.0), (0.21, 0.0)])
    found = grip_covers(Region.polygon(legs), feet, 0.127, 1)
    assert sorted(found.covers) == [((0.1, 0.0),), ((0.16, 0.0),)]
