"""Writes the folding of a garment in the FOLD format, version 1.2 (github.com/edemaine/fold, doc/spec.md).

The key frame is the crease pattern, with the creases of the finished garment. Each further frame is the cloth after
one more fold; it inherits the mesh and has its own positions, creases and layer order.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from app.files.fold_mesh import FoldMesh
from app.jobs.job_pool import ShouldStop
from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import Garment
from planner.geometry.pose import FloatArray
from planner.geometry.region import Region
from planner.geometry.tolerance import DECIMALS, EDGE_RAD

SPEC = 1.2

_ANGLE_DEG = {"B": 0, "F": 0, "M": -180, "V": 180}
"""Fold angles by assignment: boundary, flat, mountain, valley (degrees)."""

_Edges = dict[tuple[int, int], tuple[int, ...]]


def fold_format(
    garment: Garment, cloths: Sequence[ClothState], should_stop: ShouldStop = lambda: False
) -> dict[str, Any]:
    """Return a garment and its folding as a FOLD file, lengths in m in the article frame.

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
