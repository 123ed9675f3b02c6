"""Tells a cut line from the seam line that runs along inside it.

Sewing patterns have both: cloth is cut along the outer one, and what lies between them is turned in when it is sewn. So
a closed line all of which is as far from the largest one is no hole in the cloth.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from planner.geometry.arrangement import away_from, perimeter, signed_area
from planner.geometry.pose import FloatArray

Line: TypeAlias = Literal["seam", "cut"]

WIDEST_SHARE = 0.1
"""The widest allowance, as a share of the shorter side of what is cut."""

_EVEN_SHARE = 0.15
"""The largest deviation of the distance, and of the area between both lines, as a share of each."""

_PIECES = 4
"""Pieces into which each edge of the inner line is cut to look how far it is from the outer one."""


@dataclass(frozen=True, slots=True)
class Allowance:
    """A seam allowance that a drawing has.

    Attributes:
        line: the line that was taken as the outline.
        width_m: the distance between both lines (m).
    """

    line: Line
    width_m: float


def allowance_m(cut: FloatArray, inner: FloatArray) -> float | None:
    """Return the distance of a closed line inside another (m); None if that distance varies.

    Args:
        cut: the corners of the outer line, shape (n, 2).
        inner: those of the other one, shape (m, 2).
    """
    away = away_from(_along(inner), cut)
    width = float(np.median(away))
    if not 0.0 < width <= WIDEST_SHARE * float(np.ptp(cut, axis=0).min()):
        return None
    if float(np.abs(away - width).max()) > _EVEN_SHARE * width:
        return None
    between = abs(signed_area(cut)) - abs(signed_area(inner))
    strip = width * (perimeter(cut) + perimeter(inner)) / 2.0
    return width if abs(between - strip) <= _EVEN_SHARE * strip else None


def seam_line(rings: Sequence[FloatArray]) -> tuple[int, float] | None:
    """Return the index of the first ring's seam line, rings sorted by size, and its allowance (m); else None.

    None too if that ring has another one inside it as evenly: three lines inside each other are graded sizes.
    """
    widths = ((number, allowance_m(rings[0], ring)) for number, ring in enumerate(rings[1:], start=1))
    found = next(((number, width) for number, width in widths if width is not None), None)
    if found is None or any(allowance_m(rings[found[0]], ring) is not None for ring in rings[found[0] + 1 :]):
        return None
    return found


def _along(ring: FloatArray) -> FloatArray:
    """Return points along a ring, evenly within each edge."""
    following = np.roll(ring, -1, axis=0)
    return np.concatenate([ring + (following - ring) * piece / _PIECES for piece in range(_PIECES)])
