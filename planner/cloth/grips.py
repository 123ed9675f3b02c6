"""Where to grip: as few places as hold every vertex that must be held (paper, section 8).

One grip holds every such vertex within its radius. Candidates are the vertices themselves and the points of the
boundary nearest to the centre of the smallest circle round each two and each three of them. Of the smallest
covers the best is the one whose largest distance from a vertex to its grip is smallest, then the second
largest, and so on; covers that tie are all kept, or a mirrored garment would plan differently.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.smallest_circle import pair_centres, triple_centres
from planner.geometry.tolerance import LENGTH_M, grid_key

Cover = tuple[Point2, ...]


@dataclass(frozen=True, slots=True)
class GripCovers:
    """The ways to hold a piece of cloth.

    Attributes:
        vertices: the vertices that must be held, frame of the cloth (m).
        covers: equally good sets of grips; empty when `at_most` grips do not suffice.
    """

    vertices: tuple[Point2, ...]
    covers: tuple[Cover, ...]

    @property
    def is_holdable(self) -> bool:
        """Whether the grips allowed suffice."""
        return bool(self.covers)

    @property
    def count(self) -> int | None:
        """The number of grips needed; None when more than were allowed."""
        return len(self.covers[0]) if self.covers else None


def grip_covers(piece: Region, vertices: FloatArray, radius_m: float, at_most: int) -> GripCovers:
    """The best sets of at most so many grips that hold all vertices.

    Args:
        piece: the cloth whose boundary is gripped.
        vertices: what must be held, shape (n, 2), m.
        radius_m: how far round itself one grip holds (m), inclusive.
        at_most: the number of grippers.
    """
    points = tuple((float(x), float(y)) for x, y in vertices)
    if not points:
        return GripCovers(points, ((),))
    if _needs_more(vertices, radius_m, at_most):
        return GripCovers(points, ())
    candidates = _candidates(piece, vertices)
    return GripCovers(points, best_covers(candidates, vertices, radius_m, at_most))


def best_covers(candidates: FloatArray, vertices: FloatArray, radius_m: float, at_most: int) -> tuple[Cover, ...]:
    """Of the given candidates, shape (m, 2), the best covers of the vertices, ties included."""
    distances = np.hypot(*(candidates[:, None, :] - vertices[None, :, :]).transpose(2, 0, 1))
    holds = distances <= radius_m + LENGTH_M
    useful = holds.any(axis=1)
    candidates, distances, holds = candidates[useful], distances[useful], holds[useful]
    for count in range(1, at_most + 1):
        chosen = _covering_sets(holds, count)
        if len(chosen):
            ranks = -np.sort(-distances[chosen].min(axis=1), axis=1)
            return _distinct(candidates[chosen[_is_first(ranks)]])
    return ()


def _needs_more(vertices: FloatArray, radius_m: float, at_most: int) -> bool:
    """Whether more than `at_most` vertices lie so far apart that no grip holds two of them (greedy)."""
    apart: list[FloatArray] = []
    for vertex in vertices:
        if all(np.hypot(*(vertex - other)) > 2 * (radius_m + LENGTH_M) for other in apart):
            apart.append(vertex)
    return len(apart) > at_most


def _candidates(piece: Region, vertices: FloatArray) -> FloatArray:
    centres = [vertices]
    if len(vertices) >= 2:
        centres.append(piece.nearest_boundary_points(_distinct_rows(pair_centres(vertices))))
    if len(vertices) >= 3:
        centres.append(piece.nearest_boundary_points(_distinct_rows(triple_centres(vertices))))
    return _distinct_rows(np.vstack(centres))


def _distinct_rows(points: FloatArray) -> FloatArray:
    """Points with repetitions left out, in their order."""
    keys = np.round(points / LENGTH_M).astype(np.int64)
    _, first = np.unique(keys, axis=0, return_index=True)
    return points[np.sort(first)]


def _covering_sets(holds: BoolArray, count: int) -> np.ndarray[tuple[int, int], np.dtype[np.int64]]:
    """All sets of `count` candidates that together hold every vertex, shape (n, count)."""
    everything = np.arange(len(holds))
    if count == 1:
        return everything[holds.all(axis=1)][:, None]
    if count == 2:
        pairs = [_partners(holds, int(i)) for i in np.flatnonzero(holds[:, 0])]
        return np.vstack(pairs) if pairs else np.empty((0, 2), dtype=np.int64)
    sets = [s for s in combinations(range(len(holds)), count) if holds[list(s)].any(axis=0).all()]
    return np.array(sets, dtype=np.int64).reshape(-1, count)


def _partners(holds: BoolArray, one: int) -> np.ndarray[tuple[int, int], np.dtype[np.int64]]:
    """The pairs in which another candidate holds all that this one leaves."""
    left = ~holds[one]
    others = np.flatnonzero(holds[:, left].all(axis=1))
    return np.column_stack([np.full(len(others), one), others])


def _is_first(ranks: FloatArray) -> BoolArray:
    """Which rows are smallest, compared column by column to the tolerance."""
    best = np.ones(len(ranks), dtype=bool)
    for column in ranks.T:
        best &= column <= column[best].min() + LENGTH_M
    return best


def _distinct(covers: FloatArray) -> tuple[Cover, ...]:
    """Covers, shape (n, count, 2), as sets of points: those that differ only in order are one."""
    seen: dict[tuple[tuple[int, int], ...], Cover] = {}
    for cover in covers:
        points = sorted((float(x), float(y)) for x, y in cover)
        key = tuple(sorted((grid_key(x), grid_key(y)) for x, y in points))
        seen.setdefault(key, tuple(points))
    return tuple(seen.values())
