"""What counts as equal."""

from planner.geometry.tolerance import AREA_M2, GRID_M, LENGTH_M, grid_key, is_same_length


def test_the_grid_is_ten_times_finer_than_what_counts_as_one_place():
    assert round(LENGTH_M / GRID_M) == 10
    assert AREA_M2 == 1e-5


def test_places_a_hundredth_of_a_millimetre_apart_are_the_same():
    assert is_same_length(0.3, 0.3 + 0.9e-5)
    assert not is_same_length(0.3, 0.3 + 1.1e-5)


def test_numbers_that_differ_by_rounding_have_one_key():
    assert grid_key(0.1 + 0.2) == grid_key(0.3) == 30_000
