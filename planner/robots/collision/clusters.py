"""Gather shapes that move as one into few convex hulls, without filling in what lies between them.

A hull for each shape is exact, but dozens of hulls cost time, and one hull of all is fat where a link is bent. So the
two clusters that waste the least volume together become one, as long as little is wasted or there are too many.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from planner.geometry.pose import FloatArray

WASTE_MAX = 0.3
"""The largest share of a cluster's hull that none of its shapes fills."""

WASTE_MAX_M3 = 5e-5
"""A volume that may be wasted in any case: that of a cube of 37 mm."""

_SAMPLES = 500
"""Points of a hull of which it is asked whether a shape fills them."""


@dataclass(frozen=True, slots=True, eq=False)
class Cluster:
    """Shapes with a common hull.

    Attributes:
        members: the numbers of the shapes, the largest first.
        points: the corners of their hull (m), shape (n, 3).
        volume_m3: its volume.
        wasted_m3: how much of it no shape fills, roughly.
        sides: for each shape its sides' normals and offsets, shape (f, 4).
    """

    members: tuple[int, ...]
    points: FloatArray
    volume_m3: float
    wasted_m3: float
    sides: tuple[FloatArray, ...]

    @property
    def is_tight(self) -> bool:
        """Whether little is wasted."""
        return self.wasted_m3 <= max(WASTE_MAX * self.volume_m3, WASTE_MAX_M3)


def clusters(clouds: Sequence[FloatArray], at_most: int) -> list[Cluster]:
    """Return clusters of shapes, the largest first.

    Args:
        clouds: the corners of each shape's hull (m), in one frame; see `hull_corners`.
        at_most: how many clusters there may be.
    """
    found = [_cluster((number,), cloud) for number, cloud in enumerate(clouds)]
    joined: dict[frozenset[tuple[int, ...]], Cluster] = {}
    while len(found) > 1:
        for a, b in combinations(found, 2):
            key = _key((a, b))
            if key not in joined:
                large, small = (a, b) if a.volume_m3 >= b.volume_m3 else (b, a)
                both = np.vstack([large.points, small.points])
                joined[key] = _cluster((*large.members, *small.members), both, (*large.sides, *small.sides))
        a, b = min(combinations(found, 2), key=lambda two: _more_waste_m3(joined[_key(two)], two))
        best = joined[_key((a, b))]
        if len(found) <= at_most and not best.is_tight:
            break
        found = [best, *(one for one in found if one is not a and one is not b)]
    return sorted(found, key=lambda one: -one.volume_m3)


def _key(two: tuple[Cluster, Cluster]) -> frozenset[tuple[int, ...]]:
    return frozenset((two[0].members, two[1].members))


def _more_waste_m3(joined: Cluster, two: tuple[Cluster, Cluster]) -> float:
    return joined.wasted_m3 - two[0].wasted_m3 - two[1].wasted_m3


def _cluster(members: tuple[int, ...], points: FloatArray, sides: tuple[FloatArray, ...] = ()) -> Cluster:
    from scipy.spatial import ConvexHull  # slow to import, and needed only where shapes are made

    hull = ConvexHull(points)
    volume_m3, corners = float(hull.volume), points[hull.vertices]
    if not sides:
        return Cluster(members, corners, volume_m3, 0.0, (np.unique(hull.equations, axis=0),))
    low, high = corners.min(axis=0), corners.max(axis=0)
    some = np.random.default_rng(0).uniform(low, high, (_SAMPLES, 3))
    is_filled = np.zeros(_SAMPLES, dtype=np.bool_)
    for planes in sides:
        is_filled |= (some @ planes[:, :3].T <= -planes[:, 3]).all(axis=1)
    filled_m3 = float(is_filled.mean() * np.prod(high - low))
    return Cluster(members, corners, volume_m3, max(volume_m3 - filled_m3, 0.0), sides)
