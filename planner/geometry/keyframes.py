"""Values between keyframes: a cubic with the keyframes' values and rates at its ends, or a straight line without rates.

A cubic Hermite curve has one velocity at each keyframe, so that what moves along it never jumps, neither in its place
nor in its velocity. `ramps` makes keyframes of a way that speeds up evenly, goes on, and slows down evenly.
"""

import math
from bisect import bisect_right
from collections.abc import Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from planner.geometry.pose import FloatArray

Values: TypeAlias = Sequence[float] | FloatArray
"""A number or an array of them at each keyframe."""


def value_at(times: Sequence[float], values: Values, rates: Values, t: float) -> Any:  # noqa: ANN401
    """Return the value at a time; before the first keyframe and after the last one it rests.

    Args:
        times: the times of the keyframes, rising (s).
        values: the value at each: a number, or an array of them.
        rates: its change at each (1/s); empty: it goes straight from keyframe to keyframe.
        t: the time (s).
    """
    after = bisect_right(times, t)
    if after == 0 or after == len(times):
        return values[max(after - 1, 0)]
    gap = times[after] - times[after - 1]
    share = (t - times[after - 1]) / gap
    start, end = values[after - 1], values[after]
    if not len(rates):
        return (1.0 - share) * start + share * end
    return _cubic(share, gap, start, end, rates[after - 1], rates[after])


def rate_at(times: Sequence[float], values: Values, rates: Values, t: float) -> Any:  # noqa: ANN401
    """Return the change of a value just after a time, at the last keyframe just before it (1/s); see `value_at`."""
    after = min(bisect_right(times, t), len(times) - 1)
    if after == 0 or t > times[-1]:
        return 0.0 * values[0]
    gap = times[after] - times[after - 1]
    slope = (values[after] - values[after - 1]) / gap
    if not len(rates):
        return slope
    share = (t - times[after - 1]) / gap
    bend = rates[after - 1] + rates[after] - 2.0 * slope
    return rates[after - 1] + share * (2.0 * (slope - rates[after - 1]) - bend * (2.0 - 3.0 * share))


def acceleration_at(times: Sequence[float], values: Values, rates: Values, t: float) -> Any:  # noqa: ANN401
    """Return the second derivative of a value just after a time, at the last keyframe just before it (1/s2)."""
    after = min(bisect_right(times, t), len(times) - 1)
    if after == 0 or t > times[-1] or not len(rates):
        return 0.0 * values[0]
    gap = times[after] - times[after - 1]
    slope = (values[after] - values[after - 1]) / gap
    share = (t - times[after - 1]) / gap
    bend = rates[after - 1] + rates[after] - 2.0 * slope
    return (2.0 * (slope - rates[after - 1]) - bend * (2.0 - 6.0 * share)) / gap


def peaks(times: FloatArray, values: FloatArray, rates: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return how fast and how hard values change at most between keyframes, of shape (n - 1, k) each.

    Both (1/s, 1/s2) are exact: a cubic's second derivative is greatest at one of its ends, its first there or where
    that one is 0. Without rates values change evenly between keyframes, and the second derivative is 0.

    Args:
        times: the times of the keyframes, rising (s), shape (n,).
        values: the values, shape (n, k).
        rates: their changes (1/s), shape (n, k), or empty.
    """
    gaps = np.diff(times)[:, None]
    means = np.diff(values, axis=0) / gaps
    if not len(rates):
        return np.abs(means), np.zeros_like(means)
    before, after = rates[:-1], rates[1:]
    first, last = (6.0 * means - 4.0 * before - 2.0 * after) / gaps, (2.0 * before + 4.0 * after - 6.0 * means) / gaps
    bend = np.where(first == last, np.inf, first - last)
    share = (first / bend).clip(0.0, 1.0)
    between = before + gaps * share * (first - 0.5 * share * (first - last))
    return np.abs([before, after, between]).max(axis=0), np.abs([first, last]).max(axis=0)


def extremes(times: FloatArray, values: FloatArray, rates: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the least and greatest values between keyframes, of shape (n - 1, k) each; exact. See `peaks`."""
    ends = values[:-1], values[1:]
    if not len(rates):
        return np.minimum(*ends), np.maximum(*ends)
    gaps = np.diff(times)[:, None]
    before, mean = rates[:-1], np.diff(values, axis=0) / gaps
    bend = before + rates[1:] - 2.0 * mean
    square, linear = 3.0 * bend, 2.0 * (mean - before - bend)
    half = -0.5 * (linear + np.copysign(np.sqrt((linear**2 - 4.0 * square * before).clip(0.0)), linear))
    found = [*ends]
    for top, under in ((half, square), (before, half)):  # where the rate is 0; a share that is clipped is harmless
        share = (top / np.where(under == 0.0, np.inf, under)).clip(0.0, 1.0)
        found.append(_cubic(share, gaps, *ends, before, rates[1:]))
    return np.min(found, axis=0), np.max(found, axis=0)


def values_at(times: FloatArray, values: FloatArray, rates: FloatArray, at: FloatArray) -> FloatArray:
    """Return the values at several times, shape (k,); `times` is of shape (n,), `values` and `rates` of (n, ...)."""
    if len(times) == 1:
        return np.repeat(values, len(at), axis=0)
    after = np.searchsorted(times, at, side="right").clip(1, len(times) - 1)
    gaps = times[after] - times[after - 1]
    shares = ((at - times[after - 1]) / np.where(gaps > 0.0, gaps, 1.0)).clip(0.0, 1.0)
    wide = (len(at),) + (1,) * (values.ndim - 1)
    shares, gaps, start, end = shares.reshape(wide), gaps.reshape(wide), values[after - 1], values[after]
    if not len(rates):
        return np.asarray((1.0 - shares) * start + shares * end)
    return np.asarray(_cubic(shares, gaps, start, end, rates[after - 1], rates[after]))


def _cubic(share: Any, gap: Any, start: Any, end: Any, start_rate: Any, end_rate: Any) -> Any:  # noqa: ANN401
    """Return the cubic at a share of the gap between two keyframes (s)."""
    rest = 1.0 - share
    bent = rest * (gap * start_rate - (end - start)) - share * (gap * end_rate - (end - start))
    return start + share * (end - start + rest * bent)


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
