"""Which vertices must be held (Theorems 1 and 2). Up is +y unless a test turns it."""

import math
import random

import numpy as np
import pytest
import shapely

from planner.cloth.must_hold import must_hold
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from tests.builders import noisy, rectangle, star
from tests.replay import flat

UP = (0.0, 1.0)


def held(piece: Region, up: Point2 = UP, baseline: tuple[Segment, ...] = (), support_deg: float = 0.0) -> set[Point2]:
    found = must_hold(piece, up, baseline, math.radians(support_deg))
    return {(round(float(x), 4), round(float(y), 4)) for x, y in found}


def test_a_rectangle_hangs_from_its_two_top_corners() -> None:
    assert held(rectangle(0.4, 0.3)) == {(0.0, 0.3), (0.4, 0.3)}


@pytest.mark.parametrize("support_deg", [0.0, 5.0, 60.0])
def test_nothing_need_be_held_that_hangs_from_its_top_edge(support_deg: float) -> None:
    top = Segment((0.0, 0.3), (0.4, 0.3))
    assert held(rectangle(0.4, 0.3), baseline=(top,), support_deg=support_deg) == set()


def test_of_two_corners_only_the_one_off_the_baseline_must_be_held() -> None:
    assert held(rectangle(0.4, 0.3), baseline=(Segment((0.0, 0.3), (0.2, 0.3)),)) == {(0.4, 0.3)}


def test_a_triangle_that_hangs_by_its_base_needs_nothing_at_its_tip() -> None:
    triangle = Region.polygon([(0.0, 0.3), (0.4, 0.3), (0.2, 0.0)])
    assert held(triangle) == {(0.0, 0.3), (0.4, 0.3)}
    assert held(triangle, baseline=(Segment((0.0, 0.3), (0.4, 0.3)),)) == set()


def test_a_triangle_that_hangs_by_its_tip_must_be_held_at_all_three_corners() -> None:
    # Its sides lean by atan(0.2 / 0.3) = 33.7 degrees from the vertical.
    triangle = Region.polygon([(0.0, 0.0), (0.4, 0.0), (0.2, 0.3)])
    assert held(triangle) == {(0.0, 0.0), (0.4, 0.0), (0.2, 0.3)}
    assert held(triangle, support_deg=33.0) == {(0.0, 0.0), (0.4, 0.0), (0.2, 0.3)}
    assert held(triangle, support_deg=34.0) == {(0.2, 0.3)}


@pytest.mark.parametrize(("end", "is_held"), [(0.3, False), (0.299, False), (0.2, True)])
def test_the_tip_of_a_wedge_a_hair_wide_that_leaves_the_baseline_hangs_from_nothing(end: float, is_held: bool) -> None:
    # The upper side falls by 1 mm in a metre: beyond x = 0.299 the wedge is 1 um high, beyond x = 0.2 it is 100 um.
    wedge = Region.polygon([(0.0, 0.0), (0.3, 0.0), (0.0, 0.0003)])
    assert ((0.3, 0.0) in held(wedge, baseline=(Segment((0.0, 0.0), (end, 0.0)),))) == is_held


def flaring(degrees: float) -> Region:
    """Return a trapezoid 0.4 m wide on top that widens downwards on both sides by an angle from the vertical."""
    more = 0.3 * math.tan(math.radians(degrees))
    return Region.polygon([(-more, 0.0), (0.4 + more, 0.0), (0.4, 0.3), (0.0, 0.3)])


def test_an_edge_that_flares_by_one_degree_must_be_held_by_the_bare_theory_only() -> None:
    assert len(held(flaring(1.0))) == 4
    assert held(flaring(1.0), support_deg=5.0) == {(0.0, 0.3), (0.4, 0.3)}


def test_an_edge_that_narrows_downwards_needs_no_support_angle() -> None:
    assert len(held(flaring(-1.0))) == 2


def test_with_the_sixty_degrees_of_the_paper_an_edge_may_flare_by_that_much() -> None:
    assert len(held(flaring(59.5), support_deg=60.0)) == 2
    assert len(held(flaring(60.5), support_deg=60.0)) == 4


def test_a_vertex_off_the_hull_need_not_be_held() -> None:
    # A crown whose middle peak stays below the line from the left peak to the right one.
    crown = Region.polygon([(0, 0), (0.4, 0), (0.4, 0.3), (0.3, 0.2), (0.2, 0.25), (0.1, 0.2), (0, 0.3)])
    assert held(crown) == {(0.0, 0.3), (0.4, 0.3)}


def test_points_on_a_straight_edge_a_micrometre_off_change_nothing() -> None:
    noisy = Region.polygon(
        [(0, 0), (0.2, -1e-6), (0.4, 0), (0.4 + 1e-6, 0.1), (0.4, 0.3), (0.2, 0.3 + 1e-6), (0, 0.3), (-1e-6, 0.2)]
    )
    assert held(noisy) == {(0.0, 0.3), (0.4, 0.3)}


def test_a_side_a_micrometre_off_the_vertical_counts_as_running_along_it() -> None:
    assert held(Region.polygon([(-1e-6, 0), (0.4 + 1e-6, 0), (0.4, 0.3), (0, 0.3)])) == {(0.0, 0.3), (0.4, 0.3)}


def test_of_several_parts_the_hull_is_that_of_all() -> None:
    # Two squares side by side, the right one lower: its left top corner is inside the common hull.
    both = Region.union([rectangle(0.1, 0.3), rectangle(0.1, 0.1, 0.2)])
    assert held(both) == {(0.0, 0.3), (0.1, 0.3), (0.3, 0.1)}


def test_turning_cloth_and_direction_together_turns_the_answer() -> None:
    rng = random.Random(4)
    for _ in range(40):
        region = Region.polygon(star(rng, 8))
        if not region.shape.is_valid:
            continue
        turn = rng.uniform(-math.pi, math.pi)
        up = (math.cos(math.pi / 2 + turn), math.sin(math.pi / 2 + turn))
        turned = must_hold(Region.polygon(Isometry.rotation(turn).apply(region.ring)), up, (), 0.1)
        expected = Isometry.rotation(turn).apply(must_hold(region, UP, (), 0.1))
        assert np.array(sorted(turned.tolist())) == pytest.approx(np.array(sorted(expected.tolist())), abs=1e-6)


@pytest.mark.parametrize("support_deg", [0.0, 5.0, 45.0])
def test_random_polygons_agree_with_looking_for_cloth_above_each_vertex(support_deg: float) -> None:
    rng = random.Random(6)
    for _ in range(60):
        region = Region.polygon(star(rng, 9))
        around = flat.corners(shapely.convex_hull(region.shape))
        if not region.shape.is_valid or any(flat.is_hardly_a_corner(*corner) for corner in around):
            continue
        looked = flat.must_hold(region.shape, UP, [], math.radians(support_deg))
        assert held(region, support_deg=support_deg) == {(round(x, 4), round(y, 4)) for x, y in looked}


def test_a_wider_support_angle_never_asks_for_more() -> None:
    rng = random.Random(7)
    for _ in range(40):
        region = Region.polygon(star(rng, 9))
        if region.shape.is_valid:
            answers = [held(region, support_deg=angle) for angle in (0.0, 5.0, 30.0, 80.0)]
            assert answers[0] >= answers[1] >= answers[2] >= answers[3]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("count", [60, 200, 400])
def test_of_a_traced_rectangle_no_more_must_be_held_than_of_the_rectangle(count: int, seed: int) -> None:
    corners = np.array([(0.0, 0.0), (0.4, 0.0), (0.4, 0.3), (0.0, 0.3)])
    outline = noisy(corners, count, 0.001, random.Random(seed))
    found = must_hold(Region.polygon(outline), UP, (Segment((0.0, 0.0), (0.4, 0.0)),), math.radians(5.0))
    gaps = np.hypot(*(found[:, None] - corners[2:]).transpose(2, 0, 1))
    assert gaps.min(axis=1).max() < 0.005 and gaps.min(axis=0).max() < 0.005


@pytest.mark.parametrize("radius_m", [0.1, 0.25])
def test_the_must_hold_zone_of_a_round_cloth_is_the_same_by_however_many_points_it_is_drawn(radius_m: float) -> None:
    ends = []
    for count in (60, 100, 200, 400):
        angles = np.linspace(0.0, math.pi, count // 2 + 1)
        half = Region.polygon(radius_m * np.column_stack([np.cos(angles), np.sin(angles)]))
        found = must_hold(half, UP, (Segment((-radius_m, 0.0), (radius_m, 0.0)),), math.radians(5.0))
        ends.append(math.degrees(np.arctan2(found[:, 1], found[:, 0]).min()))
    assert max(ends) - min(ends) < 4.0
