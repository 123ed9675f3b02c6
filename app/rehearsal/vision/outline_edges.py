"""The outline of a figure as edges, and how far points are from it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.cloth.cloth_state import ClothState
from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.region import Region
from planner.geometry.ring import after

_HAIR_M = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class OutlineEdges:
    """The outer edges of a region, counter-clockwise.

    Attributes:
        starts: where each edge starts, shape (m, 2), m.
        ends: where each ends, shape (m, 2), m.
    """

    starts: FloatArray
    ends: FloatArray

    @staticmethod
    def of(region: Region) -> "OutlineEdges":
        """Return the edges of a region's outer rings; holes have none."""
        rings = region.rings
        return OutlineEdges(np.concatenate(rings), np.concatenate([after(ring) for ring in rings]))

    @property
    def length(self) -> float:
        """The length of all edges (m)."""
        return float(np.hypot(*(self.ends - self.starts).T).sum())

    def spaced(self, count: int) -> FloatArray:
        """Return points evenly along the edges, shape (count, 2), m."""
        lengths = np.hypot(*(self.ends - self.starts).T)
        reached = np.concatenate([[0.0], lengths.cumsum()])
        places = (np.arange(count) + 0.5) / count * reached[-1]
        edge = np.clip(np.searchsorted(reached, places, side="right") - 1, 0, len(lengths) - 1)
        share = (places - reached[edge]) / lengths[edge]
        return np.asarray(self.starts[edge] + share[:, None] * (self.ends[edge] - self.starts[edge]))

    def distances(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return how far points, shape (n, 2), are outside the outline, and the unit vectors that lead outwards.

        Distances have shape (n,), m, and are negative inside; the vectors have shape (n, 2).
        """
        away, nearest = self._apart(points)
        distance = np.hypot(*away.T)
        along = (self.ends - self.starts)[nearest]
        sign = np.where(self._contain(points), -1.0, 1.0)
        edge = along / np.hypot(*along.T)[:, None]
        normal = np.column_stack([edge[:, 1], -edge[:, 0]])
        is_on = distance < _HAIR_M
        outwards = np.where(is_on[:, None], normal, sign[:, None] * away / np.maximum(distance, _HAIR_M)[:, None])
        return sign * distance, outwards

    def gaps(self, points: FloatArray) -> FloatArray:
        """Return how far points, shape (n, 2), are from the nearest edge, shape (n,), m."""
        return np.asarray(np.hypot(*self._apart(points)[0].T))

    def _apart(self, points: FloatArray) -> tuple[FloatArray, NDArray[np.int64]]:
        """Return the vectors to points from the nearest of the edges, shape (n, 2), and which edges, shape (n,)."""
        along = self.ends - self.starts
        from_start = points[:, None] - self.starts
        share = np.clip((from_start * along).sum(axis=2) / (along**2).sum(axis=1), 0.0, 1.0)
        apart = from_start - share[:, :, None] * along
        nearest = (apart**2).sum(axis=2).argmin(axis=1)
        return apart[np.arange(len(points)), nearest], nearest

    def _contain(self, points: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Return which points lie inside: a ray to the right crosses an odd number of edges."""
        x, y = points.T[:, :, None]
        (ax, ay), (bx, by) = self.starts.T, self.ends.T
        crosses = (ay > y) != (by > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            at_x = ax + (y - ay) / (by - ay) * (bx - ax)
        return np.asarray((crosses & (x < at_x)).sum(axis=1) % 2 == 1)


_ON_M = 1e-4
"""The largest distance from the pattern's border to a layer's edge that is an edge of the cloth (m)."""

_AT_CREASE_M = 0.002
"""The largest distance from a crease to a point of the outline that may lie on it (m)."""

_AT_EDGE_M = 0.0015
"""The largest distance from an edge of the cloth to a point of the outline that lies on it (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class CreaseEdges:
    """The borders of all layers of a stack, garment frame.

    Attributes:
        creases: where they are joined to each other.
        edges: where the cloth ends.
    """

    creases: OutlineEdges
    edges: OutlineEdges

    @staticmethod
    def of(stack: ClothState, pattern: Region) -> "CreaseEdges":
        """Return the borders of the layers of a stack made of a pattern."""
        ends: list[FloatArray] = []
        are_ends: list[BoolArray] = []
        for layer in stack.layers:
            for ring in layer.pattern_piece.rings:
                onward = after(ring)
                ends.append(np.stack([layer.isometry.apply(ring), layer.isometry.apply(onward)], axis=1))
                middles = (ring + onward) / 2.0
                gaps = np.hypot(*(pattern.nearest_boundary_points(middles) - middles).T)
                are_ends.append(gaps <= _ON_M)
        pairs, is_end = np.concatenate(ends), np.concatenate(are_ends)
        creases, edges = pairs[~is_end], pairs[is_end]
        return CreaseEdges(OutlineEdges(creases[:, 0], creases[:, 1]), OutlineEdges(edges[:, 0], edges[:, 1]))

    def are_creases(self, points: FloatArray, slack_m: float = 0.0) -> BoolArray:
        """Return which points of the outline, shape (n, 2), are of a crease, not of an edge; shape (n,).

        Args:
            points: garment frame (m).
            slack_m: how far the crease of the last fold may be from where it is planned (m).
        """
        if not len(self.creases.starts):
            return np.zeros(len(points), dtype=bool)
        near = self.creases.gaps(points) <= _AT_CREASE_M + slack_m
        return np.asarray(near & (self.edges.gaps(points) > _AT_EDGE_M))
