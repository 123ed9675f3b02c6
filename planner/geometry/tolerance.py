"""The tolerances of the project: they define when two values are equal.

Cloth is measured in metres, so a micrometre is far below anything that matters and far above the rounding of double
precision at the size of a room. Every comparison of places in Pleat uses these numbers; no other module has its own.
"""

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

GRID_M: Final = 1e-6
"""Precision grid on which polygons live after every cut and reflection (m)."""

CUT_GRID_M: Final = 1e-9
"""Finer grid for cuts (m): pieces of cloth are cut again and again, and no area may be lost by it."""

LENGTH_M: Final = 1e-5
"""Distance below which two points are one point (m): ten steps of the grid."""

AREA_M2: Final = 1e-5
"""Area below which a piece of cloth is a sliver, dropped when it arises (m^2)."""

TIME_S: Final = 1e-9
"""Difference below which two durations are equal (s)."""

DECIMALS: Final = 9
"""Decimals of the finest of these tolerances (m, s, rad), the most that files for people have."""

ANGLE_RAD: Final = 1e-9
"""Difference below which two angles are equal (rad), where no length gives a better measure."""

EDGE_RAD: Final = 1e-4
"""Angle below which two edges have the same direction (rad): the precision of a few centimetres with ends on the grid.
"""

SNAP_M: Final = 5e-3
"""Greatest distance of a fold's end point from the silhouette's boundary, onto which it is put (m)."""


# An odd value, so that no length that people draw lies half-way between two of its lines.
SORTING_M: Final = 7.3e-4
"""Grid for sorting places (m)."""

HALF_WAY: Final = 1e-3
"""Distance from the middle between two whole numbers below which a number counts as half-way."""


def nearest_whole(value: float) -> int:
    """Return the nearest whole number; half-way between two, to the tolerance, the one nearer to zero.

    Headings of 45 degrees and the like lie exactly half-way, and a rounding error must not decide.
    """
    return round(math.copysign(math.ceil(abs(value) - 0.5 - HALF_WAY), value))


def grid_key(value: float) -> int:
    """Return the number of `LENGTH_M` steps in a value, for use in hashable keys (m or rad).

    Half-way between two, to the tolerance, the larger one: lengths that people draw, halved a few times, lie
    there, and a rounding error must not decide.
    """
    return math.floor(value / LENGTH_M + 0.5 + HALF_WAY)


def grid_keys(values: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return what `grid_key` does for each of some values."""
    return np.floor(values / LENGTH_M + 0.5 + HALF_WAY).astype(np.int64)
