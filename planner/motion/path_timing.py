"""Time a path: as evenly as its planned time allows, with bounded speeds and accelerations of all that moves along it.

A path is a curve through keyframes: between two of them a cubic with the monotone slopes of Fritsch and Carlson, so
that no joint leaves the range of its values at both. What is sought is the pace at each keyframe: how much of the
path's own parameter goes by in a second.

- *The quickest run.* A sweep forwards and one backwards bound the pace at each keyframe by what the accelerations allow
  from the one before, and to the one after (time-optimal path parametrization).
- *The planned time.* If the quickest run takes less than planned, its pace is cut at one height for a whole group of
  stretches: it goes evenly where it can, and is slower only where it must.
- *What is kept.* A motion is given by keyframes with velocities, a cubic between two of them in time. Its accelerations
  are greatest at keyframes, so they are known exactly; where they are too great, the pace there is lowered, and all is
  done again.
- *What is late.* Between two keyframes nothing need keep to the pace, so where a group takes longer than planned, its
  intervals are as short as the velocities at their ends allow. Where all joints turn round, these are none, and the
  pace there is low.

A general solver, `toppra`, finds runs that are up to a fifth quicker where a path has kinks, and takes 30 to 60 times
as long (9 ms for a fold of the T-shirt); a search times every transfer that it considers. Tests compare the two.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import kernel

EXCESS = 1.02
"""The greatest acceleration as a share of its limit: the planned time of a drive is that of an exact ramp."""

_ROUNDING = 1.0 + 1e-9
"""The greatest speed as a share of its limit."""

_SHORTER_HALVINGS = 24
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
        first, last, fast = _bends(mean, before, after, gap_s)
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
                for _ in range(_SHORTER_HALVINGS):
                    gap = 0.5 * (low + high)
                    worse = excess(
                        values[i], values[i + 1], velocities, velocities[1:], paces, i, gap, speeds, accelerations
                    )
                    low, high = (gap, high) if worse > 1.0 else (low, gap)
                spare[i] = gaps[i] - high
                spare_s += spare[i]
        if spare_s > 0.0:
            gaps -= min(late_s / spare_s, 1.0) * spare


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


_ASKED = 1.01
"""The accelerations with which a run is sought, as a share of the limits."""

_ROUNDS = 30
"""Times that paces are lowered where accelerations are too great, before the whole group is stretched."""

_HALVINGS = 50
"""Halvings of the interval in which the even pace is sought."""

_PACE_MAX = 1e6
"""A pace that nothing moving has."""

UNBOUNDED = 1e9
"""A limit for what may move at any speed."""

_SAME = 1e-9
"""Parameters nearer than this are one (s)."""


@dataclass(frozen=True, slots=True, eq=False)
class PathTiming:
    """The timing of a path.

    Attributes:
        times_s: the time of each keyframe, from 0, shape (n,); of keyframes at one parameter all have the same time.
        velocities: what moves along the path, by time, shape (n, columns), 1/s.
    """

    times_s: FloatArray
    velocities: FloatArray

    @property
    def duration_s(self) -> float:
        """The duration (s)."""
        return float(self.times_s[-1])

    def stretched(self, factor: float) -> "PathTiming":
        """Return the timing that takes a factor as long."""
        return PathTiming(factor * self.times_s, self.velocities / factor)


def timed(
    at: FloatArray,
    values: FloatArray,
    is_rest: BoolArray,
    groups: NDArray[np.int64],
    planned_s: FloatArray,
    limits: tuple[FloatArray, FloatArray],
) -> PathTiming:
    """Return the evenest timing of a path that takes as long as planned, or the quickest where that takes longer.

    Args:
        at: the path's parameter at each keyframe, not falling: the times of an even run (s), shape (n,).
        values: what moves along it, shape (n, columns); alike at equal parameters.
        is_rest: at which keyframes all must rest; the first and the last among them, shape (n,).
        groups: the group of the stretch that ends at each keyframe, shape (n,); a group begins and ends at rest.
        planned_s: the planned time of each group (s), shape (groups,).
        limits: the top speeds and accelerations, shape (columns,) each.
    """
    starts = np.append(True, np.diff(at) > _SAME)
    rows, which = np.flatnonzero(starts), np.cumsum(starts) - 1
    rests = np.zeros(len(rows), dtype=np.bool_)
    np.logical_or.at(rests, which, is_rest)
    if len(rows) == 1:
        return PathTiming(np.zeros(len(at)), np.zeros_like(values))
    gaps, velocities = _timed(
        at[rows], np.ascontiguousarray(values[rows]), rests, groups[rows], planned_s, limits[0], limits[1]
    )
    times = np.append(0.0, np.cumsum(gaps))
    return PathTiming(times[which], velocities[which])


def quickest(values: FloatArray, at: FloatArray, limits: tuple[FloatArray, FloatArray]) -> PathTiming:
    """Return the quickest timing of a path from rest to rest; for the arguments see `timed`."""
    ends = np.zeros(len(at), dtype=np.bool_)
    ends[[0, -1]] = True
    return timed(at, values, ends, np.zeros(len(at), dtype=np.int64), np.zeros(1), limits)


@kernel
def _timed(
    at: FloatArray,
    values: FloatArray,
    is_rest: BoolArray,
    groups: NDArray[np.int64],
    planned_s: FloatArray,
    speeds: FloatArray,
    accelerations: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return the time between keyframes and the velocities there; see `timed`."""
    (starts, ends), caps = slopes(at, values, is_rest), np.full(len(at), _PACE_MAX)
    gaps, worst = np.empty(len(at) - 1), np.empty(len(planned_s))
    paces = np.empty(len(at))
    for _ in range(_ROUNDS):
        paces[:] = quickest_paces(at, values, starts, ends, is_rest, caps, speeds, _ASKED * accelerations)
        _even(at, values, groups, planned_s, speeds, accelerations, paces, gaps)
        worst[:] = 1.0
        for i in range(len(gaps)):
            worse = excess(values[i], values[i + 1], starts, ends, paces, i, gaps[i], speeds, EXCESS * accelerations)
            worst[groups[i + 1]] = max(worst[groups[i + 1]], worse)
            if worse > 1.0:
                caps[i] = min(caps[i], paces[i] / worse**1.1)
                caps[i + 1] = min(caps[i + 1], paces[i + 1] / worse**1.1)
        if worst.max() <= 1.0:
            break
    for i in range(len(gaps)):
        gaps[i] *= worst[groups[i + 1]]
    for i in range(len(paces)):
        paces[i] /= worst[groups[i]]  # where two groups meet, all rests
    velocities = np.zeros_like(values)  # at the last keyframe all rests
    for i in range(len(gaps)):
        velocities[i] = starts[i] * paces[i]
    shorten(values, velocities, groups, planned_s, speeds, accelerations, gaps)
    return gaps, velocities


@kernel
def _even(
    at: FloatArray,
    values: FloatArray,
    groups: NDArray[np.int64],
    planned_s: FloatArray,
    speeds: FloatArray,
    accelerations: FloatArray,
    paces: FloatArray,
    gaps: FloatArray,
) -> None:
    """Cut the paces of each group so that it takes as long as planned, and set the time between keyframes."""
    for group in range(len(planned_s)):
        high, way, quick_s = 0.0, 0.0, 0.0
        for i in range(len(gaps)):
            if groups[i + 1] == group:
                high, way = max(high, paces[i], paces[i + 1]), way + at[i + 1] - at[i]
                gaps[i] = gap_s(at, values, speeds, accelerations, paces, i, np.inf)
                quick_s += gaps[i]
        if quick_s >= planned_s[group] or quick_s == 0.0:
            continue
        low = way / planned_s[group]
        for _ in range(_HALVINGS):
            middle, taken_s = 0.5 * (low + high), 0.0
            for i in range(len(gaps)):
                if groups[i + 1] == group:
                    taken_s += gap_s(at, values, speeds, accelerations, paces, i, middle)
            low, high = (middle, high) if taken_s > planned_s[group] else (low, middle)
        taken_s = 0.0
        for i in range(len(gaps)):
            if groups[i + 1] == group:
                gaps[i] = gap_s(at, values, speeds, accelerations, paces, i, high)
                taken_s += gaps[i]
        for i in range(len(gaps)):
            if groups[i + 1] == group:
                gaps[i] *= planned_s[group] / taken_s  # 1 but for rounding
                paces[i], paces[i + 1] = min(paces[i], high), min(paces[i + 1], high)
