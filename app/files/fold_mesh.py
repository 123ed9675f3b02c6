"""The folded cloth as one mesh: what all folds together cut the pattern into, and where each piece lies step by step.

Layers only ever get smaller, so the pieces of the final stack are the faces for all steps: at an earlier step a face
is a part of the layer from which it was cut. A corner of one face on the edge of another becomes a corner of both, so
that two faces share whole edges. Corners that lie at one place in the pattern are one vertex as long as they stay
together in every step; cloth hangs together, so they do.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.layer import Layer
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import LENGTH_M

_CELL_M = 4 * LENGTH_M
"""Corners nearer to each other than this are one (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class FoldMesh:
    """Faces and vertices, and where they are in each step; step 0 is the cloth spread out.

    Attributes:
        places: where each vertex lies, shape (steps, vertices, 2), article frame (m).
        faces: the vertices of each face, counter-clockwise in the pattern.
        layers: for each step the layer of each face: its place in the stack, from the bottom.
        is_turned: for each step whether each face shows its back.
    """

    places: FloatArray
    faces: tuple[tuple[int, ...], ...]
    layers: tuple[tuple[int, ...], ...]
    is_turned: tuple[tuple[bool, ...], ...]

    @staticmethod
    def of(cloths: Sequence[ClothState]) -> "FoldMesh":
        """The mesh of a garment by its stacks before the first fold, and after each."""
        ways = _ways(cloths)
        rings = _matched([layer.pattern_piece.whole_ring for layer in cloths[-1].layers])
        carried = [
            np.array([cloths[step].layers[number].isometry.apply(ring) for step, number in enumerate(way)])
            for ring, way in zip(rings, ways, strict=True)
        ]
        places: list[FloatArray] = []
        found: dict[tuple[int, int], list[int]] = {}
        faces = []
        for ring, corners in zip(rings, carried, strict=True):
            faces.append(
                tuple(_vertex(ring[i], corners[:, i], places, found) for i in range(len(ring))),
            )
        steps = range(len(cloths))
        layers = tuple(tuple(way[step] for way in ways) for step in steps)
        is_turned = tuple(
            tuple(cloths[step].layers[number].isometry.is_mirrored for number in layers[step]) for step in steps
        )
        return FoldMesh(np.array(places).transpose(1, 0, 2), tuple(faces), layers, is_turned)

    @property
    def edges(self) -> dict[tuple[int, int], tuple[int, ...]]:
        """The faces at each edge, the edges by their vertices, the smaller first; in the order of the faces."""
        found: dict[tuple[int, int], list[int]] = {}
        for number, face in enumerate(self.faces):
            for a, b in zip(face, (*face[1:], face[0]), strict=True):
                found.setdefault((min(a, b), max(a, b)), []).append(number)
        return {edge: tuple(numbers) for edge, numbers in found.items()}


def _ways(cloths: Sequence[ClothState]) -> list[list[int]]:
    """For each layer of the final stack its number in each step's stack."""
    ways = [[number] for number in range(len(cloths[-1].layers))]
    for before, after in zip(cloths[-2::-1], cloths[:0:-1], strict=True):
        parents = [_parent(layer, before) for layer in after.layers]
        for way in ways:
            way.append(parents[way[-1]])
    return [way[::-1] for way in ways]


def _parent(layer: Layer, before: ClothState) -> int:
    """The layer of the stack before from which a layer was cut."""
    for number, whole in enumerate(before.layers):
        if whole.pattern_piece is layer.pattern_piece:
            return number
    inside = layer.pattern_piece.inner_point
    return next(number for number, whole in enumerate(before.layers) if whole.pattern_piece.contains(inside))


def _matched(rings: Sequence[FloatArray]) -> list[FloatArray]:
    """Rings in whose edges the corners of others that lie on them are corners too, shapes (n, 2), m."""
    corners = np.unique(np.round(np.concatenate(rings) / LENGTH_M), axis=0) * LENGTH_M
    matched = []
    for ring in rings:
        points = [ring[:1]]
        for start, end in zip(ring, np.roll(ring, -1, axis=0), strict=True):
            between = _between(start, end, corners)
            points += [between, end[None]]
        matched.append(np.concatenate(points)[:-1])
    return matched


def _between(start: FloatArray, end: FloatArray, points: FloatArray) -> FloatArray:
    """Those of some points that lie on a segment, away from its ends, in the order in which it passes them."""
    length = float(np.hypot(*(end - start)))
    direction = (end - start) / length
    along = (points - start) @ direction
    off = np.abs((points - start) @ np.array([-direction[1], direction[0]]))
    is_there = (off <= 2 * LENGTH_M) & (along > 2 * LENGTH_M) & (along < length - 2 * LENGTH_M)
    order = np.argsort(along[is_there])
    return np.asarray(start + along[is_there][order][:, None] * direction)


def _vertex(
    corner: FloatArray, carried: FloatArray, places: list[FloatArray], found: dict[tuple[int, int], list[int]]
) -> int:
    """The vertex at a corner that lies in these places step by step; a new one if there is none yet."""
    cell = (round(float(corner[0]) / _CELL_M), round(float(corner[1]) / _CELL_M))
    for near in ((cell[0] + dx, cell[1] + dy) for dx in (0, -1, 1) for dy in (0, -1, 1)):
        for number in found.get(near, ()):
            if np.abs(places[number] - carried).max() <= _CELL_M:
                return number
    places.append(carried)
    found.setdefault(cell, []).append(len(places) - 1)
    return len(places) - 1
