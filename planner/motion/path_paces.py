"""The greatest pace at which each keyframe of a path can be passed, compiled; see `planner.motion.path_timing`."""

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import kernel

_LEAST = 1e-12
"""A slope, or a bend, that is none."""


@kernel
def slopes(at: FloatArray, values: FloatArray, is_rest: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Return the monotone slopes of Fritsch and Carlson at both ends of each interval, as weighted harmonic means.

    Where everything rests a path may turn at once, so there each interval has its own slope.
    """
    count, columns = values.shape
    starts, ends = np.zeros((count - 1, columns)), np.zeros((count - 1, columns))
    for j in range(columns):
        before = 0.0
        for i in range(count - 1):
            width = at[i + 1] - at[i]
            after = (values[i + 1, j] - values[i, j]) / width
            if is_rest[i]:
                starts[i, j] = after
                if i > 0:
                    ends[i - 1, j] = before
            elif before * after > 0.0:
                gap = at[i] - at[i - 1]
                first, second = 2.0 * width + gap, width + 2.0 * gap
                starts[i, j] = ends[i - 1, j] = (first + second) / (first / before + second / after)
            before = after
        ends[count - 2, j] = before
    return starts, ends


@kernel
def _bends(slope: float, start: float, end: float, width: float) -> tuple[float, float, float]:
    """Return a cubic's second derivatives at both ends, and the size of its steepest slope.

    Args:
        slope: its mean slope.
        start: the slope at its start.
        end: the slope at its end.
        width: the width of the interval.
    """
    first, last = (6.0 * slope - 4.0 * start - 2.0 * end) / width, (2.0 * start + 4.0 * end - 6.0 * slope) / width
    steepest = max(abs(start), abs(end))
    if first * last < 0.0:
        steepest = max(steepest, abs(start + 0.5 * first * first / (first - last) * width))
    return first, last, steepest


@kernel
def quickest_paces(
    at: FloatArray,
    values: FloatArray,
    starts: FloatArray,
    ends: FloatArray,
    is_rest: BoolArray,
    caps: FloatArray,
    speeds: FloatArray,
    accelerations: FloatArray,
) -> FloatArray:
    """Return the greatest pace at each keyframe, none above its cap."""
    count, columns = values.shape
    squares = caps**2
    first, last = np.empty((count - 1, columns)), np.empty((count - 1, columns))
    for i in range(count - 1):
        width = at[i + 1] - at[i]
        for j in range(columns):
            slope = (values[i + 1, j] - values[i, j]) / width
            first[i, j], last[i, j], steepest = _bends(slope, starts[i, j], ends[i, j], width)
            fast = (speeds[j] / max(steepest, _LEAST)) ** 2
            squares[i] = min(squares[i], fast, accelerations[j] / max(abs(first[i, j]), _LEAST))
            squares[i + 1] = min(squares[i + 1], fast, accelerations[j] / max(abs(last[i, j]), _LEAST))
    squares[is_rest] = 0.0
    for i in range(count - 1):
        gain = _gain(squares[i], starts[i], ends[i], first[i], last[i], accelerations, at[i + 1] - at[i])
        squares[i + 1] = min(squares[i + 1], squares[i] + gain)
    for i in range(count - 2, -1, -1):  # backwards in time the slopes turn round, and the bends stay
        gain = _gain(squares[i + 1], -ends[i], -starts[i], last[i], first[i], accelerations, at[i + 1] - at[i])
        squares[i] = min(squares[i], squares[i + 1] + gain)
    return np.sqrt(squares)


@kernel
def _gain(
    square: float,
    near: FloatArray,
    far: FloatArray,
    near_bends: FloatArray,
    far_bends: FloatArray,
    accelerations: FloatArray,
    width: float,
) -> float:
    """Return by how much a pace's square may grow over an interval from its near end; no less than nothing."""
    gain = np.inf
    for j in range(len(near)):
        gain = min(gain, _room(near[j], near_bends[j] * square, accelerations[j], width))
        gain = min(gain, _room(far[j] + 2.0 * width * far_bends[j], far_bends[j] * square, accelerations[j], width))
    return max(gain, 0.0)


@kernel
def _room(slope: float, bent: float, acceleration: float, width: float) -> float:
    """Return by how much a pace's square may grow where a joint accelerates by `bent` for the path's bend already.

    A joint that turns round there does not accelerate with the pace.
    """
    if abs(slope) <= _LEAST:
        return np.inf
    spare = acceleration - bent if slope > 0.0 else acceleration + bent
    return 2.0 * width * spare / abs(slope)
