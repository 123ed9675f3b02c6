"""Even ways from rest to rest: speed up evenly, go on, slow down evenly."""

import math
from typing import NamedTuple

_EASING = 0.3
"""The fraction of its time for which a way that has time speeds up, and again slows down."""

_SAME = 1e-6
"""The share of its time for which a way may go on at top speed and still count as speeding up and slowing down only."""


class Ramps(NamedTuple):
    """The keyframes of a way from rest to rest.

    Attributes:
        times_s: the times, rising from 0 (s).
        fractions: the fraction of the way that is done at each.
        rates: its change at each (1/s).
    """

    times_s: tuple[float, ...]
    fractions: tuple[float, ...]
    rates: tuple[float, ...]


def least_s(way: float, speed: float, acceleration: float) -> float:
    """Return the least time of a way from rest to rest (s)."""
    if way * acceleration >= speed**2:
        return way / speed + speed / acceleration
    return 2.0 * math.sqrt(way / acceleration)


def ramps(duration_s: float, way: float, speed: float, acceleration: float) -> Ramps:
    """Return the keyframes of a way, with accelerations no greater than the time that there is demands.

    Args:
        duration_s: its duration, no less than the least (s).
        way: how far it goes.
        speed: the top speed, in the way's unit (1/s).
        acceleration: the top acceleration, alike (1/s2).
    """
    if duration_s <= 0.0:
        return Ramps((0.0,), (1.0,), (0.0,))
    hardest_s = 0.5 * (duration_s - math.sqrt(max(duration_s**2 - 4.0 * way / acceleration, 0.0)))
    softest_s = min(duration_s - way / speed, 0.5 * duration_s)
    rising_s = max(min(max(_EASING * duration_s, hardest_s), softest_s), hardest_s)
    top = 1.0 / (duration_s - rising_s)
    if duration_s - 2.0 * rising_s <= _SAME * duration_s:
        return Ramps((0.0, 0.5 * duration_s, duration_s), (0.0, 0.5, 1.0), (0.0, top, 0.0))
    gone = 0.5 * top * rising_s
    times_s = (0.0, rising_s, duration_s - rising_s, duration_s)
    return Ramps(times_s, (0.0, gone, 1.0 - gone, 1.0), (0.0, top, top, 0.0))
