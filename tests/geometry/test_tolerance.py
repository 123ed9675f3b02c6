"""The tolerance of equality."""

from planner.geometry.tolerance import AREA_M2, GRID_M, LENGTH_M, grid_key


def test_the_grid_is_ten_times_finer_than_what_counts_as_one_place():
    assert round(LENGTH_M / GRID_M) == 10
    assert AREA_M2 == 1e-5


def test_numbers_that_differ_by_rounding_have_one_key():
    assert grid_key(0.1 + 0.2) == grid_key(0.3) == 30_000
