"""Chords: the stretches of a line within a region."""

import pytest

from planner.geometry.chord import chords, nearest_chord
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from tests.builders import rectangle

# A U: two legs of 0.1 x 0.3 m that hang together at the bottom.
U = Region.polygon([(0, 0), (0.3, 0), (0.3, 0.4), (0.2, 0.4), (0.2, 0.1), (0.1, 0.1), (0.1, 0.4), (0, 0.4)])
# A body 0.2 m wide with a sleeve on its left, 0.1 m high; the body's left side goes on below it.
SLEEVE = Region.polygon([(0, 0), (0.2, 0), (0.2, 0.4), (-0.1, 0.4), (-0.1, 0.3), (0, 0.3)])


def ends(chord: Segment | None) -> list[object]:
    assert chord is not None
    return [pytest.approx(chord.start, abs=1e-9), pytest.approx(chord.end, abs=1e-9)]


def test_the_ends_slide_along_the_line_to_the_boundary_in_the_lines_direction() -> None:
    up = nearest_chord(rectangle(0.4, 0.3), Segment((0.1, 0.05), (0.1, 0.2)))
    assert ends(up) == [(0.1, 0.0), (0.1, 0.3)]
    down = nearest_chord(rectangle(0.4, 0.3), Segment((0.1, 0.35), (0.1, -0.2)))
    assert ends(down) == [(0.1, 0.3), (0.1, 0.0)]


def test_a_line_through_both_legs_has_a_chord_in_each_and_the_nearest_is_the_one_drawn_on() -> None:
    both = chords(U, Segment((-1.0, 0.3), (1.0, 0.3)))
    assert [ends(chord) for chord in both] == [[(0.0, 0.3), (0.1, 0.3)], [(0.2, 0.3), (0.3, 0.3)]]
    assert ends(nearest_chord(U, Segment((0.22, 0.3), (0.35, 0.3)))) == [(0.2, 0.3), (0.3, 0.3)]


def test_beside_all_cloth_the_chord_nearest_to_the_line_is_taken() -> None:
    assert ends(nearest_chord(U, Segment((0.5, 0.3), (0.6, 0.3)))) == [(0.2, 0.3), (0.3, 0.3)]


def test_a_line_that_goes_on_along_the_boundary_keeps_the_end_that_is_meant() -> None:
    armhole = Segment((0.0, 0.3), (0.0, 0.4))
    assert ends(nearest_chord(SLEEVE, armhole)) == [(0.0, 0.3), (0.0, 0.4)]
    assert [ends(chord) for chord in chords(SLEEVE, armhole)] == [[(0.0, 0.3), (0.0, 0.4)]]


def test_a_line_that_misses_the_cloth_or_only_follows_its_edge_has_no_chord() -> None:
    assert nearest_chord(U, Segment((0.0, 0.5), (1.0, 0.5))) is None
    assert nearest_chord(rectangle(0.4, 0.3), Segment((0.0, 0.3), (0.4, 0.3))) is None
    assert chords(rectangle(0.4, 0.3), Segment((0.0, 0.3), (0.4, 0.3))) == ()


def test_a_hole_parts_a_chord() -> None:
    ring = rectangle(0.3, 0.3).difference(rectangle(0.1, 0.1, 0.1, 0.1))
    both = chords(ring, Segment((0.0, 0.15), (0.3, 0.15)))
    assert [ends(chord) for chord in both] == [[(0.0, 0.15), (0.1, 0.15)], [(0.2, 0.15), (0.3, 0.15)]]
