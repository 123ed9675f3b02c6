"""The line along which the base drives while the hands follow a path: as even as reach allows.

Legs of least travel (`base_legs`) are stairs: the hands rest while the base drives from one standoff to the next, and
it stands while they go on. A base that drives them so stops at every stair. From one waypoint to the next it may as
well stand anywhere between two standoffs that both are within reach at both waypoints. These intervals are gates; the
string pulled tight through them is the line with the flattest slopes, and its travel is the least, as that of the
stairs is: a tight string makes no detour.
"""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.tolerance import ANGLE_RAD
from planner.primitives.base_legs import legs, stands_beside

_BESIDE = 1e-9
"""How far gates at the same sweep lie apart, so that a line that drives there has a slope."""


class Corner(NamedTuple):
    """A corner of a line, or one of its ends: a sweep of the path, and the standoff there in steps of the grid."""

    sweep: float
    stand: float


class _Gate(NamedTuple):
    """The lowest and the highest standoff at which a line may pass a sweep."""

    sweep: float
    low: float
    high: float

    def slopes(self, corner: Corner) -> tuple[float, float]:
        """Return the slopes of the lines from a corner to its ends."""
        away = max(self.sweep - corner.sweep, _BESIDE)
        return (self.low - corner.stand) / away, (self.high - corner.stand) / away


def drive_line(
    strip: NDArray[np.uint32], sweeps: Sequence[float], start: int, end: int, count: int
) -> tuple[Corner, ...]:
    """Return the corners of the evenest line of least travel, its ends included.

    Args:
        strip: bit masks of the standoffs within reach, shape (waypoints,); two or more.
        sweeps: the waypoints' sweeps, rising.
        start: the standoff at the first waypoint.
        end: the standoff at the last.
        count: the number of standoffs.

    Returns:
        Between two corners sweep and standoff change evenly; at equal sweeps the base drives while the hands rest.
    """
    masks, stands = strip.tolist(), legs(strip, start, end, count)
    rooms = [stands_beside(mask & after, stand) for (mask, after), stand in zip(pairwise(masks), stands, strict=False)]
    gates = [_Gate(sweeps[0], start, start)]
    for sweep, room, after in zip(sweeps, [None, *rooms], [*rooms, None], strict=True):
        gates += _gates(sweep, [(one[0], one[-1]) for one in (room, after) if one is not None])
    gates.append(_Gate(sweeps[-1], end, end))
    return _pulled_tight(gates)


def _gates(sweep: float, rooms: list[tuple[int, int]]) -> list[_Gate]:
    """Return the gate common to the rooms before and after a waypoint, or both, if the base must drive there."""
    low, high = max(low for low, _ in rooms), min(high for _, high in rooms)
    return [_Gate(sweep, low, high)] if low <= high else [_Gate(sweep, *room) for room in rooms]


def _pulled_tight(gates: Sequence[_Gate]) -> tuple[Corner, ...]:
    """Return the corners of the string from the first gate to the last, both of them points."""
    corners = [Corner(gates[0].sweep, gates[0].low)]
    at = 0
    while at < len(gates) - 1:
        at, corner = _next_bend(gates, at, corners[-1])
        corners.append(corner)
    return tuple(_without_idle(corners))


def _next_bend(gates: Sequence[_Gate], at: int, corner: Corner) -> tuple[int, Corner]:
    """Return the gate at which the string bends next after a corner in gate `at`, and the corner there."""
    least, most = -math.inf, math.inf
    lowest = highest = at
    for number in range(at + 1, len(gates)):
        low, high = gates[number].slopes(corner)
        if low > most:
            return highest, Corner(gates[highest].sweep, gates[highest].high)
        if high < least:
            return lowest, Corner(gates[lowest].sweep, gates[lowest].low)
        if low >= least:
            least, lowest = low, number
        if high <= most:
            most, highest = high, number
    return len(gates) - 1, Corner(gates[-1].sweep, gates[-1].low)


def _without_idle(corners: Sequence[Corner]) -> list[Corner]:
    """Return corners without those at which nothing has happened since the one before."""
    kept = [corners[0]]
    for corner in corners[1:]:
        if corner.sweep - kept[-1].sweep > ANGLE_RAD or abs(corner.stand - kept[-1].stand) > ANGLE_RAD:
            kept.append(corner)
    return kept
