"""Regions: cut, moved, joined; corners without points in the middle of straight edges."""

import math
import random

import numpy as np
import pytest
import shapely

from planner.geometry.isometry import Isometry
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from tests.builders import is_same_region, rectangle, star


def test_either_orientation_of_a_ring_gives_the_same_region() -> None:
    points = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.3), (0.0, 0.3)]
    for ring in (points, points[::-1]):
        region = Region.polygon(ring)
        assert region.area == pytest.approx(0.12)
        assert Region.polygon(region.ring).area == pytest.approx(0.12)
        assert sorted(map(tuple, region.ring.tolist())) == sorted(points)


def test_points_on_a_straight_run_are_no_corners_even_when_a_micrometre_off() -> None:
    noisy = [(0.0, 0.0), (0.1, 1e-6), (0.2, -1e-6), (0.4, 0.0), (0.4, 0.3), (0.2, 0.3 + 1e-6), (0.0, 0.3), (0.0, 0.15)]
    assert len(Region.polygon(noisy).ring) == 4


def test_the_length_is_the_longer_side_of_the_smallest_rectangle_round_it_however_it_lies() -> None:
    for angle in (0.0, 0.3, math.pi / 4, 2.0):
        assert rectangle(0.3, 0.8).moved(Isometry.rotation(angle)).length == pytest.approx(0.8, abs=1e-5)


def test_a_union_is_the_same_whether_or_not_parts_of_it_lie_within_the_largest() -> None:
    rng = random.Random(1)
    for _ in range(40):
        large, *inner = (rectangle(0.5 * share, 0.4 * share) for share in (1.0, 0.2, 0.5, 0.9))
        beside = rectangle(0.4, 0.2).moved(Isometry.rotation(1.0, rng.uniform(-0.4, 0.4), 0.0))
        for parts in ([*inner, large, beside], [*inner, large]):
            rng.shuffle(parts)
            whole = shapely.union_all([part.shape for part in parts])
            assert Region.union(parts).area == pytest.approx(shapely.area(whole), abs=1e-5)


def test_a_segment_is_within_to_the_tolerance() -> None:
    square = Region.polygon([(0.0, 0.0), (0.3, 0.0), (0.3, 0.3), (0.0, 0.3)])
    for off_m, is_within in ((0.0, True), (0.5 * LENGTH_M, True), (3.0 * LENGTH_M, False)):
        assert square.contains_segment(Segment((0.0, -off_m), (0.3, -off_m))) == is_within
    assert square.contains_segment(Segment((0.1, 0.1), (0.2, 0.25)))
    assert not square.contains_segment(Segment((0.1, 0.1), (0.2, 0.35)))


def test_the_gaps_from_a_point_are_nothing_inside() -> None:
    regions = [rectangle(0.2, 0.2), rectangle(0.2, 0.2).moved(Isometry.rotation(0.0, 0.5, 0.0))]
    assert Region.gaps(regions, regions[0].inner_point)[0] == 0.0
    assert Region.gaps(regions, (0.1, 0.1)) == pytest.approx([0.0, regions[1].bounds[0] - 0.1])
    assert len(Region.gaps([], (0.0, 0.0))) == 0


def test_both_sides_of_a_line_add_up_to_the_whole() -> None:
    rng = random.Random(0)
    for _ in range(40):
        region = Region.polygon(star(rng, 9))
        angle = rng.uniform(0.0, math.tau)
        line = Segment((0.0, 0.0), (math.cos(angle), math.sin(angle)))
        if not region.shape.is_valid:
            continue
        left, right = region.parted_by(line)
        # The cut may lie on the micrometre grid beside the line: at most 1 m times 1 um of area.
        assert left.area + right.area == pytest.approx(region.area, abs=1e-6)
        assert left.intersection(right).is_sliver
        assert np.all(line.left_distances(left.coordinates) >= -2e-6)


def test_the_two_sides_of_a_cut_lose_no_area_and_fit_together_again() -> None:
    rng = random.Random(4)
    for _ in range(40):
        region = Region.polygon(star(rng, 9))
        if not region.shape.is_valid:
            continue
        angle = rng.uniform(0.0, math.tau)
        sides = region.parted_by(Segment((0.0, 0.0), (math.cos(angle), math.sin(angle))))
        # On a grid of a nanometre: at most 3 m of boundary, off by half of it.
        assert sum(side.area for side in sides) == pytest.approx(region.area, abs=2e-9)
        whole = Region.rejoined(sides)
        assert len(whole.parts) == 1 and not whole.shape.interiors
        assert is_same_region(whole, region, 1e-8)


def test_regions_that_only_touch_have_no_cloth_in_common() -> None:
    one = rectangle(0.1, 0.1)
    for other in (rectangle(0.1, 0.1, 0.1), rectangle(0.1, 0.1, 0.1, 0.1), rectangle(0.1, 0.1, 0.5)):
        assert one.intersection(other).pieces == () and one.intersection(other).area == 0.0
    # Where they touch there and overlap here, only the overlap is left: 0.05 x 0.1 m^2.
    hook = Region.polygon([(0.05, 0), (0.3, 0), (0.3, 0.3), (0, 0.3), (0, 0.1), (0.02, 0.1), (0.02, 0.2), (0.05, 0.2)])
    assert one.intersection(hook).area == pytest.approx(0.005)
    assert one.intersection(hook).shape.geom_type == "Polygon"


def test_parts_are_pieces_or_slivers() -> None:
    # 0.1 x 0.1 m^2 is cloth, 3 x 3 mm^2 is not.
    both = Region(shapely.MultiPolygon([shapely.box(0, 0, 0.1, 0.1), shapely.box(0.5, 0.0, 0.503, 0.003)]))
    assert [round(p.area, 6) for p in both.parts] == [0.01, 9e-6]
    assert [round(p.area, 6) for p in both.pieces] == [0.01]
    assert [round(p.area, 6) for p in both.slivers] == [9e-6]


def test_a_stretch_within_a_hair_of_the_boundary_does_not_run_inside() -> None:
    towel = rectangle(0.4, 0.3)
    assert towel.runs_inside(Segment((0.1, 0.0), (0.1, 0.1)))
    assert not towel.runs_inside(Segment((0.1, 1e-5), (0.3, 1e-5)))
    assert not towel.runs_inside(Segment((0.1, 0.0), (0.1, 1e-5)))
    assert not towel.runs_inside(Segment((0.5, 0.0), (0.5, 0.1)))


def test_a_line_across_a_moved_region_runs_inside_however_it_is_turned() -> None:
    # GEOS fills the grown border of some shapes on the grid: of these, of some 15 in 100.
    towel = rectangle(0.4, 0.3)
    for turn_rad in np.linspace(0.0, math.pi, 60):
        turned = Isometry.rotation(turn_rad, 0.1, -0.2)
        lying = towel.moved(turned)
        for y, is_inside in ((0.1, True), (0.0, False)):
            line = Segment(turned.apply_point((0.0, y)), turned.apply_point((0.4, y)))
            assert lying.runs_inside(line) == is_inside


def test_all_points_of_a_ring_are_kept_where_they_are_asked_for() -> None:
    straight = Region.polygon([(0.0, 0.0), (0.2, 0.0), (0.4, 0.0), (0.4, 0.3), (0.0, 0.3)])
    assert len(straight.ring) == 4
    assert straight.whole_ring.tolist() == [[0.0, 0.0], [0.2, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]]


def test_moving_keeps_the_area_and_moving_back_the_region() -> None:
    rng = random.Random(1)
    for _ in range(40):
        region = Region.polygon(star(rng, 8))
        over = Isometry.reflection(Segment((0.1, 0.2), (rng.uniform(0.2, 1.0), rng.uniform(-1.0, 1.0))))
        assert region.moved(over).area == pytest.approx(region.area, abs=1e-5)
        assert is_same_region(region.moved(over).moved(over.inverse), region, 1e-5)


def test_a_union_closes_a_hairline_crack_but_not_a_gap() -> None:
    left = rectangle(0.2, 0.3)
    touching = Region.union([left, rectangle(0.2, 0.3, 0.2 + 2e-6)])
    assert len(touching.rings) == 1 and len(touching.ring) == 4
    assert len(Region.union([left, rectangle(0.2, 0.3, 0.201)]).rings) == 2


def test_a_union_closes_a_hole_no_wider_than_a_hair_and_keeps_others() -> None:
    frame = rectangle(0.4, 0.4).difference(rectangle(0.1, 0.1, 0.15, 0.15))
    filled = Region.union([frame, rectangle(0.1 - 5e-6, 0.1, 0.15, 0.15)])
    assert not filled.shape.interiors and filled.area == pytest.approx(0.16, abs=1e-9)
    # A triangle 7 mm wide inside.
    hole = Region.polygon([(0.02, 0.12), (0.150453, 0.22958), (0.143123, 0.243123)])
    sides = rectangle(0.4, 0.4).difference(hole).parted_by(Segment((0.1, 0.0), (0.1, 0.4)))
    assert Region.union(sides).area == pytest.approx(0.16 - hole.area, abs=1e-6)


def test_a_crack_that_narrows_to_a_corner_of_both_sides_is_closed() -> None:
    # From 0.12 along the crack 10 um at its mouth to nothing: what lies between the two sides has a tip without area.
    left = Region.polygon([(0.0, 0.0), (0.12, 0.23), (-0.2, 0.1)]).moved(Isometry())
    right = Region.polygon([(0.0, 0.0), (0.3, 0.1), (0.12001, 0.230002)]).moved(Isometry())
    whole = Region.union([left, right])
    assert len(whole.parts) == 1 and not whole.shape.interiors
    # (0.12 x 0.1 + 0.23 x 0.2) / 2 and (0.3 x 0.230002 - 0.1 x 0.12001) / 2.
    assert whole.area == pytest.approx(0.029 + 0.0284998, abs=2e-6)


def test_parts_that_meet_in_a_point_only_stay_two() -> None:
    assert len(Region.union([rectangle(0.1, 0.1), rectangle(0.1, 0.1, 0.1, 0.1)]).parts) == 2
    assert len(Region.union([rectangle(0.1, 0.1), rectangle(0.1, 0.1, 0.1 + 3e-6, 0.1 - 2e-5)]).parts) == 2
    assert len(Region.union([rectangle(0.1, 0.1), rectangle(0.1, 0.1, 0.1 + 3e-6, 0.05)]).parts) == 1


def test_a_union_never_loses_a_part() -> None:
    here = Region.polygon([(0.0, 0.0), (0.1, 0.0), (0.0, 0.1)])
    there = Region.polygon([(1.145958, -0.055778), (1.066005, 0.459022), (1.39205, -0.364412)])
    # The second is as a layer is that has been moved: on the micrometre grid. 0.005 + 0.0510 m^2.
    both = Region.union([here, there.moved(Isometry())])
    assert both.area == pytest.approx(here.area + there.area, abs=1e-5)


def test_unions_of_random_parts_far_apart_add_up() -> None:
    rng = random.Random(3)
    for _ in range(300):
        one, other = Region.polygon(star(rng, 4)), Region.polygon(star(rng, 4))
        if not (one.shape.is_valid and other.shape.is_valid):
            continue
        one, other = one.moved(Isometry()), other.moved(Isometry.rotation(rng.uniform(0.0, 6.0), 2.0))
        assert Region.union([one, other]).area == pytest.approx(one.area + other.area, abs=1e-4)


def test_the_bisector_at_a_corner_halves_its_angle_and_on_an_edge_stands_upright() -> None:
    region = rectangle(0.4, 0.3)
    assert region.inward_bisector((0.0, 0.0)) == pytest.approx((math.sqrt(0.5), math.sqrt(0.5)))
    assert region.inward_bisector((0.2, 0.3)) == pytest.approx((0.0, -1.0))
    assert region.inward_bisector((0.2, 0.2)) is None


def test_the_bisector_of_a_reflex_corner_leads_into_the_cloth() -> None:
    # An L: at the inner corner (0.2, 0.2) cloth fills all but the quarter towards up and right.
    ell = Region.polygon([(0.0, 0.0), (0.4, 0.0), (0.4, 0.2), (0.2, 0.2), (0.2, 0.4), (0.0, 0.4)])
    assert ell.inward_bisector((0.2, 0.2)) == pytest.approx((-math.sqrt(0.5), -math.sqrt(0.5)))


def test_a_segment_along_the_boundary_counts_as_inside_and_one_across_a_notch_does_not() -> None:
    ell = Region.polygon([(0.0, 0.0), (0.4, 0.0), (0.4, 0.2), (0.2, 0.2), (0.2, 0.4), (0.0, 0.4)])
    assert ell.contains_segment(Segment((0.0, 0.0), (0.4, 0.0)))
    assert ell.contains_segment(Segment((0.1, 0.0), (0.1, 0.4)))
    assert not ell.contains_segment(Segment((0.4, 0.2), (0.2, 0.4)))


def test_the_hull_spans_all_parts() -> None:
    both = Region.union([rectangle(0.1, 0.1), rectangle(0.1, 0.1, 0.5)])
    assert sorted(map(tuple, both.hull.tolist())) == [(0.0, 0.0), (0.0, 0.1), (0.6, 0.0), (0.6, 0.1)]


def test_triangles_cover_the_region_and_run_counter_clockwise() -> None:
    rng = random.Random(2)
    for _ in range(20):
        region = Region.polygon(star(rng, 7))
        if not region.shape.is_valid:
            continue
        a, b, c = (region.triangles[:, i] for i in range(3))
        doubled = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
        assert np.all(doubled > 0.0)
        assert doubled.sum() / 2 == pytest.approx(region.area, abs=1e-9)


def test_the_nearest_boundary_point_of_an_inner_point_is_on_the_nearest_edge() -> None:
    found = rectangle(0.4, 0.3).nearest_boundary_points(np.array([[0.2, 0.25], [0.39, 0.1]]))
    assert found == pytest.approx(np.array([[0.2, 0.3], [0.4, 0.1]]))


def test_all_boundary_points_that_are_equally_near_are_found() -> None:
    # The middle of a strip 0.2 m high is as near to its lower as to its upper edge; 1 mm higher it is not.
    strip = rectangle(0.8, 0.2)
    both = strip.all_nearest_boundary_points(np.array([[0.4, 0.1], [0.3, 0.101]]))
    assert both == pytest.approx(np.array([[0.4, 0.0], [0.4, 0.2], [0.3, 0.2]]))


def test_the_boundary_of_a_hole_is_boundary_too() -> None:
    ring = Region.polygon(rectangle(0.4, 0.4).ring).difference(rectangle(0.1, 0.1, 0.15, 0.15))
    found = ring.all_nearest_boundary_points(np.array([[0.16, 0.2]]))
    assert found == pytest.approx(np.array([[0.15, 0.2]]))


def test_a_segment_touches_a_region_if_any_point_of_it_is_there() -> None:
    # The unit square: across it, inside it, with an end on its edge, along its edge, beside it by a micrometre (the
    # tolerance) and by a millimetre, and past its corner.
    segments = [
        ((-1.0, 0.5), (2.0, 0.5)),
        ((0.2, 0.2), (0.3, 0.4)),
        ((1.0, 0.5), (2.0, 0.5)),
        ((0.0, 1.0), (1.0, 1.0)),
        ((1.0 + 0.9 * LENGTH_M, 0.0), (1.0 + 0.9 * LENGTH_M, 1.0)),
        ((1.001, 0.0), (1.001, 1.0)),
        ((0.5, 1.6), (1.6, 0.5)),
    ]
    found = rectangle(1.0, 1.0).touches(np.array(segments))
    assert found.tolist() == [True, True, True, True, True, False, False]


def test_an_evened_region_has_no_narrow_teeth_and_no_narrow_notches_and_keeps_its_wide_parts() -> None:
    comb = Region.union([rectangle(1.0, 0.5), *(rectangle(0.03, 0.04, 0.1 * n, 0.5) for n in range(9))])
    even = comb.difference(rectangle(0.01, 0.2, 0.5, 0.0)).evened(notch_m=0.04, fringe_m=0.1)
    # The teeth were 4 cm high; what is left of them are the fillets at their feet. Outer corners are rounded by 5 cm.
    assert even.bounds == pytest.approx((0.0, 0.0, 1.0, 0.5), abs=0.01)
    assert even.area == pytest.approx(0.5 - (4.0 - math.pi) * 0.05**2, abs=0.005)
    assert even.contains((0.505, 0.1))  # the notch
    wide = Region.union([rectangle(1.0, 0.5), rectangle(0.3, 0.2, 0.2, 0.5)]).evened(notch_m=0.04, fringe_m=0.1)
    assert wide.contains((0.35, 0.69))
