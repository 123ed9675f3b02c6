"""Candidates for grips: the vertices that must be held, and points of the boundary that serve several of them.

A grip holds all vertices within its radius, so the best grip for a few of them is near the centre of the smallest
circle round them; two or three vertices determine that circle. If several points of the boundary are equally near to
a centre, all of them are candidates; otherwise a mirrored garment would be planned differently.
"""

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.smallest_circle import pair_centres, triple_centres
from planner.geometry.tolerance import LENGTH_M, grid_keys

_CIRCLED_MAX = 64
"""The most vertices round which circles are put; of more, this many are picked evenly: 400 have ten million triples."""


def grip_candidates(piece: Region, vertices: FloatArray, baseline: tuple[Segment, ...] = ()) -> FloatArray:
    """Return candidates for grips that hold vertices of a piece of cloth.

    Args:
        piece: the cloth whose boundary is gripped.
        vertices: the vertices that must be held, shape (n, 2), m, at least one.
        baseline: the part of the boundary that stays in place: a hand there lifts nothing.

    Returns:
        Shape (m, 2), m: the vertices first; no place twice.
    """
    some = _evenly(vertices)
    centres = [pair_centres(some), triple_centres(some)]
    near = piece.all_nearest_boundary_points(distinct_rows(np.vstack(centres)))
    found = distinct_rows(np.vstack([vertices, near]))
    for segment in baseline:
        found = found[segment.distances(found) > LENGTH_M]
    return found


def distinct_rows(points: FloatArray) -> FloatArray:
    """Return points, shape (n, 2), without repetitions, in their order."""
    x, y = grid_keys(points).T
    _, first = np.unique((x << 32) + y, return_index=True)
    return np.asarray(points[np.sort(first)])


def _evenly(vertices: FloatArray) -> FloatArray:
    """Return the vertices, thinned evenly to the most that are allowed, alike from either end."""
    count = len(vertices)
    if count <= _CIRCLED_MAX:
        return vertices
    half = np.round(np.linspace(0.0, (count - 1) / 2, _CIRCLED_MAX // 2)).astype(np.int64)
    return np.asarray(vertices[np.unique(np.concatenate([half, count - 1 - half]))])
