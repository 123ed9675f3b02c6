"""Cut triangles along lines, so that drawn cloth can bend there."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M

Parts = tuple[FloatArray, NDArray[np.int64]]
"""Triangles, shape (n, 3, 2), m, and the index of the triangle that each is a part of, shape (n,)."""


def parted(triangles: FloatArray, line: Segment) -> tuple[Parts, Parts]:
    """Return the parts of triangles to the left and to the right of the line through a segment.

    Args:
        triangles: shape (n, 3, 2), m.
        line: the cut; a corner that is on it to the tolerance is not cut off.

    Returns:
        The parts on either side, with the orientation of their triangles. Neighbours share the ends of their cuts to
            the
        last digit.
    """
    distances = line.left_distances(triangles)
    sides = np.where(np.abs(distances) <= LENGTH_M, 0.0, np.sign(distances))
    low, high = sides.min(axis=1), sides.max(axis=1)
    is_left, is_cut = low >= 0.0, (low < 0.0) & (high > 0.0)
    left, right = np.flatnonzero(is_left), np.flatnonzero(~is_left & ~is_cut)
    if not is_cut.any():
        return (triangles[left], left), (triangles[right], right)
    parts, sources, sign = _halves(triangles[is_cut], distances[is_cut], sides[is_cut])
    names, is_here = np.flatnonzero(is_cut)[sources], sign > 0.0
    return (
        (np.concatenate([triangles[left], parts[is_here]]), np.concatenate([left, names[is_here]])),
        (np.concatenate([triangles[right], parts[~is_here]]), np.concatenate([right, names[~is_here]])),
    )


def creased(triangles: FloatArray, lines: Iterable[Segment]) -> Parts:
    """Cut triangles along whole lines, and return all their parts."""
    sources = np.arange(len(triangles))
    for line in lines:
        (left, of_left), (right, of_right) = parted(triangles, line)
        triangles = np.concatenate([left, right])
        sources = sources[np.concatenate([of_left, of_right])]
    return triangles, sources


def _halves(
    triangles: FloatArray, distances: FloatArray, sides: FloatArray
) -> tuple[FloatArray, NDArray[np.int64], FloatArray]:
    """Cut triangles that the line crosses; return the parts, the triangle and the side (1 left, -1 right) of each."""
    of_all = sides.sum(axis=1, keepdims=True)
    # Put first the corner on the line, if there is one, otherwise the one that is alone on its side.
    first = np.argmax(np.where(of_all == 0.0, sides == 0.0, sides * of_all < 0.0), axis=1)
    order = (first[:, None] + np.arange(3)) % 3
    distances = np.take_along_axis(distances, order, axis=1)
    sides = np.take_along_axis(sides, order, axis=1)
    p, a, b = np.take_along_axis(triangles, order[..., None], axis=1).transpose(1, 0, 2)
    is_through = sides[:, 0] == 0.0
    alone, through = np.flatnonzero(~is_through), np.flatnonzero(is_through)
    to_a = _crossing(p, a, distances[:, 0], distances[:, 1], alone)
    to_b = _crossing(p, b, distances[:, 0], distances[:, 2], alone)
    between = _crossing(a, b, distances[:, 1], distances[:, 2], through)
    p0, a0, b0, p1, a1, b1 = p[alone], a[alone], b[alone], p[through], a[through], b[through]
    parts = [(p0, to_a, to_b), (to_a, a0, b0), (to_a, b0, to_b), (p1, a1, between), (p1, between, b1)]
    return (
        np.concatenate([np.stack(part, axis=1) for part in parts]),
        np.concatenate([alone, alone, alone, through, through]),
        np.concatenate([sides[alone, 0], sides[alone, 1], sides[alone, 1], sides[through, 1], sides[through, 2]]),
    )


def _crossing(
    start: FloatArray, end: FloatArray, from_m: FloatArray, to_m: FloatArray, chosen: NDArray[np.int64]
) -> FloatArray:
    """Return where sides cross the line, computed from left to right so that the sides' orientation does not matter."""
    start, end, from_m, to_m = start[chosen], end[chosen], from_m[chosen], to_m[chosen]
    is_left = (from_m > to_m)[:, None]
    left, right = np.where(is_left, start, end), np.where(is_left, end, start)
    above, below = np.maximum(from_m, to_m), np.minimum(from_m, to_m)
    return np.asarray(left + (right - left) * (above / (above - below))[:, None])
