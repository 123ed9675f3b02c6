"""Cut triangles along lines, so that drawn cloth can bend there."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M

Parts = tuple[FloatArray, NDArray[np.int64]]
"""Triangles, shape (n, 3, 2), m, and the index of the triangle that each is a part of, shape (n,)."""


_FAR_M = 1e6
"""The distance of a line beyond all cloth (m)."""


def parted(triangles: FloatArray, line: Segment) -> tuple[Parts, Parts]:
    """Return the parts of triangles to the left and to the right of the line through a segment.

    Args:
        triangles: shape (n, 3, 2), m.
        line: the cut; a corner that is on it to the tolerance is not cut off.

    Returns:
        The parts on either side, with the orientation of their triangles. Neighbours share the ends of their cuts to
        the last digit.
    """
    distances = line.left_distances(triangles)
    is_left = distances.min(axis=1) >= -LENGTH_M
    left, right = np.flatnonzero(is_left), np.flatnonzero(~is_left & (distances.max(axis=1) <= LENGTH_M))
    cut = np.flatnonzero(~is_left & (distances.max(axis=1) > LENGTH_M))
    if not len(cut):
        return (triangles[left], left), (triangles[right], right)
    zero = np.zeros((len(cut), 1))
    above, of_above = _between(triangles[cut], distances[cut], zero, zero + _FAR_M)
    below, of_below = _between(triangles[cut], distances[cut], zero - _FAR_M, zero)
    return (
        (np.concatenate([triangles[left], above]), np.concatenate([left, cut[of_above]])),
        (np.concatenate([triangles[right], below]), np.concatenate([right, cut[of_below]])),
    )


def creased(triangles: FloatArray, lines: Iterable[Segment]) -> Parts:
    """Cut triangles along whole lines, and return all their parts."""
    sources = np.arange(len(triangles))
    for line in lines:
        (left, of_left), (right, of_right) = parted(triangles, line)
        triangles = np.concatenate([left, right])
        sources = sources[np.concatenate([of_left, of_right])]
    return triangles, sources


def striped(triangles: FloatArray, line: Segment, distances_m: FloatArray) -> Parts:
    """Cut triangles along several parallels of a line at once, and return all their parts.

    Args:
        triangles: shape (n, 3, 2), m.
        line: the line.
        distances_m: how far to its left the parallels are, in order, shape (k,), m.
    """
    there = line.left_distances(triangles)
    first = (distances_m <= there.min(axis=1)[:, None] + LENGTH_M).sum(axis=1)
    last = np.maximum(np.searchsorted(distances_m, there.max(axis=1) - LENGTH_M), first)
    sources, number = _repeated(last - first + 1)
    strips = first[sources] + number
    bounds = np.concatenate([[-_FAR_M], distances_m, [_FAR_M]])
    lows, highs = bounds[strips, None], bounds[strips + 1, None]
    parts, of_parts = _between(triangles[sources], there[sources], lows, highs)
    return parts, sources[of_parts]


def fanned(triangles: FloatArray, line: Segment, places_m: FloatArray) -> Parts:
    """Cut triangles that have a side on a line from their third corner to places on that side; return all parts.

    So they meet the corners of triangles beyond the line that were cut across it.

    Args:
        triangles: shape (n, 3, 2), m.
        line: the line.
        places_m: positions along it, in order, shape (k,), m.
    """
    is_on = np.abs(line.left_distances(triangles)) <= LENGTH_M
    apex = np.argmin(is_on, axis=1)
    p, a, b = np.take_along_axis(triangles, ((apex[:, None] + np.arange(3)) % 3)[..., None], axis=1).transpose(1, 0, 2)
    starts, ends = line.positions(a), line.positions(b)
    low, high = np.minimum(starts, ends) + LENGTH_M, np.maximum(starts, ends) - LENGTH_M
    first = np.searchsorted(places_m, low)
    counts = np.where(is_on.sum(axis=1) == 2, np.maximum(np.searchsorted(places_m, high) - first, 0), 0)
    sources, number = _repeated(counts + 1)
    points = np.array(line.start) + places_m[:, None] * np.array(line.direction)
    chosen = np.where(starts < ends, first, first + counts - 1)[sources]
    step = np.where(starts < ends, 1, -1)[sources]
    last = len(places_m) - 1
    before = points[np.clip(chosen + step * (number - 1), 0, last)]
    after = points[np.clip(chosen + step * number, 0, last)]
    is_first, is_last = (number == 0)[:, None], (number == counts[sources])[:, None]
    parts = [p[sources], np.where(is_first, a[sources], before), np.where(is_last, b[sources], after)]
    return np.stack(parts, axis=1), sources


def _repeated(counts: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Repeat each index a given number of times, in order; also return the number of each repetition."""
    sources = np.repeat(np.arange(len(counts)), counts)
    return sources, np.arange(len(sources)) - np.repeat(np.cumsum(counts) - counts, counts)


def _between(triangles: FloatArray, distances: FloatArray, lows: FloatArray, highs: FloatArray) -> Parts:
    """Return the parts of triangles between two parallels of a line each, to the tolerance.

    Args:
        triangles: shape (n, 3, 2), m.
        distances: those of their corners to the left of the line, shape (n, 3), m.
        lows: the nearer parallels' distances, shape (n, 1), m.
        highs: the farther ones', alike.
    """
    ends, others = triangles, np.roll(triangles, -1, axis=1)
    starts_m, ends_m = distances, np.roll(distances, -1, axis=1)
    crossings = [_crossing(ends, others, starts_m - cut, ends_m - cut) for cut in (lows, highs)]
    is_down = (ends_m < starts_m)[..., None]
    (low, cuts_low), (high, cuts_high) = crossings
    points = np.stack([ends, np.where(is_down, high, low), np.where(is_down, low, high)], axis=2)
    is_inside = (distances - lows >= -LENGTH_M) & (distances - highs <= LENGTH_M)
    down = is_down[..., 0]
    is_there = np.stack(
        [is_inside, np.where(down, cuts_high, cuts_low), np.where(down, cuts_low, cuts_high)], axis=2
    ).reshape(-1, 9)
    order = np.argsort(~is_there, axis=1, kind="stable")[:, :5]
    corners = np.take_along_axis(points.reshape(-1, 9, 2), order[..., None], axis=1)
    sources, number = _repeated(np.maximum(is_there.sum(axis=1) - 2, 0))
    return np.stack([corners[sources, 0], corners[sources, number + 1], corners[sources, number + 2]], axis=1), sources


def _crossing(
    start: FloatArray, end: FloatArray, from_m: FloatArray, to_m: FloatArray
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Return where sides cross a line, shape (n, 3, 2), and whether they do.

    Each is computed from left to right, so that the sides' orientation does not matter.
    """
    above, below = np.maximum(from_m, to_m), np.minimum(from_m, to_m)
    is_cut = (above > LENGTH_M) & (below < -LENGTH_M)
    is_left = (from_m > to_m)[..., None]
    left, right = np.where(is_left, start, end), np.where(is_left, end, start)
    shares = above / np.where(is_cut, above - below, 1.0)
    return left + (right - left) * shares[..., None], is_cut
