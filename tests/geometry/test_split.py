"""Cutting along a segment separates the cloth there, and nowhere else along its line."""

import random

import pytest

from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.split import Cut, cut_like, split_along
from tests.builders import is_same_region, rectangle, star
from tests.required import required

# A vest with two arms of 0.1 x 0.1 m on one level, left and right of a body 0.2 m wide.
SLEEVES = Region.polygon([(0, 0), (0.2, 0), (0.2, 0.3), (0.3, 0.3), (0.3, 0.4), (-0.1, 0.4), (-0.1, 0.3), (0, 0.3)])
# A U: two legs of 0.1 x 0.3 m that hang together at the bottom.
U = Region.polygon([(0, 0), (0.3, 0), (0.3, 0.4), (0.2, 0.4), (0.2, 0.1), (0.1, 0.1), (0.1, 0.4), (0, 0.4)])


def test_a_cut_across_a_rectangle_leaves_its_two_sides() -> None:
    left, right = required(split_along(rectangle(0.4, 0.3), Segment((0.1, 0.0), (0.1, 0.3))))
    assert is_same_region(left, rectangle(0.1, 0.3))
    assert is_same_region(right, rectangle(0.3, 0.3, 0.1))


def test_reversing_the_cut_exchanges_the_parts() -> None:
    line = Segment((0.1, 0.0), (0.1, 0.3))
    left, right = required(split_along(rectangle(0.4, 0.3), line))
    swapped_left, swapped_right = required(split_along(rectangle(0.4, 0.3), line.reversed))
    assert is_same_region(left, swapped_right) and is_same_region(right, swapped_left)


def test_cutting_one_leg_of_a_u_leaves_the_other_leg_alone_though_the_line_goes_on_through_it() -> None:
    left, right = required(split_along(U, Segment((0.0, 0.25), (0.1, 0.25))))
    assert is_same_region(left, rectangle(0.1, 0.15, 0.0, 0.25))
    assert right.area == pytest.approx(U.area - 0.015)


def test_cutting_one_sleeve_leaves_the_other_sleeve_alone() -> None:
    left, _ = required(split_along(SLEEVES, Segment((0.0, 0.3), (0.0, 0.4))))
    assert is_same_region(left, rectangle(0.1, 0.1, -0.1, 0.3))


def test_a_cut_that_goes_round_one_end_parts_nothing() -> None:
    # Half-way into the cloth: both sides hang together round the inner end.
    assert split_along(rectangle(0.4, 0.3), Segment((0.1, 0.0), (0.1, 0.15))) is None


def test_a_cut_along_the_outline_leaves_one_side_empty() -> None:
    left, right = required(split_along(rectangle(0.4, 0.3), Segment((0.0, 0.0), (0.4, 0.0))))
    assert is_same_region(left, rectangle(0.4, 0.3)) and right.is_sliver


def test_a_sliver_beside_the_cut_is_dropped() -> None:
    # 0.02 mm beside the edge: 0.3 m x 0.02 mm = 6e-6 m^2 is no cloth.
    left, right = required(split_along(rectangle(0.4, 0.3), Segment((2e-5, 0.0), (2e-5, 0.3))))
    assert left.is_sliver
    assert right.area == pytest.approx(0.12, abs=1e-5)


def test_whatever_the_cut_nothing_is_lost() -> None:
    rng = random.Random(5)
    for _ in range(60):
        region = Region.polygon(star(rng, 8))
        if not region.shape.is_valid:
            continue
        ring = region.ring
        i, j = rng.sample(range(len(ring)), 2)
        line = Segment(tuple(ring[i].tolist()), tuple(ring[j].tolist()))
        parts = split_along(region, line) if region.contains_segment(line) else None
        if parts is not None:
            left, right = parts
            assert left.area + right.area == pytest.approx(region.area, abs=3e-5)
            assert left.intersection(right).is_sliver


def test_a_cut_that_ends_a_hair_before_the_edge_parts_the_cloth_even_where_it_meets_it_at_a_sharp_angle() -> None:
    # A line that falls by 1 in 100 ends 5 um above the lower edge: along the line that is 0.5 mm before it.
    left, right = required(split_along(rectangle(0.4, 0.3), Segment((0.3, 5e-6), (0.0, 0.003))))
    assert right.area == pytest.approx(0.12 - 0.3 * 0.003 / 2, abs=2e-6)
    assert left.area == pytest.approx(0.3 * 0.003 / 2, abs=2e-6)


def test_a_piece_is_cut_like_the_whole_only_where_the_whole_was() -> None:
    line = Segment((0.0, 0.25), (0.1, 0.25))
    moving, _ = required(split_along(U, line))
    cut = cut_like(U, line, moving.contains)
    assert [p.area for p in cut.moving] == pytest.approx([0.015])
    assert [p.area for p in cut.staying] == pytest.approx([U.area - 0.015])
    assert cut.slivers == ()


def test_a_piece_that_lies_on_one_side_altogether_is_not_cut() -> None:
    piece = rectangle(0.1, 0.1)
    assert cut_like(piece, Segment((0.0, 0.25), (0.1, 0.25)), lambda _: False) == Cut((), (piece,))
    assert cut_like(piece, Segment((0.0, 0.0), (0.1, 0.0)), lambda _: True) == Cut((piece,), ())


def test_a_cut_that_ends_a_hair_beside_a_corner_leaves_no_neck() -> None:
    """A sleeve at an armpit from which the line goes on into the body: a tenth of a micrometre aside it still parts."""
    armpit = (0.007071, 0.426071)
    body = Region.polygon([(0.0, 0.0), armpit, (-0.1, 0.42), (-0.1, 0.57), (0.0, 0.61), (0.4, 0.61), (0.4, 0.0)])
    for aside in (-1e-7, 0.0, 1e-7):
        parts = split_along(body, Segment((armpit[0] + aside, armpit[1] + aside), (0.0, 0.61)))
        assert parts is not None
        assert is_same_region(parts[0], Region.polygon([armpit, (0.0, 0.61), (-0.1, 0.57), (-0.1, 0.42)]))
