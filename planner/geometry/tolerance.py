"""The one place where "equal" is made precise.

Cloth is measured in metres, so a micrometre is far below anything that matters and far above the
rounding of double precision at the size of a room. Every comparison of places in Pleat rests on
these numbers; no other module has its own.
"""

import math
from typing import Final

GRID_M: Final = 1e-6
"""The precision grid on which polygons live after every cut and reflection (m)."""

CUT_GRID_M: Final = 1e-9
"""The finer grid on which cuts are made: pieces of cloth are cut again and again, and no area may be lost by it (m)."""

LENGTH_M: Final = 1e-5
"""Two points nearer than this are one point (m): ten steps of the grid."""

AREA_M2: Final = 1e-5
"""A piece of cloth smaller than this is a sliver, dropped when it arises (m^2)."""

TIME_S: Final = 1e-9
"""Two durations nearer than this are the same (s)."""

DECIMALS: Final = 9
"""Those of the finest of these (m, s, rad): what is written to be read by people has no more of them."""

ANGLE_RAD: Final = 1e-9
"""Two angles nearer than this are the same (rad), where no length gives a better measure."""

EDGE_RAD: Final = 1e-4
"""Two edges whose directions differ by less have the same: a few centimetres long, with ends on the grid (rad)."""

SNAP_M: Final = 5e-3
"""A fold's end point may lie this far from the silhouette's boundary and is put onto it (m)."""


SORTING_M: Final = 7.3e-4
"""The grid on which places are put in order: no length that people draw lies half-way between two of its lines (m)."""

HALF_WAY: Final = 1e-3
"""A number this near to the middle between two whole ones is half-way."""


def nearest_whole(value: float) -> int:
    """Return the nearest whole number; half-way between two, to the tolerance, the one nearer to zero.

    Headings of 45 degrees and the like lie exactly half-way, and a rounding error must not decide.
    """
    return round(math.copysign(math.ceil(abs(value) - 0.5 - HALF_WAY), value))


def grid_key(value: float) -> int:
    """The number of `LENGTH_M` steps in a value, for use in hashable keys (m or rad)."""
    return round(value / LENGTH_M)
