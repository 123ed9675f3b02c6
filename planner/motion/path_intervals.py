"""The time from one keyframe of a path to the next, compiled; see `planner.motion.path_timing`."""

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.kernels import kernel

EXCESS = 1.02
"""The greatest acceleration as a share of its limit: the planned time of a drive is that of an exact ramp."""

_ROUNDING = 1.0 + 1e-9
"""The greatest speed as a share of its limit."""

_HALVINGS = 24
"""Halvings of an interval's time in which the least is sought."""


@kernel
def gap_s(
    at: FloatArray,
    values: FloatArray,
    speeds: FloatArray,
    accelerations: FloatArray,
    paces: FloatArray,
    i: int,
    most: float,
) -> float:
    """Return the time over an interval with paces cut at `most`; between two rests the least time of a cubic (s)."""
    total = min(paces[i], most) + min(paces[i + 1], most)
    if total > 0.0:
        return float(2.0 * (at[i + 1] - at[i]) / total)
    least_s = 0.0
    for j in range(values.shape[1]):
        way = abs(values[i + 1, j] - values[i, j])
        least_s = max(least_s, 1.5 * way / speeds[j], np.sqrt(6.0 * way / accelerations[j]))
    return float(least_s)


@kernel
def excess(
    start: FloatArray,
    end: FloatArray,
    starts: FloatArray,
    ends: FloatArray,
    paces: FloatArray,
    i: int,
    gap_s: float,
    speeds: FloatArray,
    accelerations: FloatArray,
) -> float:
    """Return the factor by which time over an interval must be stretched to keep the limits; 1 where they are kept."""
    worst = 1.0
    if gap_s <= 0.0:
        return worst
    for j in range(len(start)):
        before, after = starts[i, j] * paces[i], ends[i, j] * paces[i + 1]
        mean = (end[j] - start[j]) / gap_s
        first, last = (
            (6.0 * mean - 4.0 * before - 2.0 * after) / gap_s,
            (2.0 * before + 4.0 * after - 6.0 * mean) / gap_s,
        )
        fast = max(abs(before), abs(after))
        if first * last < 0.0:
            fast = max(fast, abs(before + 0.5 * first * first / (first - last) * gap_s))
        worst = max(worst, fast / (_ROUNDING * speeds[j]))
        worst = max(worst, np.sqrt(max(abs(first), abs(last)) / accelerations[j]))
    return float(worst)


@kernel
def shorten(
    values: FloatArray,
    velocities: FloatArray,
    groups: NDArray[np.int64],
    planned_s: FloatArray,
    speeds: FloatArray,
    accelerations: FloatArray,
    gaps: FloatArray,
) -> None:
    """Shorten the time between keyframes in groups that take longer than planned, down to that where it is enough.

    The velocities stay. As means grow, no cubic comes to leave the range of its values at both ends.
    """
    paces = np.ones(len(values))
    for group in range(len(planned_s)):
        late_s, spare_s, spare = -planned_s[group], 0.0, np.zeros(len(gaps))
        for i in range(len(gaps)):
            if groups[i + 1] == group:
                late_s += gaps[i]
        for i in range(len(gaps) if late_s > 0.0 else 0):
            if groups[i + 1] == group:
                low, high = 0.0, gaps[i]
                for _ in range(_HALVINGS):
                    gap = 0.5 * (low + high)
                    worse = excess(
                        values[i], values[i + 1], velocities, velocities[1:], paces, i, gap, speeds, accelerations
                    )
                    low, high = (gap, high) if worse > 1.0 else (low, gap)
                spare[i] = gaps[i] - high
                spare_s += spare[i]
        if spare_s > 0.0:
            gaps -= min(late_s / spare_s, 1.0) * spare
