"""Lines cut into dashes and steps, so that kinds of folds differ without colour, too."""

from collections.abc import Sequence
from itertools import cycle

import numpy as np

from planner.geometry.pose import FloatArray

_STEP_M = 0.01


def solid(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return a plane line in steps, shape (n, 2, 2), short enough to follow the cloth up and down."""
    steps = max(1, int(np.ceil(np.hypot(*(end - start)) / _STEP_M)))
    points = start + (end - start) * np.linspace(0.0, 1.0, steps + 1)[:, None]
    return np.stack([points[:-1], points[1:]], axis=1)


def dashed(start: FloatArray, end: FloatArray, lengths_m: Sequence[float]) -> FloatArray:
    """Return a plane line in dashes, in the same short steps as `solid`, shape (n, 2, 2).

    Args:
        start: its start, shape (2,), m.
        end: its end.
        lengths_m: the lengths of dashes and gaps by turns, an even number; a line without any is solid.
    """
    if not lengths_m:
        return solid(start, end)
    length = float(np.hypot(*(end - start)))
    along = (end - start) / length
    marks, at, pairs = [], 0.0, cycle(zip(lengths_m[::2], lengths_m[1::2], strict=True))
    while at < length:
        dash_m, gap_m = next(pairs)
        stop = min(length, at + dash_m)
        marks.append(solid(start + at * along, start + stop * along))
        at = stop + gap_m
    return np.concatenate(marks)


def split_at(segments: FloatArray, axis: int, place: float) -> FloatArray:
    """Return segments, shape (n, 2, 2), with those that cross a coordinate's value cut in two there."""
    from_m, to_m = segments[:, 0, axis], segments[:, 1, axis]
    is_crossing = (from_m - place) * (to_m - place) < 0.0
    crossing = segments[is_crossing]
    share = ((place - from_m[is_crossing]) / (to_m - from_m)[is_crossing])[:, None]
    middle = crossing[:, 0] + share * (crossing[:, 1] - crossing[:, 0])
    middle[:, axis] = place
    halves = (np.stack([crossing[:, 0], middle], axis=1), np.stack([middle, crossing[:, 1]], axis=1))
    return np.concatenate([segments[~is_crossing], *halves])
