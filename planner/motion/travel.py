"""Keyframes of empty hands along a path of straight lines, each of them from rest to rest."""

from itertools import pairwise

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.motion.line import Keyframes
from planner.motion.transit_paths import TransitPaths

_HALVINGS = 40
"""How often the part of a line in which hands rest is halved."""


def led_along(
    transits: TransitPaths, way: FloatArray, needed: FloatArray, span: tuple[float, float], borders_s: tuple[float, ...]
) -> list[Keyframes] | None:
    """Return keyframes along a path within a span of time, each of its lines from rest to rest.

    The hands rest where one step of the plan ends and the next begins; None if there is no time for that.
    """
    (start, end), total = span, float(needed.sum())
    within = [border for border in borders_s if start + TIME_S < border < end - TIME_S]
    if any(border < start - TIME_S or border > end + TIME_S for border in borders_s):
        return None
    if total <= 0.0:
        return [Keyframes.still(way[-1], end)]
    begins = start + (end - start) * np.append(0.0, np.cumsum(needed)) / total
    found: list[Keyframes] = []
    for (a, b), begin, until in zip(pairwise(way), begins, begins[1:], strict=False):
        for border in (border for border in within if begin + TIME_S < border < until - TIME_S):
            middle = _middle(transits, a, b, border - begin, until - border)
            if _least_s(transits, a, middle) > border - begin or _least_s(transits, middle, b) > until - border:
                return None
            found.append(transits.eased(a, middle, border - begin).later(begin))
            a, begin = middle, border
        found.append(transits.eased(a, b, until - begin).later(begin))
    return found


def _middle(transits: TransitPaths, start: FloatArray, end: FloatArray, before_s: float, after_s: float) -> FloatArray:
    """Return where on a line to rest so that the ways before and after take equal shares of their times."""
    low, high = start, end
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if _least_s(transits, start, middle) * after_s < _least_s(transits, middle, end) * before_s:
            low = middle
        else:
            high = middle
    return np.asarray(0.5 * (low + high))


def _least_s(transits: TransitPaths, start: FloatArray, end: FloatArray) -> float:
    return float(transits.needed_s(np.array([start, end])).sum())


def quickest_lines(transits: TransitPaths, way: FloatArray, needed: FloatArray, start_s: float) -> list[Keyframes]:
    """Return keyframes along a path, each of its lines as quickly as it can be."""
    begins = start_s + np.append(0.0, np.cumsum(needed))
    return [
        transits.eased(a, b, need).later(begin)
        for (a, b), begin, need in zip(pairwise(way), begins, needed.tolist(), strict=False)
    ]
