"""The parts of a stack's outline at which cloth turns over.

Cloth turns over in a loop, not at a line: a crease lies some millimetres inside of it, while an edge of the cloth lies
where it was put down. So points seen at creases and at edges of the cloth are not alike.
"""

from dataclasses import dataclass

import numpy as np

from app.rehearsal.vision.outline_edges import OutlineEdges
from planner.cloth.cloth_state import ClothState
from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.region import Region
from planner.geometry.ring import after

_ON_M = 1e-4
"""An edge of a layer nearer to the pattern's border than that is one of the cloth (m)."""

_AT_CREASE_M = 0.002
"""A point of the outline nearer to a crease than that may be one of it (m)."""

_AT_EDGE_M = 0.0015
"""A point of the outline nearer to an edge of the cloth than that is one of it (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class CreaseEdges:
    """The borders of all layers of a stack, article frame.

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
            points: article frame (m).
            slack_m: how far the crease of the last fold may be from where it is planned (m).
        """
        if not len(self.creases.starts):
            return np.zeros(len(points), dtype=bool)
        near = self.creases.gaps(points) <= _AT_CREASE_M + slack_m
        return np.asarray(near & (self.edges.gaps(points) > _AT_EDGE_M))
