"""Gather shapes that move as one into few convex hulls, without filling in what lies between them.

A hull for each shape is exact, but dozens of hulls cost time, and one hull of all is fat where a link is bent. So the
two clusters that waste the least volume together become one, as long as little is wasted or there are too many.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray

if TYPE_CHECKING:
    from scipy.spatial import ConvexHull

WASTE_MAX = 0.3
"""The largest share of a cluster's hull that none of its shapes fills."""

WASTE_MAX_M3 = 5e-5
"""A volume that may be wasted in any case: that of a cube of 37 mm."""

_SAMPLES = 200
"""Points of each shape that are tested for whether others fill them too."""

_DIRECTIONS = 96
"""Directions whose extreme corners stand for a shape while clusters are sought."""


@dataclass(frozen=True, slots=True, eq=False)
class _Cluster:
    """Shapes with a common hull.

    Attributes:
        members: the numbers of the shapes, the largest first.
        corners: some corners of their hull (m), shape (n, 3).
        volume_m3: its volume.
        wasted_m3: how much of it no shape fills, roughly.
    """

    members: tuple[int, ...]
    corners: FloatArray
    volume_m3: float
    wasted_m3: float

    @property
    def is_tight(self) -> bool:
        """Whether little is wasted."""
        return self.wasted_m3 <= max(WASTE_MAX * self.volume_m3, WASTE_MAX_M3)


def clusters(clouds: Sequence[FloatArray], at_most: int) -> list[tuple[int, ...]]:
    """Return clusters of shapes, the largest first: the numbers of each one's shapes, the largest first.

    Args:
        clouds: the corners of each shape's hull (m), in one frame; see `hull_corners`.
        at_most: how many clusters there may be.
    """
    few = [cloud[np.unique(np.argmax(cloud @ _directions().T, axis=0))] for cloud in clouds]
    filling = _Filling(few)
    found = [_cluster((number,), cloud, filling) for number, cloud in enumerate(few)]
    joined: dict[frozenset[tuple[int, ...]], _Cluster] = {}
    while len(found) > 1:
        for a, b in combinations(found, 2):
            if _key((a, b)) not in joined:
                large, small = (a, b) if a.volume_m3 >= b.volume_m3 else (b, a)
                both = np.vstack([large.corners, small.corners])
                joined[_key((a, b))] = _cluster((*large.members, *small.members), both, filling)
        a, b = min(
            combinations(found, 2), key=lambda two: joined[_key(two)].wasted_m3 - two[0].wasted_m3 - two[1].wasted_m3
        )
        best = joined[_key((a, b))]
        if len(found) <= at_most and not best.is_tight:
            break
        found = [best, *(one for one in found if one is not a and one is not b)]
    return [one.members for one in sorted(found, key=lambda one: -one.volume_m3)]


def _key(two: tuple[_Cluster, _Cluster]) -> frozenset[tuple[int, ...]]:
    return frozenset((two[0].members, two[1].members))


def _cluster(members: tuple[int, ...], points: FloatArray, filling: "_Filling") -> _Cluster:
    hull = _hull(points)
    volume_m3 = float(hull.volume)
    return _Cluster(members, points[hull.vertices], volume_m3, max(volume_m3 - filling.volume_m3(members), 0.0))


class _Filling:
    """The volume of overlapping shapes together."""

    def __init__(self, clouds: Sequence[FloatArray]) -> None:
        """Sample points of each shape, and ask which other shapes they are in."""
        rng, hulls = np.random.default_rng(0), [_hull(cloud) for cloud in clouds]
        sides = [hull.equations for hull in hulls]
        self._volumes_m3 = [float(hull.volume) for hull in hulls]
        points = [_inner(cloud, planes, rng) for cloud, planes in zip(clouds, sides, strict=True)]
        self._is_in = [[_are_inside(some, planes) for planes in sides] for some in points]

    def volume_m3(self, members: Sequence[int]) -> float:
        """Return the volume of the union of some shapes."""
        filled_m3 = 0.0
        for at, member in enumerate(members):
            is_known = np.any([self._is_in[member][earlier] for earlier in members[:at]], axis=0)
            filled_m3 += self._volumes_m3[member] * (1.0 - float(np.mean(is_known)))
        return filled_m3


def _inner(cloud: FloatArray, planes: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Return points of a convex shape, spread evenly; its middle where none is hit."""
    some = rng.uniform(cloud.min(axis=0), cloud.max(axis=0), (10 * _SAMPLES, 3))
    inside: FloatArray = some[_are_inside(some, planes)][:_SAMPLES]
    return inside if len(inside) else cloud.mean(axis=0)[None]


def _are_inside(points: FloatArray, planes: FloatArray) -> BoolArray:
    inside: BoolArray = np.all(points @ planes[:, :3].T <= -planes[:, 3], axis=1)
    return inside


@cache
def _directions() -> FloatArray:
    """Return directions spread evenly, after Fibonacci, shape (n, 3)."""
    number = np.arange(_DIRECTIONS) + 0.5
    height, turn = 1.0 - 2.0 * number / _DIRECTIONS, number * math.pi * (3.0 - math.sqrt(5.0))
    flat = np.sqrt(1.0 - height**2)
    return np.column_stack([flat * np.cos(turn), flat * np.sin(turn), height])


def _hull(points: FloatArray) -> "ConvexHull":
    from scipy.spatial import ConvexHull  # slow to import, and needed only where shapes are made

    return ConvexHull(points)
