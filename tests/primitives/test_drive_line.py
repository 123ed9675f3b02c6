"""The base's line while hands follow a path: within reach, no further than the legs, and as even as can be."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.geometry.driving import IMPOSSIBLE
from planner.primitives.base_legs import travel
from planner.primitives.fold_motion import Corner, drive_line
from tests.primitives.test_base_legs import random_strips, strip_of

NEAR = 1e-6


def stand_at(line: tuple[Corner, ...], sweep: float) -> float:
    return float(np.interp(sweep, [corner.sweep for corner in line], [corner.stand for corner in line]))


def test_a_base_with_room_all_the_way_drives_straight_from_the_first_standoff_to_the_last() -> None:
    line = drive_line(strip_of(0b1111, 0b1111, 0b1111), (0.0, 0.5, 2.0), 0, 3, 4)
    assert line == (Corner(0.0, 0), Corner(2.0, 3))


def test_the_line_bends_only_where_reach_ends() -> None:
    # At the sweep 1 the standoff 1 is the furthest within reach, so the line has slope 1 before it and 2 after it.
    line = drive_line(strip_of(0b0011, 0b0011, 0b1111, 0b1111), (0.0, 1.0, 1.0, 2.0), 0, 3, 4)
    assert line == (Corner(0.0, 0), Corner(1.0, 1), Corner(2.0, 3))


def test_where_no_standoff_suits_both_the_way_there_and_the_way_on_the_base_drives_while_the_hands_rest() -> None:
    line = drive_line(strip_of(0b001, 0b111, 0b100), (0.0, 1.0, 2.0), 0, 2, 3)
    assert line == (Corner(0.0, 0), Corner(1.0, 0), Corner(1.0, 2), Corner(2.0, 2))


@given(st.integers(0, 100_000))
def test_the_line_stays_between_standoffs_within_reach_and_travels_as_far_as_the_legs(seed: int) -> None:
    strips, count = random_strips(seed)
    strip = np.append(strips[0], strips[0][-1])
    sweeps = np.linspace(0.0, 2.0, len(strip)).tolist()
    (steps,) = travel(strip[None], count)
    for start, end in zip(*np.nonzero(steps < IMPOSSIBLE), strict=True):
        line = drive_line(strip, sweeps, int(start), int(end), count)
        assert (line[0].stand, line[-1].stand) == (start, end)
        assert sum(abs(b.stand - a.stand) for a, b in pairwise(line)) == pytest.approx(steps[start, end])
        for number, (before, after) in enumerate(pairwise(sweeps)):
            mask = int(strip[number] & strip[number + 1])
            for share in (NEAR, 0.5, 1.0 - NEAR):
                stand = stand_at(line, before + share * (after - before))
                assert all(mask >> int(j) & 1 for j in (np.floor(stand + 2 * NEAR), np.ceil(stand - 2 * NEAR)))
