"""Smooth lines for hands that would come late: without the kinks that slow them down, and without stops at corners."""

from itertools import pairwise

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.motion.line import Line
from planner.motion.smoothing import smoothed
from planner.motion.transit_paths import TransitPaths

_SMOOTHING_PASSES = 3
"""How often the lines of late hands are smoothed."""

BLENDED = (10, 30, 60, 120)
"""How often paths without stops at their corners are smoothed.

The more often, the further from what is known to be free.
"""

_STRAIGHT = 4
"""Steps of a centimetre at grips that stay as they are: fingers come straight to the cloth, and leave it so."""

_CUT_RAD = 0.1
"""The largest angle from one keyframe to the next on such a path (rad)."""


def smoothed_ends(transits: TransitPaths, retreat: Line, approach: Line) -> tuple[Line, Line]:
    """Return the lines from grips and to grips, smoothed but for some steps at the grips."""
    return _smoothed(transits, retreat, _STRAIGHT, 0), _smoothed(transits, approach, 0, _STRAIGHT)


def blended(transits: TransitPaths, retreat: Line, way: FloatArray, approach: Line, passes: int) -> Line:
    """Return a line that joins a tail, a path of shape (n, joints) and a lead, smoothed so many times over."""
    return smoothed_line(transits, joined(retreat.joints, way, approach.joints), retreat, approach, passes)


def joined(retreat: FloatArray, way: FloatArray, approach: FloatArray) -> FloatArray:
    """Return a tail, a path and a lead, of shape (n, joints) each, as one path with small steps."""
    return np.concatenate([retreat, *(_cut(a, b)[1:] for a, b in pairwise(way)), approach[1:]])


def smoothed_line(transits: TransitPaths, path: FloatArray, retreat: Line, approach: Line, passes: int) -> Line:
    """Return a line along a path from a tail to a lead, smoothed so many times over but for some steps at the grips."""
    first, last = free_rows(path, retreat, approach)
    return transits.line(smoothed(path, passes, _may_move(path, first, len(path) - 1 - last)))


def free_rows(path: FloatArray, retreat: Line, approach: Line) -> tuple[int, int]:
    """Return the rows of a path from a tail to a lead between which it may be changed."""
    first, last = (_STRAIGHT if len(line.joints) > 1 else 0 for line in (retreat, approach))
    return first, len(path) - 1 - last


def _smoothed(transits: TransitPaths, line: Line, first: int, last: int) -> Line:
    joints = smoothed(line.joints, _SMOOTHING_PASSES, _may_move(line.joints, first, last))
    return transits.line(joints, line.openings_m, line.at_grips)


def _may_move(joints: FloatArray, first: int, last: int) -> BoolArray:
    """Return which rows of a path may be moved: all but some steps at its start and at its end."""
    numbers = np.arange(len(joints))
    return np.asarray((numbers > first) & (numbers < len(joints) - 1 - last))


def _cut(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return a straight line in steps, its ends included."""
    count = max(1, int(np.ceil(np.abs(end - start).max() / _CUT_RAD)))
    return np.asarray(start + np.linspace(0.0, 1.0, count + 1)[:, None] * (end - start))
