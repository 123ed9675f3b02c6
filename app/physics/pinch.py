"""Find the vertices of the cloth that two closing fingers pinch, by geometry alone: the layers are not known."""

import numpy as np
from numpy.typing import NDArray

from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.pose import FloatArray
from planner.geometry.table_top import TableTop

PAD_M = 0.011
"""Half the width of a fingertip's pad (m): cloth within it is pinched."""

FINGER_M = 0.022
"""Distance beside the tool's point within which the fingers find an edge of cloth (m)."""

_OPENING_M = 0.03
"""Distance above and below the middle of the fingers within which cloth is pinched (m)."""

_ALIKE_M = 0.003
"""Edges of several layers that are about equally far count as one (m)."""


def pinched(
    positions: FloatArray, triangles: NDArray[np.int64], tool: FloatArray, top: TableTop, clear_m: float
) -> frozenset[int]:
    """Return the vertices that fingers hold once they have closed; none if they find no cloth.

    The nearest vertex of every triangle that the pad touches is held; where it touches none, the triangles nearest to
    it within a finger's length. Beside the table, where tools keep clear of the edge, the fingers reach that far more.

    Args:
        positions: the vertices, table frame, shape (n, 3), m.
        triangles: shape (m, 3).
        tool: the tool's position, shape (3,), m; its fingers close `REST_HEIGHT_M` below.
        top: the table's top.
        clear_m: how far outside an edge's plane a tool holds hanging cloth (m).
    """
    tip = tool - np.array([0.0, 0.0, REST_HEIGHT_M])
    is_beside = not top.covers(tool[None])
    limit = FINGER_M + (clear_m if is_beside else 0.0)
    near = np.flatnonzero(np.linalg.norm(positions - tip, axis=1)[triangles].min(axis=1) < 3.0 * limit + 0.05)
    if not len(near):
        return frozenset()
    corners = positions[triangles[near]]
    flat = 3 if is_beside else 2
    gaps = triangle_distances(corners[..., :flat], tip[:flat])
    gaps[np.abs(corners[..., 2] - tip[2]).min(axis=1) > _OPENING_M + limit * is_beside] = np.inf
    reach = PAD_M if gaps.min() <= PAD_M else gaps.min() + _ALIKE_M
    if gaps.min() > limit:
        return frozenset()
    taken = near[gaps <= reach]
    apart = np.linalg.norm(positions[triangles[taken]][..., :flat] - tip[:flat], axis=-1)
    return frozenset(triangles[taken, np.argmin(apart, axis=1)].tolist())


def triangle_distances(triangles: FloatArray, point: FloatArray) -> FloatArray:
    """Return the distance of a point from each triangle, shape (n, 3, d) -> (n,), in the plane or in space (m)."""
    a, ab, ac = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    ap = point - a
    uu, uv, vv = (ab * ab).sum(1), (ab * ac).sum(1), (ac * ac).sum(1)
    pu, pv = (ap * ab).sum(1), (ap * ac).sum(1)
    area = np.maximum(uu * vv - uv * uv, 1e-18)
    u, v = (vv * pu - uv * pv) / area, (uu * pv - uv * pu) / area
    is_over = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
    foot = a + u[:, None] * ab + v[:, None] * ac
    inner = np.where(is_over, np.linalg.norm(point - foot, axis=1), np.inf)
    edges = [_edge_distances(triangles[:, i], triangles[:, (i + 1) % 3], point) for i in range(3)]
    return np.asarray(np.minimum(inner, np.min(edges, axis=0)))


def _edge_distances(starts: FloatArray, ends: FloatArray, point: FloatArray) -> FloatArray:
    along = ends - starts
    share = np.clip(((point - starts) * along).sum(1) / np.maximum((along * along).sum(1), 1e-18), 0.0, 1.0)
    return np.asarray(np.linalg.norm(point - starts - share[:, None] * along, axis=1))
