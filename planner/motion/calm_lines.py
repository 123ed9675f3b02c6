"""Calm lines for hands that would come late: without the kinks that slow them down, and without stops at corners."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.motion.calmed import calmed
from planner.motion.line import Line
from planner.motion.transit_paths import TransitPaths

_CALMED, _BLENDED = 3, (10, 30, 60, 120)
"""How often the lines of hands that come late are calmed, and paths without stops at their corners: the more often, the
further from what is known to be free.
"""

_STRAIGHT = 4
"""Steps of a centimetre at grips that stay as they are: fingers come straight to the cloth, and leave it so."""

_CUT_RAD = 0.1
"""The largest angle from one keyframe to the next on such a path (rad)."""


def calm_ends(transits: TransitPaths, tail: Line, lead: Line) -> tuple[Line, Line]:
    """Return the lines from grips and to grips, calmed but for some steps at the grips."""
    return _calmed(transits, tail, _STRAIGHT, 0), _calmed(transits, lead, 0, _STRAIGHT)


def blended(transits: TransitPaths, tail: Line, way: FloatArray, lead: Line) -> Iterator[Line]:
    """Yield lines that join a tail, a path of shape (n, joints) and a lead, more and more calmed."""
    whole = np.concatenate([tail.joints, *(_cut(a, b)[1:] for a, b in pairwise(way)), lead.joints[1:]])
    may_move = _may_move(whole, *(_STRAIGHT if len(line.joints) > 1 else 0 for line in (tail, lead)))
    for passes in _BLENDED:
        yield transits.line(calmed(whole, passes, may_move))


def _calmed(transits: TransitPaths, line: Line, first: int, last: int) -> Line:
    joints = calmed(line.joints, _CALMED, _may_move(line.joints, first, last))
    return transits.line(joints, line.openings_m, line.at_grips)


def _may_move(joints: FloatArray, first: int, last: int) -> BoolArray:
    """Return which rows of a path may be moved: all but some steps at its start and at its end."""
    numbers = np.arange(len(joints))
    return np.asarray((numbers > first) & (numbers < len(joints) - 1 - last))


def _cut(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return a straight line in steps, its ends included."""
    count = max(1, int(np.ceil(np.abs(end - start).max() / _CUT_RAD)))
    return np.asarray(start + np.linspace(0.0, 1.0, count + 1)[:, None] * (end - start))
