"""A layer: one piece of the pattern, and the isometry by which folding has carried it."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.split import cut_like


class Layer:
    """A connected piece of cloth lying flat in a stack; never changed after it is made.

    The piece is stored in the pattern's own coordinates with the isometry that carried it, so that every point can be
    traced to the pattern and folding to and fro accumulates no error.

    Attributes:
        pattern_piece: the piece as it lay in the pattern.
        isometry: from the pattern to where the piece lies now, garment frame.
    """

    def __init__(self, pattern_piece: Region, isometry: Isometry) -> None:
        self.pattern_piece = pattern_piece
        self.isometry = isometry

    @cached_property
    def region(self) -> Region:
        """The region that the layer covers, garment frame."""
        return self.pattern_piece.moved(self.isometry)

    @property
    def face(self) -> str:
        """The face of the cloth that looks up: "front" or "back"."""
        return "back" if self.isometry.is_mirrored else "front"

    @property
    def area(self) -> float:
        """Its area (m^2), taken in the pattern: the folded region is rounded to the grid."""
        return self.pattern_piece.area

    @property
    def ring(self) -> FloatArray:
        """The boundary of the folded layer, garment frame, counter-clockwise, shape (n, 2), m; nothing is rounded."""
        ring = self.isometry.apply(self.pattern_piece.whole_ring)
        return ring[::-1] if self.isometry.is_mirrored else ring

    def reflected(self, line: Segment) -> "Layer":
        """Return the layer folded over a line of the garment frame."""
        return Layer(self.pattern_piece, Isometry.reflection(line).after(self.isometry))

    def cut(self, line: Segment, moving: Region) -> tuple[tuple["Layer", ...], tuple["Layer", ...], tuple[float, ...]]:
        """Return the layer's parts inside the moving part, its other parts, and the areas of slivers (m^2).

        Args:
            line: the fold line, garment frame.
            moving: the part of the silhouette to the left of the line.
        """
        back = self.isometry.inverse
        line_in_pattern = Segment(back.apply_point(line.start), back.apply_point(line.end))
        found = cut_like(self.pattern_piece, line_in_pattern, lambda p: moving.contains(self.isometry.apply_point(p)))
        if not (found.moving and found.staying):
            return ((self,), (), ()) if found.moving else ((), (self,), ())
        return (
            tuple(Layer(p, self.isometry) for p in found.moving),
            tuple(Layer(p, self.isometry) for p in found.staying),
            tuple(p.area for p in found.slivers),
        )

    def to_pattern(self, point: Point2) -> Point2:
        """Return the position in the pattern of a point of the layer, garment frame (m)."""
        return self.isometry.inverse.apply_point(point)

    def to_dict(self) -> dict[str, Any]:
        """Return the layer as JSON: its polygon in the garment frame and the face that looks up."""
        return {"polygon": [[float(x), float(y)] for x, y in self.ring], "face": self.face}


def nearest_layers(layers: Sequence[Layer], pattern: FloatArray) -> NDArray[np.int64]:
    """Return which of the layers each point of the pattern, shape (n, 2), m, belongs to, shape (n,)."""
    return np.asarray(np.argmin([layer.pattern_piece.distances_to(pattern) for layer in layers], axis=0))
