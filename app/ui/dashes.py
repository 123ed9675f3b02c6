"""Lines cut into dashes: red folds are told from blue ones without their colour, too."""

import numpy as np

from planner.geometry.pose import FloatArray

_STEP_M = 0.02
_DASH_M, _GAP_M, _DOT_M = 0.045, 0.012, 0.006


def solid(start: FloatArray, end: FloatArray) -> FloatArray:
    """A plane line in short steps, shape (n, 2, 2): short enough to be bent over a table's edge."""
    steps = max(1, int(np.ceil(np.hypot(*(end - start)) / _STEP_M)))
    points = start + (end - start) * np.linspace(0.0, 1.0, steps + 1)[:, None]
    return np.stack([points[:-1], points[1:]], axis=1)


def dash_dot(start: FloatArray, end: FloatArray) -> FloatArray:
    """A plane line as dash, dot, dash, dot, shape (n, 2, 2)."""
    length = float(np.hypot(*(end - start)))
    marks, at, is_dash = [], 0.0, True
    while at < length:
        stop = min(length, at + (_DASH_M if is_dash else _DOT_M))
        marks.append((at, stop))
        at, is_dash = stop + _GAP_M, not is_dash
    along = np.array(marks)[:, :, None] / length
    return np.asarray(start + (end - start) * along)
