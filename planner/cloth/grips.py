"""Choice of grips: the fewest places that hold every vertex that must be held (paper, section 8).

One grip holds every such vertex within its radius. Candidates are the vertices themselves and the points of the
boundary nearest to the centre of the smallest circle round each two and each three of them. Among the smallest
covers the best is the one whose largest distance from a vertex to its grip is smallest, then the second
largest, and so on; covers that tie are all kept, otherwise a mirrored garment would be planned differently.

A grip near the end of its reach lets corners fold under. So the firm covers are those of the fewest grips that hold
every vertex within `FIRM_M`. Where no cover does, they are the nearest, of however many grips.

A round cloth has thousands of candidates, too many to rank all their pairs. But the largest distance decides nearly
always, and its best value can be found alone: the smallest radius with which some pair covers all vertices. Only the
pairs that cover all with that radius are ranked.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from planner.cloth.grip_candidates import grip_candidates
from planner.geometry.pose import BoolArray, FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M, grid_key

FIRM_M = 0.08
"""The distance within which a grip holds firmly, if its radius is no less (m).

In simulated folds (docs/rehearsal.md) corners 10 cm from a hand folded under in some runs, and from 12.4 cm on
in all.
"""

_RANKED_AT_ONCE = 64
"""Up to this many candidates, all pairs are ranked directly."""

_WORD = 64
"""Bits of a word."""

_COMBINED_AT_ONCE, _ROWS = 200_000, 4096
"""The most sets of three candidates and more that are tried, and how many of them at a time."""

Cover = tuple[Point2, ...]
IntArray: TypeAlias = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class GripCovers:
    """The ways to hold a piece of cloth.

    Attributes:
        vertices: the vertices that must be held, frame of the cloth (m).
        covers: equally good sets of the fewest grips; empty when `at_most` grips do not suffice.
        firm: equally good sets that hold firmly, or else as nearly so as any; often the same.
        firm_m: the largest distance from a vertex to its grip that counts as firm here (m).
    """

    vertices: tuple[Point2, ...]
    covers: tuple[Cover, ...]
    firm: tuple[Cover, ...]
    firm_m: float = FIRM_M

    @property
    def every(self) -> tuple[Cover, ...]:
        """All sets of grips, the firm ones first."""
        return self.firm if self.firm == self.covers else (*self.firm, *self.covers)

    @property
    def is_holdable(self) -> bool:
        """Whether the grips allowed suffice."""
        return bool(self.covers)

    @property
    def count(self) -> int | None:
        """The number of grips needed; None if that is more than were allowed."""
        return len(self.covers[0]) if self.covers else None


def grip_covers(
    piece: Region,
    vertices: FloatArray,
    radius_m: float,
    at_most: int,
    baseline: tuple[Segment, ...] = (),
    is_lost: Callable[[FloatArray], BoolArray] | None = None,
) -> GripCovers:
    """Return the best sets of at most `at_most` grips that hold all vertices.

    Args:
        piece: the cloth whose boundary is gripped.
        vertices: the vertices that must be held, shape (n, 2), m.
        radius_m: the radius within which one grip holds (m), inclusive.
        at_most: the number of grippers.
        baseline: the part of the boundary that stays in place.
        is_lost: which vertices grips, shape (m, 2), do not hold though they are near them, shape (m, n); None for none.
    """
    points = tuple((float(x), float(y)) for x, y in vertices)
    if not points:
        return GripCovers(points, ((),), ((),))
    if _needs_more(vertices, radius_m, at_most):
        return GripCovers(points, (), ())
    candidates = grip_candidates(piece, vertices, baseline)
    lost = None if is_lost is None else is_lost(candidates)
    covers = best_covers(candidates, vertices, radius_m, at_most, lost=lost)
    firm = firm_covers(candidates, vertices, radius_m, at_most, lost)
    return GripCovers(points, covers, firm, max(min(FIRM_M, radius_m), largest_m(firm, vertices)))


def firm_covers(
    candidates: FloatArray, vertices: FloatArray, radius_m: float, at_most: int, lost: BoolArray | None = None
) -> tuple[Cover, ...]:
    """Return the best covers that hold all vertices within `FIRM_M`; if none does, the nearest within the radius.

    Args:
        candidates: points of the cloth, shape (m, 2), m.
        vertices: the vertices that must be held, shape (n, 2), m.
        radius_m: the radius within which one grip holds (m).
        at_most: the number of grippers.
        lost: which vertices each of the candidates does not hold though it is near them, shape (m, n); None for none.
    """
    firm = best_covers(candidates, vertices, min(FIRM_M, radius_m), at_most, lost=lost)
    if firm or radius_m <= FIRM_M:
        return firm
    nearest: tuple[Cover, ...] = ()
    for covers in (best_covers(candidates, vertices, radius_m, count, count, lost) for count in range(1, at_most + 1)):
        if covers and (not nearest or largest_m(covers, vertices) < largest_m(nearest, vertices) - LENGTH_M):
            nearest = covers
    return nearest


def largest_m(covers: tuple[Cover, ...], vertices: FloatArray) -> float:
    """Return the largest distance from a vertex to its grip in covers that are equally good (m); 0 without any."""
    if not covers or not len(vertices):
        return 0.0
    gaps = np.array(covers[0])[:, None] - vertices
    return float(np.hypot(*gaps.transpose(2, 0, 1)).min(axis=0).max())


def best_covers(
    candidates: FloatArray,
    vertices: FloatArray,
    radius_m: float,
    at_most: int,
    at_least: int = 1,
    lost: BoolArray | None = None,
) -> tuple[Cover, ...]:
    """Return the best covers of the vertices among the given candidates, shape (m, 2), ties included."""
    distances = np.hypot(*(candidates[:, None, :] - vertices[None, :, :]).transpose(2, 0, 1))
    if lost is not None:
        distances[lost] = np.inf
    useful = (distances <= radius_m + LENGTH_M).any(axis=1)
    candidates, distances = candidates[useful], distances[useful]
    for count in range(at_least, at_most + 1):
        chosen = _covering_sets(distances, radius_m + LENGTH_M, count)
        if len(chosen):
            ranks = -np.sort(-distances[chosen].min(axis=1), axis=1)
            return _distinct(candidates[chosen[_is_first(ranks)]])
    return ()


def _needs_more(vertices: FloatArray, radius_m: float, at_most: int) -> bool:
    """Return whether more than `at_most` vertices lie so far apart that no grip holds two of them (greedy)."""
    left = vertices
    for _ in range(at_most):
        if not len(left):
            return False
        left = left[np.hypot(*(left - left[0]).T) > 2 * (radius_m + LENGTH_M)]
    return len(left) > 0


def _covering_sets(distances: FloatArray, radius_m: float, count: int) -> IntArray:
    """Return the sets of `count` candidates that hold every vertex, shape (n, count); of pairs the best alone.

    Args:
        distances: of candidates to vertices, shape (m, k), m.
        radius_m: the radius within which a grip holds (m), inclusive.
        count: the number of grips.
    """
    if count == 1:
        return np.flatnonzero((distances <= radius_m).all(axis=1))[:, None]
    if count == 2:
        is_few = len(distances) <= _RANKED_AT_ONCE
        needed_m = radius_m if is_few else _least_radius(distances, radius_m) + LENGTH_M
        return _covering_pairs(distances <= needed_m)
    return _covering_combinations(distances <= radius_m, count)


def _covering_combinations(holds: BoolArray, count: int) -> IntArray:
    """Return the sets of three candidates and more that between them hold every vertex, shape (n, count).

    Of many candidates only as many are combined as give `_COMBINED_AT_ONCE` sets, evenly spread.
    """
    most = count
    while math.comb(most + 1, count) <= _COMBINED_AT_ONCE:
        most += 1
    some = np.unique(np.linspace(0, len(holds) - 1, min(most, len(holds))).round().astype(np.int64))
    sets = np.array([*combinations(some.tolist(), count)], dtype=np.int64).reshape(-1, count)
    parts = np.array_split(sets, max(1, len(sets) // _ROWS))
    return np.vstack([part[np.logical_or.reduce([holds[row] for row in part.T]).all(axis=1)] for part in parts])


def _least_radius(distances: FloatArray, radius_m: float) -> float:
    """Return the smallest radius with which a pair of candidates holds every vertex; -1 if the given one is too small.

    One of the pair must hold the vertex that the fewest candidates can hold. For each of those only partners that
    improve on the best pair so far are considered, and soon hardly any are left.
    """
    is_held = distances <= radius_m
    hardest = is_held.sum(axis=0).argmin()
    least_m, lacks = np.inf, _lacking(is_held)
    for one in np.flatnonzero(is_held[:, hardest]):
        partners = _partners(lacks, one)
        if len(partners):
            least_m = float(np.minimum(distances[one], distances[partners]).max(axis=1).min())
            lacks = _lacking(distances < least_m)
    return least_m if np.isfinite(least_m) else -1.0


def _covering_pairs(holds: BoolArray) -> IntArray:
    """Return all pairs of candidates that together hold every vertex, shape (n, 2); the first holds vertex 0."""
    pairs, lacks = [np.empty((0, 2), dtype=np.int64)], _lacking(holds)
    for one in np.flatnonzero(holds[:, 0]):
        partners = _partners(lacks, one)
        pairs.append(np.column_stack([np.full(len(partners), one), partners]))
    return np.vstack(pairs)


def _lacking(holds: BoolArray) -> NDArray[np.uint64]:
    """Return the vertices that each candidate does not hold, as bits, shape (m, words)."""
    count, vertices = holds.shape
    padded = np.zeros((count, -(-vertices // _WORD) * _WORD), dtype=bool)
    padded[:, :vertices] = ~holds
    return np.packbits(padded, axis=1).view(np.uint64)


def _partners(lacks: NDArray[np.uint64], one: np.int64) -> IntArray:
    """Return the candidates that hold all vertices that a given one does not."""
    return np.flatnonzero(~(lacks & lacks[one]).any(axis=1))


def _is_first(ranks: FloatArray) -> BoolArray:
    """Return which rows are smallest, compared column by column to the tolerance."""
    best = np.ones(len(ranks), dtype=bool)
    for column in ranks.T:
        best &= column <= column[best].min() + LENGTH_M
    return best


def _distinct(covers: FloatArray) -> tuple[Cover, ...]:
    """Return covers, shape (n, count, 2), without those that differ from another only in order."""
    seen: dict[tuple[tuple[int, int], ...], Cover] = {}
    for cover in covers:
        points = sorted((float(x), float(y)) for x, y in cover)
        key = tuple(sorted((grid_key(x), grid_key(y)) for x, y in points))
        seen.setdefault(key, tuple(points))
    return tuple(seen.values())
