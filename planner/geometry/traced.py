"""Read the shape that a traced outline is meant to have: its corners without the noise of a hand or a camera.

A traced edge zigzags about the true one. Vertices are dropped as long as the boundary keeps within `TRACED_M` of all
vertices dropped: those that matter least first, all over the ring at once, so that neither the vertex at which the ring
begins nor its orientation decides. Of vertices that matter alike and follow one another every second one is dropped,
counted from both ends: a mirror image keeps the mirror images. Those of a regular polygon are all kept, because nothing
tells one from another.

Curves are drawn by many short edges too. What bends one way between two vertices kept, by more than `STRAIGHT_RAD` in
all, is such a curve and no noise: it gets its vertices back, so that a curve is the same by however many it is drawn.
"""

import math

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.ring import after, before
from planner.geometry.tolerance import EDGE_RAD, GRID_M, grid_keys

TRACED_M = 2.5e-3
"""Greatest distance of a vertex from the shape that an outline is meant to have (m).

Where edges are traced to 1 mm, a corner and the vertices beside it are up to 2 mm from one line.
"""

STRAIGHT_RAD = math.radians(5.0)
"""The angle by which an edge may bend and still be straight (rad)."""

_THINNEST = 0.25
"""The greatest tolerance as a fraction of area by outline, which is half the width of a narrow strip."""


def traced(ring: FloatArray, fixed: BoolArray | None = None) -> BoolArray:
    """Return which vertices of a ring of corners make its shape to within `TRACED_M`, shape (n,).

    The tolerance is less for cloth narrower than four times that, which would vanish.

    Args:
        ring: the corners, shape (n, 2), m.
        fixed: vertices that are kept whatever they matter, shape (n,); None for none.
    """
    stays = np.zeros(len(ring), dtype=bool) if fixed is None else fixed
    kept: NDArray[np.int64] = np.arange(len(ring))
    tolerance_m = min(TRACED_M, _THINNEST * _half_width_m(ring))
    while len(kept) > 3:
        errors_m = np.where(stays[kept], np.inf, _errors_m(ring, kept))
        if errors_m.min() > tolerance_m:
            break
        dropped = _least(errors_m, tolerance_m)
        if not dropped.any():
            dropped = _pairs(ring, kept, errors_m, tolerance_m)
        if not dropped.any() or len(kept) - dropped.sum() < 3:
            break
        kept = kept[~dropped]
    found = np.zeros(len(ring), dtype=bool)
    found[kept] = True
    return found | _on_curves(ring, kept)


def _on_curves(ring: FloatArray, kept: NDArray[np.int64]) -> BoolArray:
    """Return which vertices lie on stretches between two kept ones that bend one way, and are not straight."""
    found = np.zeros(len(ring), dtype=bool)
    if len(kept) == len(ring):
        return found
    (ax, ay), (bx, by) = (ring - before(ring)).T, (after(ring) - ring).T
    turns = np.arctan2(ax * by - ay * bx, ax * bx + ay * by)
    ends = np.append(kept[1:], kept[0] + len(ring))
    stretches = [np.arange(start + 1, end) % len(ring) for start, end in zip(kept, ends, strict=True)]
    bends = np.array([turns[stretch].sum() for stretch in stretches])
    swings = np.array([np.abs(turns[stretch]).sum() for stretch in stretches])
    bends_one_way = swings <= np.abs(bends) + EDGE_RAD
    is_curve = bends_one_way & (swings > STRAIGHT_RAD)
    is_curve |= bends_one_way & np.roll(is_curve, 1) & np.roll(is_curve, -1)
    for stretch in (one for one, is_curved in zip(stretches, is_curve, strict=True) if is_curved):
        found[stretch] = True
    return found


def _half_width_m(ring: FloatArray) -> float:
    """Return a ring's area by half its outline (m)."""
    (x, y), (x_after, y_after) = ring.T, after(ring).T
    outline_m = float(np.hypot(x_after - x, y_after - y).sum())
    return abs(float(np.dot(x, y_after) - np.dot(y, x_after))) / max(outline_m, GRID_M)


def _errors_m(ring: FloatArray, kept: NDArray[np.int64]) -> FloatArray:
    """Return how far each kept vertex, and what was dropped beside it, lies from the chord past it (m)."""
    corners = ring[kept]
    starts, ends = before(corners), after(corners)
    errors_m = _gaps_m(corners, starts, ends)
    if len(kept) < len(ring):
        is_kept = np.zeros(len(ring), dtype=bool)
        is_kept[kept] = True
        dropped = np.flatnonzero(~is_kept)
        first = np.searchsorted(kept, dropped) - 1
        for past in (first % len(kept), (first + 1) % len(kept)):
            np.maximum.at(errors_m, past, _gaps_m(ring[dropped], starts[past], ends[past]))
    return errors_m


def _gaps_m(points: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Return the distance of each point from its own segment, shapes (n, 2) -> (n,), m."""
    along = ends - starts
    share = ((points - starts) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), GRID_M**2)
    return np.asarray(np.hypot(*(starts + np.clip(share, 0.0, 1.0)[:, None] * along - points).T))


def _least(errors_m: FloatArray, tolerance_m: float) -> BoolArray:
    """Return the vertices that matter less than those beside them; of a run of equals every second one."""
    count, ranks = len(errors_m), _ranks(errors_m)
    lower = (ranks < np.roll(ranks, 1)) & (ranks < np.roll(ranks, -1))
    dropped = lower & (errors_m <= tolerance_m)
    changes = np.flatnonzero(ranks != np.roll(ranks, 1))
    lengths = (np.roll(changes, -1) - changes - 1) % count + 1
    for first, length in zip(changes[lengths > 1], lengths[lengths > 1], strict=True):
        run = (first + np.arange(length)) % count
        beside = min(ranks[first - 1], ranks[(first + length) % count])
        if errors_m[run].max() <= tolerance_m and ranks[first] < beside:
            from_end = np.minimum(np.arange(length), np.arange(length)[::-1])
            dropped[run[(from_end % 2 == 0) & ((from_end < length // 2 - 1) | (length % 2 == 1))]] = True
    return np.asarray(dropped)


def _pairs(ring: FloatArray, kept: NDArray[np.int64], errors_m: FloatArray, tolerance_m: float) -> BoolArray:
    """Return two vertices side by side that matter alike and least, if both can be dropped."""
    count, ranks = len(kept), _ranks(errors_m)
    dropped = np.zeros(count, dtype=bool)
    if ranks.min() == ranks.max():
        return dropped
    alike = np.flatnonzero((ranks == np.roll(ranks, -1)) & (np.maximum(errors_m, np.roll(errors_m, -1)) <= tolerance_m))
    for one in alike[np.argsort(ranks[alike], kind="stable")]:
        pair = [one, (one + 1) % count]
        start, end = int(kept[one - 1]), int(kept[(one + 2) % count])
        between = ring[np.arange(start + 1, end + (end <= start) * len(ring)) % len(ring)]
        chord = np.broadcast_to(ring[start], between.shape), np.broadcast_to(ring[end], between.shape)
        if _gaps_m(between, *chord).max() <= tolerance_m:
            dropped[pair] = True
            break
    return dropped


def _ranks(errors_m: FloatArray) -> NDArray[np.int64]:
    """Return numbers by which errors are compared: what differs by less than the tolerance is alike."""
    return grid_keys(np.minimum(errors_m, 1.0))
