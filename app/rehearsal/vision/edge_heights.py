"""The heights at which a camera sees the outline of a stack, and so where over the table that lies.

A picture tells the direction in which an edge is seen, and where it lies only together with its height. Layers that end
at an edge lie on one another there; at a crease cloth turns over in a loop that is higher than that. Either is taken
for round, so that its outermost point is at half of its height; a camera that leans outwards over an edge sees a point
above that, one that leans inwards a point below.
"""

from dataclasses import dataclass

import numpy as np

from app.rehearsal.camera.camera import Camera
from app.rehearsal.vision.outline_edges import CreaseEdges, OutlineEdges
from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import Garment
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from planner.geometry.tolerance import LENGTH_M

LOOP_M = 0.016
"""The height of the loop of a crease on which nothing lies: .907 bending lengths of 18 mm (m)."""

_INSIDE_M = 0.01
"""How far inside of an edge the layers are counted that end at it (m)."""

_SLACK_M = 0.002
"""The largest distance of the outline from a crease on it (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class EdgeHeights:
    """The heights of a stack's outline.

    Attributes:
        outline: the outline, garment frame.
        borders: which parts of it are creases.
        layers: what each layer covers.
        layer_m: the height of a layer (m).
    """

    outline: OutlineEdges
    borders: CreaseEdges
    layers: tuple[Region, ...]
    layer_m: float

    @staticmethod
    def of(stack: ClothState, garment: Garment) -> "EdgeHeights":
        """Return the heights of a stack of a garment."""
        layers = tuple(layer.region for layer in stack.layers)
        return EdgeHeights(
            OutlineEdges.of(stack.silhouette), CreaseEdges.of(stack, garment.pattern), layers, garment.layer_m
        )

    @property
    def middle_m(self) -> float:
        """Half of the height of all layers (m)."""
        return self.layer_m * len(self.layers) / 2.0

    def seen_at(self, camera: Camera, pixels: FloatArray, placement: Pose2) -> FloatArray:
        """Return where pixels that show the outline are, each at the height of its edge, shape (n, 2), table frame, m.

        Args:
            camera: the camera.
            pixels: the pixels, shape (n, 2).
            placement: about where the stack lies, the garment frame in the table frame.
        """
        places = camera.on_plane(pixels, self.middle_m)
        inner = placement.to_inner(places)
        distances, outwards = self.outline.distances(inner)
        halves = self.halves(inner - distances[:, None] * outwards, outwards)
        along = (places - np.array(camera.position[:2])) / (camera.position[2] - self.middle_m)
        normals = Pose2(0.0, 0.0, placement.yaw_rad).to_outer(outwards)
        leans = np.arctan((along * normals).sum(axis=1))
        return camera.on_plane(pixels, halves * (1.0 + np.tan(leans / 2.0)))

    def halves(self, points: FloatArray, outwards: FloatArray) -> FloatArray:
        """Return half of the height of the edge at points of the outline, shape (n,), m.

        Args:
            points: the points, shape (n, 2), garment frame.
            outwards: unit vectors that lead out of the stack there, shape (n, 2).
        """
        inside = points - _INSIDE_M * outwards
        counts = sum((layer.distances_to(inside) <= LENGTH_M).astype(np.float64) for layer in self.layers)
        is_crease = self.borders.are_creases(points, _SLACK_M)
        lowest_m = np.where(is_crease, LOOP_M - 2.0 * self.layer_m, 0.0)  # a loop is as high with two layers
        return np.asarray((lowest_m + self.layer_m * np.maximum(counts, 1.0)) / 2.0)
