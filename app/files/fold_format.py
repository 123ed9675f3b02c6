"""Writes the folding of a garment in the FOLD format, version 1.2 (github.com/edemaine/fold, doc/spec.md).

The key frame is the crease pattern, with the creases of the finished garment. Each further frame is the cloth after
one more fold; it inherits the mesh and has its own positions, creases and layer order.

The cloth is one mesh: the pieces into which all folds cut the pattern, and their place at each step. Layers only get
smaller, so the pieces of the final stack can serve as faces at all steps: earlier, a face is part of the layer from
which it is cut. Where a corner of one face lies on the edge of another, it becomes a corner of both, so that two faces
share whole edges. Corners at the same place of the pattern are one vertex if they stay together in every step, which
they do, because the cloth is connected.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import Garment
from planner.cloth.layer import Layer
from planner.deadline import ShouldStop
from planner.geometry.pose import FloatArray
from planner.geometry.region import Region
from planner.geometry.tolerance import DECIMALS, EDGE_RAD, LENGTH_M

_CELL_M = 4 * LENGTH_M
"""Distance within which corners are the same (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class FoldMesh:
    """Faces and vertices, and their positions at each step; step 0 is the cloth spread out.

    Attributes:
        places: the position of each vertex, shape (steps, vertices, 2), garment frame (m).
        faces: the vertices of each face, counter-clockwise in the pattern.
        layers: for each step the layer of each face, as its index in the stack from the bottom.
        is_turned: for each step whether each face shows its back.
    """

    places: FloatArray
    faces: tuple[tuple[int, ...], ...]
    layers: tuple[tuple[int, ...], ...]
    is_turned: tuple[tuple[bool, ...], ...]

    @staticmethod
    def of(cloths: Sequence[ClothState]) -> "FoldMesh":
        """Return the mesh of a garment, given its stacks before the first fold and after each."""
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
            faces.append(tuple(_vertex(ring[i], corners[:, i], places, found) for i in range(len(ring))))
        steps = range(len(cloths))
        layers = tuple(tuple(way[step] for way in ways) for step in steps)
        is_turned = tuple(
            tuple(cloths[step].layers[number].isometry.is_mirrored for number in layers[step]) for step in steps
        )
        return FoldMesh(np.array(places).transpose(1, 0, 2), tuple(faces), layers, is_turned)

    @property
    def edges(self) -> dict[tuple[int, int], tuple[int, ...]]:
        """The faces at each edge; an edge is its two vertices, the smaller first, in the order of the faces."""
        found: dict[tuple[int, int], list[int]] = {}
        for number, face in enumerate(self.faces):
            for a, b in zip(face, (*face[1:], face[0]), strict=True):
                found.setdefault((min(a, b), max(a, b)), []).append(number)
        return {edge: tuple(numbers) for edge, numbers in found.items()}


def _ways(cloths: Sequence[ClothState]) -> list[list[int]]:
    """Return, for each layer of the final stack, its index in each step's stack."""
    ways = [[number] for number in range(len(cloths[-1].layers))]
    for before, after in zip(cloths[-2::-1], cloths[:0:-1], strict=True):
        parents = [_parent(layer, before) for layer in after.layers]
        for way in ways:
            way.append(parents[way[-1]])
    return [way[::-1] for way in ways]


def _parent(layer: Layer, before: ClothState) -> int:
    """Return the index of the layer in the previous stack from which a layer was cut."""
    for number, whole in enumerate(before.layers):
        if whole.pattern_piece is layer.pattern_piece:
            return number
    inside = layer.pattern_piece.inner_point
    return next(number for number, whole in enumerate(before.layers) if whole.pattern_piece.contains(inside))


def _matched(rings: Sequence[FloatArray]) -> list[FloatArray]:
    """Return the rings with all corners of other rings that lie on their edges inserted, shapes (n, 2), m."""
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
    """Return the points that lie inside a segment, in order along it."""
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
    """Return the index of the vertex with these positions, one per step; add one if there is none."""
    cell = (round(float(corner[0]) / _CELL_M), round(float(corner[1]) / _CELL_M))
    for near in ((cell[0] + dx, cell[1] + dy) for dx in (0, -1, 1) for dy in (0, -1, 1)):
        for number in found.get(near, ()):
            if np.abs(places[number] - carried).max() <= _CELL_M:
                return number
    places.append(carried)
    found.setdefault(cell, []).append(len(places) - 1)
    return len(places) - 1


SPEC = 1.2

_ANGLE_DEG = {"B": 0, "F": 0, "M": -180, "V": 180}
"""Fold angles by assignment: boundary, flat, mountain, valley (degrees)."""

_Edges = dict[tuple[int, int], tuple[int, ...]]


def fold_format(
    garment: Garment, cloths: Sequence[ClothState], should_stop: ShouldStop = lambda: False
) -> dict[str, Any]:
    """Return a garment and its folding as a FOLD file, lengths in m in the garment frame.

    Args:
        garment: the garment.
        cloths: its stacks, spread out and after each fold.
        should_stop: called between frames; the remaining frames are left out once it is true.
    """
    mesh = FoldMesh.of(cloths)
    edges = mesh.edges
    last = len(cloths) - 1
    frames = []
    for step in range(1, len(cloths)):
        if should_stop():
            break
        frames.append(_folded(garment, mesh, edges, step))
    return {
        "file_spec": SPEC,
        "file_creator": "Pleat",
        "file_title": garment.title,
        "file_classes": ["singleModel", "diagrams"],
        "frame_title": "Spread out",
        "frame_classes": ["creasePattern"],
        "frame_attributes": _attributes(mesh, is_touching=False),
        "frame_unit": "m",
        "vertices_coords": mesh.places[0].round(DECIMALS).tolist(),
        "edges_vertices": [list(edge) for edge in edges],
        **_creases(mesh, edges, last),
        "faces_vertices": [list(face) for face in mesh.faces],
        "file_frames": frames,
    }


def _folded(garment: Garment, mesh: FoldMesh, edges: _Edges, step: int) -> dict[str, Any]:
    return {
        "frame_title": f"{step}: {garment.folds[step - 1].name}",
        "frame_classes": ["foldedForm"],
        "frame_attributes": _attributes(mesh, is_touching=True),
        "frame_unit": "m",
        "frame_parent": 0,
        "frame_inherit": True,
        "vertices_coords": mesh.places[step].round(DECIMALS).tolist(),
        **_creases(mesh, edges, step),
        "faceOrders": list(_orders(mesh, step)),
    }


def _attributes(mesh: FoldMesh, *, is_touching: bool) -> list[str]:
    is_convex = all(_is_convex(mesh.places[0][list(face)]) for face in mesh.faces)
    return [
        "2D",
        "manifold",
        "orientable",
        "selfTouching" if is_touching else "nonSelfTouching",
        "nonSelfIntersecting",
        "noCuts",
        "noJoins",
        "convexFaces" if is_convex else "nonConvexFaces",
    ]


def _is_convex(ring: FloatArray) -> bool:
    to_next = np.roll(ring, -1, axis=0) - ring
    (x, y), (then_x, then_y) = to_next.T, np.roll(to_next, -1, axis=0).T
    lengths = np.hypot(x, y) * np.hypot(then_x, then_y)
    return bool(np.all(x * then_y - y * then_x >= -EDGE_RAD * lengths))


def _creases(mesh: FoldMesh, edges: _Edges, step: int) -> dict[str, Any]:
    assignment = [_assignment(mesh, faces, step) for faces in edges.values()]
    return {"edges_assignment": assignment, "edges_foldAngle": [_ANGLE_DEG[kind] for kind in assignment]}


def _assignment(mesh: FoldMesh, faces: tuple[int, ...], step: int) -> str:
    """Return the FOLD assignment of the edge between two faces in a step.

    Faces are counter-clockwise with their front up. Where one shows its front and the other, above it, its back, the
    fronts face each other: a valley.
    """
    if len(faces) < 2:
        return "B"
    one, other = faces[:2]
    if mesh.is_turned[step][one] == mesh.is_turned[step][other]:
        return "F"
    front, back = (other, one) if mesh.is_turned[step][one] else (one, other)
    return "V" if mesh.layers[step][back] > mesh.layers[step][front] else "M"


def _orders(mesh: FoldMesh, step: int) -> Iterator[list[int]]:
    """Yield, for every two faces that overlap, [the upper, the lower, 1 if the lower shows its front, else -1]."""
    regions = [Region.polygon(mesh.places[step][list(face)].tolist()) for face in mesh.faces]
    bounds = np.array([region.bounds for region in regions])
    layers, is_turned = np.array(mesh.layers[step]), mesh.is_turned[step]
    for lower in np.argsort(layers, kind="stable"):
        low, high = bounds[lower, :2], bounds[lower, 2:]
        is_near = np.all((bounds[:, :2] < high) & (bounds[:, 2:] > low), axis=1)
        for upper in np.flatnonzero(is_near & (layers > layers[lower])):
            if _overlap(regions[lower], regions[upper]):
                yield [int(upper), int(lower), -1 if is_turned[lower] else 1]


def _overlap(one: Region, other: Region) -> bool:
    """Return whether two pieces of cloth overlap; the cheap test comes first and mostly decides."""
    if other.contains(one.inner_point) or one.contains(other.inner_point):
        return True
    return not one.intersection(other).is_sliver
