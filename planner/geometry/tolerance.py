"""The one place where "equal" is made precise.

Cloth is measured in metres, so a micrometre is far below anything that matters and far above the
rounding of double precision at the size of a room. Every comparison of places in Pleat rests on
these numbers; no other module has its own.
"""

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


def grid_key(value: float) -> int:
    """The number of `LENGTH_M` steps in a value, for use in hashable keys (m or rad)."""
    return round(value / LENGTH_M)
