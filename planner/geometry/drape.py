"""Drape cloth over the edges of a table for drawing: bent round the edges, folded into an ear at the corners.

Planning takes cloth to be without thickness and stiffness: it turns down at the edge itself (`TableTop.over_edge`).
Drawn that way it looks like plates, and what lies beyond two edges at once would be squeezed to a line. So cloth is
drawn as it drapes: each layer goes round the edge on a circle about one axis, the upper layers further out, and then
hangs. Beyond a corner a quarter of the plane hangs from one point: it folds in the middle and sticks out. Lengths are
kept, so cloth hangs a few millimetres higher than in the plan.
"""

import math
from itertools import takewhile

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.segment import Segment
from planner.geometry.table import TableTop

BEND_M = 0.008
"""Radius of the bend below the lowest layer (m): smaller looks like a plate, larger hangs clear of the table."""

_BENT_AT_M = (0.0, 0.003, 0.006, 0.009, 0.012, 0.016, 0.024, 0.036, 0.054)
"""Distances beyond an edge at which cloth is cut, so that its flat pieces follow the bend (m)."""
_FAR_M = 100.0
"""Length by which a line is extended to cross any cloth (m)."""


def bends(top: TableTop, points: FloatArray, gap_m: float) -> tuple[Segment, ...]:
    """Return the lines of the unrolled plane along which cloth is cut, so that flat pieces can be draped.

    Args:
        top: the table top.
        points: the cloth's points, shape (..., 2), table frame (m).
        gap_m: how far off the table the topmost layer is drawn (m).
    """
    low, high = points.reshape(-1, 2).min(axis=0), points.reshape(-1, 2).max(axis=0)
    over = [
        (axis, side, edges[axis])
        for side, edges, reached in ((-1, top.low, low), (1, top.high, high))
        for axis in (0, 1)
        if side * (reached[axis] - edges[axis]) > 0.0
    ]
    beyond = bent_at(gap_m)
    lines = [_across(axis, place + side * by) for axis, side, place in over for by in beyond]
    corners = [(x, y, sx * sy) for ax, sx, x in over for ay, sy, y in over if (ax, ay) == (0, 1)]
    return (
        *lines,
        *(Segment((x - _FAR_M, y - turn * _FAR_M), (x + _FAR_M, y + turn * _FAR_M)) for x, y, turn in corners),
    )


def bent_at(gap_m: float) -> tuple[float, ...]:
    """Return how far beyond an edge the pieces of a bend meet (m), for a topmost layer `gap_m` off the table."""
    whole_m = math.pi / 2.0 * (BEND_M + gap_m)
    inside = tuple(takewhile(lambda by: by < whole_m, _BENT_AT_M))
    return (*inside, whole_m)


def draped(top: TableTop, points: FloatArray, gap_m: FloatArray | float = 0.0, droop: float = 1.0) -> FloatArray:
    """Return points of the unrolled plane, with their heights over it, as they are drawn.

    Args:
        top: the table top.
        points: place in the unrolled plane, table frame, and height above it, shape (..., 3), m.
        gap_m: how far off the table, and off the bend, they are drawn; for all or each (then of a shape that fits
            theirs).
        droop: how far the cloth beyond the edge has turned down: 0 level, 1 hanging.

    Returns:
        The points in space, table frame, shape (..., 3), m.
    """
    raised = np.array(points)
    raised[..., 2] += gap_m
    if top.covers(points):
        return raised
    nearest, outwards, beyond = top.edge_beside(points)
    hanging = np.maximum(beyond - points[..., 2], 0.0)
    radius = BEND_M + gap_m
    angle = np.minimum(hanging / radius, droop * math.pi / 2.0)
    rest = hanging - angle * radius
    level, down = math.cos(droop * math.pi / 2.0), math.sin(droop * math.pi / 2.0)
    sunk = radius * (1.0 - np.cos(angle)) + rest * down
    apart, along = _ear(outwards)
    plane = (
        nearest
        + outwards * (radius * np.sin(angle) + rest * level)[..., None]
        + along * (sunk * np.sin(apart))[..., None]
    )
    z = np.maximum(points[..., 2] - beyond, 0.0) + gap_m - sunk * np.cos(apart)
    return np.asarray(np.where(beyond[..., None] > 0.0, np.concatenate([plane, z[..., None]], axis=-1), raised))


def _ear(outwards: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return how far hanging cloth leans from the vertical (rad), which it does only beyond a corner, and which way.

    There the quarter of the plane between the two edges hangs from a point. Folded in the middle it reaches from the
    vertical at one edge out to 45 degrees and back to the vertical at the other.
    """
    parts = np.abs(outwards)
    apart = np.arctan2(parts.min(axis=-1), parts.max(axis=-1))
    return apart, np.sign(outwards) / math.sqrt(2.0)


def _across(axis: int, place: float) -> Segment:
    """Return the line on which a coordinate has a value."""
    return Segment((place, -_FAR_M), (place, _FAR_M)) if axis == 0 else Segment((-_FAR_M, place), (_FAR_M, place))
