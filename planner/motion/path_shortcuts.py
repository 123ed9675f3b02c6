"""Shortcuts on a path of arms: one arm goes straight from one place of its path to a later one, the others as before.

Where hands come late, mostly one arm makes a detour, or withdraws farther than it must, while the others could be there
in time. An arm that cuts across goes evenly meanwhile, or waits until the others are past, or goes ahead and waits.
"""

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from planner.geometry.pose import FloatArray
from planner.motion.pacing import needed_s
from planner.robots.card import JointLayout

PARTS = (3, 5)
"""Into how many parts of equal time a path is divided, one after the other; shortcuts join the ends of parts."""

_DIGITS = 6
"""Decimal places to which the times of arms are compared (s): rounding must not decide which arm is first."""

Shortcut = tuple[int, int, int]
"""An arm, and the rows of a path from which and to which it goes straight."""


def places(path: FloatArray, layout: JointLayout, parts: int, ends: tuple[int, int]) -> Iterator[Shortcut]:
    """Yield the shortcuts between the ends of equal parts of a path, the longest first, the slowest arm first.

    Args:
        path: the configurations, shape (n, joints), rad.
        layout: the joints' order.
        parts: into how many parts of equal time it is divided.
        ends: the first row and the last one that may be joined.
    """
    at_s = _times_s(path, layout)
    marks = np.linspace(at_s[ends[0]], at_s[ends[1]], parts + 1)
    rows = np.unique(np.searchsorted(at_s, marks).clip(*ends)).tolist()
    pairs = ((first, last) for first, last in combinations(rows, 2) if last - first > 1)
    for first, last in sorted(pairs, key=lambda pair: at_s[pair[0]] - at_s[pair[1]]):
        part, speeds = path[first : last + 1], layout.speeds_rad_s
        own_s = [float(needed_s(part[:, span], speeds[span]).sum()) for span in layout.spans]
        for arm in sorted(layout.arms, key=lambda arm: -round(own_s[arm], _DIGITS)):
            yield arm, first, last


def shortcuts(path: FloatArray, layout: JointLayout, place: Shortcut) -> Iterator[FloatArray]:
    """Yield the path with an arm going straight between two rows: evenly, in the first half of the time, in the last.

    The rows between them divide the time.
    """
    arm, first, last = place
    at_s = _times_s(path[first : last + 1], layout)
    share = at_s / at_s[-1] if at_s[-1] > 0.0 else np.linspace(0.0, 1.0, len(at_s))
    span = layout.spans[arm]
    for shares in (share, 2.0 * share, 2.0 * share - 1.0):
        cut = path.copy()
        start, end = path[first, span], path[last, span]
        cut[first : last + 1, span] = start + shares.clip(0.0, 1.0)[:, None] * (end - start)
        yield cut


def _times_s(path: FloatArray, layout: JointLayout) -> FloatArray:
    """Return the least time up to each row of a path (s)."""
    return np.append(0.0, np.cumsum(needed_s(path, layout.speeds_rad_s)))
