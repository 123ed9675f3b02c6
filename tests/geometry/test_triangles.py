"""Triangles cut along lines."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from planner.geometry.triangles import creased, fanned, parted, striped

# An L of 0.4 x 0.4 m, counter-clockwise.
ELL = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.1), (0.1, 0.1), (0.1, 0.4), (0.0, 0.4)]
ACROSS = Segment((0.0, 0.3), (0.3, 0.0))

places = st.tuples(st.integers(-100, 500), st.integers(-100, 500)).map(lambda cell: (cell[0] / 1e3, cell[1] / 1e3))
lines = st.tuples(places, places).filter(lambda ends: ends[0] != ends[1]).map(lambda ends: Segment(*ends))


def areas(triangles: np.ndarray) -> np.ndarray:
    """Return the areas of triangles, positive if counter-clockwise (m^2)."""
    a, b = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return np.asarray((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2)


def lone_sides(triangles: np.ndarray) -> set[tuple[bytes, bytes]]:
    """Return the sides that no other triangle has in reverse, compared to the last digit."""
    sides = {(t[i].tobytes(), t[(i + 1) % 3].tobytes()) for t in triangles for i in range(3)}
    return {(start, end) for start, end in sides if (end, start) not in sides}


@given(lines)
def test_each_side_is_as_large_as_what_lies_there_and_turned_as_before(line: Segment) -> None:
    cloth = Region.polygon(ELL)
    sides = zip(parted(cloth.triangles, line), cloth.parted_by(line), (line, line.reversed), strict=True)
    for (part, _), region, there in sides:
        assert areas(part).sum() == pytest.approx(region.area, abs=2 * LENGTH_M)
        assert np.all(areas(part) > 0.0)
        assert np.all(there.left_distances(part) >= -LENGTH_M)


@given(lines)
def test_neighbours_on_one_side_share_the_ends_of_their_cuts(line: Segment) -> None:
    triangles = Region.polygon(ELL).triangles
    for part, _ in parted(triangles, line):
        for start, end in lone_sides(part):
            a, b = np.frombuffer(start), np.frombuffer(end)
            middle = np.array([(a + b) / 2])
            is_on_cut = np.abs(line.left_distances(np.array([a, b]))).max() <= 2 * LENGTH_M
            rim = Region.polygon(ELL).boundary_distance(tuple(middle[0]))
            assert is_on_cut or rim <= LENGTH_M, "no side within the cloth is anybody's alone"


def test_each_part_tells_of_which_triangle_it_is() -> None:
    triangles = Region.polygon(ELL).triangles
    sizes = np.zeros(len(triangles))
    for part, sources in parted(triangles, ACROSS):
        np.add.at(sizes, sources, areas(part))
    np.testing.assert_allclose(sizes, areas(triangles))


def test_a_cut_through_a_corner_halves_the_triangle_and_no_more() -> None:
    triangle = np.array([[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]])
    (left, _), (right, _) = parted(triangle, Segment((0.0, 0.0), (1.0, 1.0)))
    assert len(left) == len(right) == 1
    np.testing.assert_allclose([*areas(left), *areas(right)], [0.25, 0.25])


def test_what_touches_a_line_within_the_tolerance_is_not_cut() -> None:
    triangle = np.array([[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]])
    (left, _), (right, _) = parted(triangle, Segment((0.0, LENGTH_M / 2), (1.0, LENGTH_M / 2)))
    assert np.array_equal(left, triangle) and len(right) == 0


def test_creases_leave_nothing_out() -> None:
    triangles = Region.polygon(ELL).triangles
    cut, sources = creased(triangles, [ACROSS, Segment((0.05, 0.0), (0.05, 1.0))])
    assert len(cut) > len(triangles)
    assert areas(cut).sum() == pytest.approx(0.07)
    np.testing.assert_allclose(np.bincount(sources, areas(cut)), areas(triangles))
    for line in (ACROSS, Segment((0.05, 0.0), (0.05, 1.0))):
        distances = line.left_distances(cut)
        assert np.all((distances.min(axis=1) >= -LENGTH_M) | (distances.max(axis=1) <= LENGTH_M))


def test_stripes_are_what_one_cut_after_the_other_leaves() -> None:
    triangles = Region.polygon(ELL).triangles
    places = np.array([-0.05, 0.0, 0.01, 0.12])
    cut, sources = striped(triangles, ACROSS, places)
    np.testing.assert_allclose(np.bincount(sources, areas(cut)), areas(triangles))
    distances = ACROSS.left_distances(cut)
    for place in places:
        assert np.all((distances.min(axis=1) >= place - LENGTH_M) | (distances.max(axis=1) <= place + LENGTH_M))
    assert np.all(areas(cut) > 0.0)


def test_what_is_cut_on_one_side_of_a_line_only_meets_fans_on_the_other() -> None:
    square = np.array([[[0.0, 0.0], [0.3, 0.0], [0.3, 0.3]], [[0.0, 0.0], [0.3, 0.3], [0.0, 0.3]]])
    line, columns = Segment((0.0, 0.1), (1.0, 0.1)), np.array([0.05, 0.1, 0.2])
    (above, _), (below, _) = parted(square, line)
    cut, _ = striped(above, Segment((0.0, 0.1), (0.0, 1.0)), -columns[::-1])
    fans, sources = fanned(below, line, columns)
    np.testing.assert_allclose(np.bincount(sources, areas(fans)), areas(below))
    sides = np.round(np.concatenate([cut, fans]) / LENGTH_M)
    rim = {0.0, np.round(0.3 / LENGTH_M)}
    for start, end in lone_sides(sides + 0.0):
        assert any(x == u and x in rim for x, u in zip(np.frombuffer(start), np.frombuffer(end), strict=True))
