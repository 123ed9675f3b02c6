"""Time a path: as evenly as its planned time allows, with bounded speeds and accelerations of all that moves along it.

A path is a curve through keyframes: between two of them a cubic with the monotone slopes of Fritsch and Carlson, so
that no joint leaves the range of its values at both. What is sought is the pace at each keyframe: how much of the
path's own parameter goes by in a second.

- *The quickest run.* A sweep forwards and one backwards bound the pace at each keyframe by what the accelerations allow
  from the one before, and to the one after (time-optimal path parametrization).
- *The planned time.* If the quickest run takes less than planned, its pace is cut at one height for a whole group of
  stretches: it goes evenly where it can, and is slower only where it must.
- *What is kept.* A motion is told by keyframes with velocities, a cubic between two of them in time. Its accelerations
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
from planner.motion.path_intervals import EXCESS, excess, gap_s, shorten
from planner.motion.path_paces import quickest_paces, slopes

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
