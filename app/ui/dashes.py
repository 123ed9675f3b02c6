"""Lines cut into dashes and steps, so that red folds differ from blue ones without colour, too."""

import numpy as np

from planner.geometry.pose import FloatArray

_STEP_M = 0.01
_DASH_M, _GAP_M, _DOT_M = 0.045, 0.012, 0.006


def solid(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return a plane line in steps, shape (n, 2, 2), short enough to follow the cloth up and down."""
    steps = max(1, int(np.ceil(np.hypot(*(end - start)) / _STEP_M)))
    points = start + (end - start) * np.linspace(0.0, 1.0, steps + 1)[:, None]
    return np.stack([points[:-1], points[1:]], axis=1)


def dash_dot(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return a plane line as alternating dashes and dots, in the same short steps as `solid`, shape (n, 2, 2)."""
    length = float(np.hypot(*(end - start)))
    along = (end - start) / length
    marks, at, is_dash = [], 0.0, True
    while at < length:
        stop = min(length, at + (_DASH_M if is_dash else _DOT_M))
        marks.append(solid(start + at * along, start + stop * along))
        at, is_dash = stop + _GAP_M, not is_dash
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
