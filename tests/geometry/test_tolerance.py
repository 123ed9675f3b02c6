"""The tolerance of equality."""

import numpy as np
import pytest

from planner.geometry.tolerance import AREA_M2, GRID_M, LENGTH_M, grid_key, grid_keys
from planner.robots.place import in_steps


def test_the_grid_is_ten_times_finer_than_what_counts_as_one_place() -> None:
    assert round(LENGTH_M / GRID_M) == 10
    assert AREA_M2 == 1e-5


def test_numbers_that_differ_by_rounding_have_one_key() -> None:
    assert grid_key(0.1 + 0.2) == grid_key(0.3) == 30_000


@pytest.mark.parametrize("value", [0.109375, -0.109375, 0.000005, -0.000015])
def test_numbers_half_way_between_two_steps_have_one_key_whatever_the_rounding(value: float) -> None:
    around = np.asarray(value + 1e-15 * np.arange(-3, 4), dtype=np.float64)
    keys = [grid_key(one) for one in around.tolist()]
    assert len(set(keys)) == 1 and keys[0] > value / LENGTH_M
    assert grid_keys(around).tolist() == keys == [in_steps(one) for one in around.tolist()]
