"""Half pieces: cut on the fold, with a line that says along which edge, or drawn beside their mirror image."""

from collections.abc import Sequence

import numpy as np

from app.files.sketch import MirrorLine
from planner.geometry.arrangement import are_alike, reflected, signed_area, united_ring
from planner.geometry.pose import FloatArray
from planner.geometry.ring import after, corners
from planner.geometry.segment import Segment

NEAR_M = 1.5e-3
"""Distance from a fold line up to which points lie on it (m)."""

_BESIDE_M = 0.03
"""Distance of a fold line that may run beside its edge (m), such as the shaft of an arrow."""

_PARALLEL = 0.035
"""Sine of the largest angle between such a line and its edge."""

_COVERED = 0.5
"""The share of a fold line along which the edge runs at least."""

_EDGES_MAX = 24
"""Edges of a piece, the longest first, over which its other half is looked for."""


def fold_edge(ring: FloatArray, mirror: MirrorLine, unit_m: float) -> Segment | None:
    """Return the straight part of a piece's edge that a fold line lies on; None if it lies on no edge of it.

    A fold line that runs through a piece means nothing here: the piece is drawn whole.

    Args:
        ring: the piece, shape (n, 2).
        mirror: the fold line.
        unit_m: the length of its unit (m).
    """
    start, end = (mirror.curve.extent[[0, -1]] * unit_m).tolist()
    if np.hypot(end[0] - start[0], end[1] - start[1]) <= NEAR_M:
        return None
    line = Segment(tuple(start), tuple(end))
    found = _stretch_on(ring, line)
    if found is None and mirror.is_beside:
        beside = _edge_beside(ring, line)
        found = None if beside is None else _stretch_on(ring, beside)
    if found is None:
        return None
    away = found.left_distances(ring)
    return found if away.min() >= -NEAR_M or away.max() <= NEAR_M else None


def unfolded(ring: FloatArray, line: Segment) -> FloatArray | None:
    """Return a half piece with its mirror image; None if they do not make one piece."""
    away = line.left_distances(ring)
    on_it = ring - np.where(np.abs(away) <= NEAR_M, away, 0.0)[:, None] * np.array(line.left)
    return united_ring((on_it, reflected(on_it, line)), 0.0)


def joined_halves(one: FloatArray, other: FloatArray) -> FloatArray | None:
    """Return two pieces joined at a shared edge if they are mirror images over it; else None."""
    slim = corners(one)
    following = after(slim)
    lengths = np.hypot(*(following - slim).T)
    low, high = other.min(axis=0) - NEAR_M, other.max(axis=0) + NEAR_M
    for number in np.argsort(-lengths)[:_EDGES_MAX].tolist():
        ends = slim[number], following[number]
        if lengths[number] <= NEAR_M or any(np.any((end < low) | (end > high)) for end in ends):
            continue
        image = reflected(slim, Segment(tuple(ends[0].tolist()), tuple(ends[1].tolist())))
        if are_alike(image, other, 2.0 * NEAR_M):
            return united_ring((one, other), NEAR_M)
    return None


def _stretch_on(ring: FloatArray, line: Segment) -> Segment | None:
    """Return the part of a ring that lies on the line through a segment, if it runs along enough of the segment."""
    following = after(ring)
    off = np.maximum(np.abs(line.left_distances(ring)), np.abs(line.left_distances(following)))
    on_it = np.flatnonzero(off <= NEAR_M)
    if not len(on_it):
        return None
    places = np.sort(np.stack([line.positions(ring[on_it]), line.positions(following[on_it])], axis=1), axis=1)
    covered_m = np.clip(np.minimum(places[:, 1], line.length) - np.maximum(places[:, 0], 0.0), 0.0, None).sum()
    if covered_m < _COVERED * line.length:
        return None
    ends = np.concatenate([ring[on_it], following[on_it]])
    along = line.positions(ends)
    first, last = ends[along.argmin()].tolist(), ends[along.argmax()].tolist()
    return Segment(tuple(first), tuple(last))


def _edge_beside(ring: FloatArray, line: Segment) -> Segment | None:
    """Return the nearest parallel edge of a ring that runs along a line at a small distance."""
    slim = corners(ring)
    best: tuple[float, Segment] | None = None
    for start, end in zip(slim.tolist(), after(slim).tolist(), strict=True):
        edge = Segment(tuple(start), tuple(end))
        if edge.length < _COVERED * line.length:
            continue
        away = np.abs(edge.left_distances(np.array([line.start, line.end])))
        places = np.sort(edge.positions(np.array([line.start, line.end])))
        covered_m = min(places[1], edge.length) - max(places[0], 0.0)
        is_along = float(np.ptp(away)) <= _PARALLEL * line.length and covered_m >= _COVERED * line.length
        if is_along and away.max() <= _BESIDE_M and (best is None or away.max() < best[0]):
            best = (float(away.max()), edge)
    return None if best is None else best[1]


def mirrored_line(ends: FloatArray, line: Segment) -> FloatArray | None:
    """Return the mirror image of a fold line's ends, shape (2, 2), turned so that its mirrored side moves.

    None for a line that is its own mirror image: along the fold, or across it from edge to edge.
    """
    image = reflected(ends, line)
    if np.abs(image - ends).max() <= 2.0 * NEAR_M or np.abs(image[::-1] - ends).max() <= 2.0 * NEAR_M:
        return None
    return image[::-1]


def whole_line(ends: FloatArray, line: Segment) -> FloatArray | None:
    """Return a line that ends square on a fold, shape (2, 2), with its mirror image; None for any other line."""
    away = np.abs(line.left_distances(ends))
    along = line.positions(ends)
    on_it = int(away.argmin())
    is_square = abs(float(along[1] - along[0])) <= _PARALLEL * float(np.hypot(*(ends[1] - ends[0])))
    if away[on_it] > 4.0 * NEAR_M or away[1 - on_it] <= 4.0 * NEAR_M or not is_square:
        return None
    far = ends[1 - on_it]
    image = reflected(far[None], line)[0]
    return np.array([far, image] if on_it else [image, far])


def joined(rings: Sequence[FloatArray], blocks: Sequence[int | None]) -> tuple[int, int, FloatArray] | None:
    """Return the indices of the first two rings of one block that are halves of one piece, and the piece; else None."""
    areas = [abs(signed_area(ring)) for ring in rings]
    for one in range(len(rings)):
        for other in range(one + 1, len(rings)):
            if blocks[one] == blocks[other] and abs(areas[one] - areas[other]) <= 0.02 * areas[one]:
                whole = joined_halves(rings[one], rings[other])
                if whole is not None:
                    return one, other, whole
    return None
