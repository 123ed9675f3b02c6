"""A tool point on the grid, as an arm's shoulder sees it. Compiled."""

import math
from typing import NamedTuple

from planner.geometry.driving import STANDOFF_STEP_M
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import HALF_WAY, LENGTH_M
from planner.kernels import kernel

STANDOFF_STEP = round(STANDOFF_STEP_M / LENGTH_M)
"""Steps of `LENGTH_M` between neighbouring standoffs."""


class Place(NamedTuple):
    """A tool point, seen from the shoulder with the base at standoff 0, in steps of `LENGTH_M`."""

    x: int
    y: int
    z: int


@kernel
def in_steps(value: float) -> int:
    """Return a coordinate in steps of `LENGTH_M`, as `planner.geometry.tolerance.grid_key` does."""
    return math.floor(value / LENGTH_M + 0.5 + HALF_WAY)


@kernel
def place_of(point: FloatArray, shoulder: FloatArray) -> Place:
    """Return the place of a tool point, with point and shoulder in the base frame (m)."""
    return Place(
        in_steps(point[0]) - in_steps(shoulder[0]),
        in_steps(point[1]) - in_steps(shoulder[1]),
        in_steps(point[2]) - in_steps(shoulder[2]),
    )
