"""Find the vertices of the cloth that two closing fingers pinch, by geometry alone: the layers are not known."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.table import TableTop

PAD_M = 0.011
"""Half the width of a fingertip's pad (m): cloth within it is pinched."""

FINGER_M = 0.022
"""Distance beside the tool's point within which the fingers find an edge of cloth (m)."""

OPENING_M = 0.03
"""Distance above and below the middle of the fingers within which cloth is pinched (m)."""

_ALIKE_M = 0.003
"""The difference in distance up to which edges of several layers count as one (m)."""

_BESIDE = 0.7
"""The cosine of the angle to the line across a hand's way up to which a vertex lies beside another."""


def pinched(
    positions: FloatArray,
    triangles: NDArray[np.int64],
    tool: FloatArray,
    top: TableTop,
    clear_m: float,
    layers: int | None = None,
) -> dict[int, FloatArray]:
    """Return the vertices that fingers hold once they have closed, each with the point between the fingers.

    The nearest vertex of every triangle that the pad touches is held; where it touches none, the triangles nearest to
    it within a finger's length. Beside the table, where tools keep clear of the edge, the fingers reach that far more.
    The fingers are where its sheet of cloth comes nearest to them; its vertex may be most of a triangle's edge away.

    Args:
        positions: the vertices, table frame, shape (n, 3), m.
        triangles: shape (m, 3).
        tool: the tool's position, shape (3,), m; its fingers close `REST_HEIGHT_M` below.
        top: the table's top.
        clear_m: how far outside an edge's plane a tool holds hanging cloth (m).
        layers: how many sheets from the top down the fingers take; None for all.

    Returns:
        For each vertex the point of the cloth that is between the fingers, table frame, shape (3,), m; empty if they
        find no cloth.
    """
    tip = fingertip(tool)
    is_beside = not top.covers(tool[None])
    limit = FINGER_M + (clear_m if is_beside else 0.0)
    near = np.flatnonzero(np.linalg.norm(positions - tip, axis=1)[triangles].min(axis=1) < 3.0 * limit + 0.05)
    if not len(near):
        return {}
    corners = positions[triangles[near]]
    flat = 3 if is_beside else 2
    weights = nearest_weights(corners[..., :flat], tip[:flat])
    points = (weights[..., None] * corners).sum(axis=1)
    gaps = np.linalg.norm(points[:, :flat] - tip[:flat], axis=1)
    gaps[np.abs(corners[..., 2] - tip[2]).min(axis=1) > OPENING_M + limit * is_beside] = np.inf
    if layers is not None:
        gaps[_below(triangles[near], corners, points, gaps <= limit, layers)] = np.inf
    reach = PAD_M if gaps.min() <= PAD_M else gaps.min() + _ALIKE_M
    if gaps.min() > limit:
        return {}
    taken = np.flatnonzero(gaps <= reach)
    apart = np.linalg.norm(corners[taken][..., :flat] - tip[:flat], axis=-1)
    vertices = triangles[near[taken], np.argmin(apart, axis=1)].tolist()
    nearest = _nearest_of_each_sheet(_sheets(triangles[near[taken]], corners[taken]), gaps[taken])
    return {vertex: points[taken[one]] for vertex, one in zip(vertices, nearest.tolist(), strict=True)}


def _sheets(triangles: NDArray[np.int64], corners: FloatArray) -> NDArray[np.int64]:
    """Return the number of the sheet that each triangle is of, shape (n,): all that are joined, and face one way.

    At a crease two sheets meet, one of them turned over, each at its own height between the fingers.

    Args:
        triangles: shape (n, 3).
        corners: their corners, shape (n, 3, 3), m.
    """
    first, second = (corners[:, one] - corners[:, 0] for one in (1, 2))
    faces_up = first[:, 0] * second[:, 1] > first[:, 1] * second[:, 0]
    sides = 2 * triangles + faces_up[:, None]  # a vertex at a crease counts as two, one of each sheet
    joined = coo_array((np.ones(sides.size), (np.repeat(np.arange(len(triangles)), 3), sides.ravel()))).tocsr()
    return np.asarray(connected_components(joined @ joined.T)[1])


def _nearest_of_each_sheet(sheets: NDArray[np.int64], gaps: FloatArray) -> NDArray[np.int64]:
    """Return for each triangle the number of the nearest one of its sheet, shape (n,).

    Fingers hold a sheet at one line, about which all of it turns.

    Args:
        sheets: the sheet of each, shape (n,).
        gaps: how far each is from the fingers, shape (n,), m.
    """
    order = np.argsort(gaps, kind="stable")
    found = np.empty(len(sheets), dtype=np.int64)
    for sheet in np.unique(sheets).tolist():
        found[sheets == sheet] = order[sheets[order] == sheet][0]
    return found


def _below(
    triangles: NDArray[np.int64], corners: FloatArray, points: FloatArray, is_near: BoolArray, layers: int
) -> BoolArray:
    """Return which triangles belong to none of the top sheets that the fingers reach, shape (n,).

    Args:
        triangles: shape (n, 3).
        corners: their corners, shape (n, 3, 3), m.
        points: their points nearest to the fingers, shape (n, 3), m.
        is_near: which of them fingers reach, shape (n,).
        layers: how many sheets.
    """
    reached = np.flatnonzero(is_near)
    sheets = _sheets(triangles[reached], corners[reached])
    heights = np.bincount(sheets, points[reached, 2]) / np.bincount(sheets)
    found = np.ones(len(triangles), dtype=bool)
    found[reached[np.isin(sheets, np.argsort(-heights)[:layers])]] = False
    return found


def clamped(
    found: Mapping[int, FloatArray],
    positions: FloatArray,
    triangles: NDArray[np.int64],
    tip: FloatArray,
    way: FloatArray,
) -> dict[int, FloatArray]:
    """Return the pinched vertices with a neighbour of each across the hand's way, in each of its sheets.

    A pad is as wide as a row of the mesh, and cloth does not turn between fingers. Held by one vertex it would. At a
    crease a vertex belongs to two sheets that lie on one another, and each is between the fingers.

    Args:
        found: the point between the fingers for each vertex, shape (3,), m.
        positions: the vertices, table frame, shape (n, 3), m.
        triangles: shape (m, 3).
        tip: where the fingers have closed, shape (3,), m.
        way: the direction of the hand's way, horizontal, of length 1, shape (2,).
    """
    across = np.array([-way[1], way[0], 0.0])
    taken = dict(found)
    for vertex, point in found.items():
        around = triangles[(triangles == vertex).any(axis=1)]
        near = np.setdiff1d(around, [vertex])
        is_new = np.array([one not in taken for one in near.tolist()])
        order = np.lexsort([np.linalg.norm(positions[near] - tip, axis=1), is_new])  # those held already come first
        for beside in _of_each_sheet(vertex, near[order], positions, around, across):
            taken.setdefault(beside, point)
    return taken


def _of_each_sheet(
    vertex: int, near: NDArray[np.int64], positions: FloatArray, around: NDArray[np.int64], across: FloatArray
) -> list[int]:
    """Return the first neighbour of a vertex along a line in each sheet of cloth that meets there.

    That is one in flat cloth, be it on this side of the vertex or on that, and two that no triangle joins, both on one
    side, where cloth is folded.

    Args:
        vertex: its number.
        near: its neighbours, in the order in which they are preferred, shape (n,).
        positions: the vertices, table frame, shape (n, 3), m.
        around: the vertex's triangles, shape (m, 3).
        across: the direction of the line, of length 1, shape (3,).
    """
    offsets = positions[near] - positions[vertex]
    along = offsets @ across
    is_beside = np.abs(along) > _BESIDE * np.linalg.norm(offsets, axis=1)
    sides = np.sign(along[is_beside]).tolist()
    chosen: list[int] = []
    for one, side in zip(near[is_beside].tolist(), sides, strict=True):
        joined = around[(around == one).any(axis=1)]
        if not chosen or (side == sides[0] and not np.isin(chosen, joined).any()):
            chosen.append(one)
    return chosen


def fingertip(tool: FloatArray) -> FloatArray:
    """Return where fingers close for a position of their tool, shape (3,), m."""
    return np.asarray(tool - np.array([0.0, 0.0, REST_HEIGHT_M]))


def nearest_weights(triangles: FloatArray, point: FloatArray) -> FloatArray:
    """Return the weights of each triangle's corners at its point nearest to a point, in the plane or in space.

    Args:
        triangles: shape (n, 3, d), m.
        point: shape (d,), m.

    Returns:
        Shape (n, 3); each row's sum is 1.
    """
    a, ab, ac = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    ap = point - a
    uu, uv, vv = (ab * ab).sum(1), (ab * ac).sum(1), (ac * ac).sum(1)
    pu, pv = (ap * ab).sum(1), (ap * ac).sum(1)
    area = np.maximum(uu * vv - uv * uv, 1e-18)
    u, v = (vv * pu - uv * pv) / area, (uu * pv - uv * pu) / area
    inner = np.column_stack([1.0 - u - v, u, v])
    found = np.stack([inner, *(_edge_weights(triangles, i, point) for i in range(3))], axis=1)
    gaps = np.linalg.norm((found[..., None] * triangles[:, None]).sum(axis=2) - point, axis=-1)
    gaps[(inner < 0.0).any(axis=1), 0] = np.inf
    return np.asarray(found[np.arange(len(found)), gaps.argmin(axis=1)])


def _edge_weights(triangles: FloatArray, first: int, point: FloatArray) -> FloatArray:
    """Return the weights of the corners at the point of an edge nearest to a point, shape (n, 3)."""
    second = (first + 1) % 3
    along = triangles[:, second] - triangles[:, first]
    way = ((point - triangles[:, first]) * along).sum(1)
    share = np.clip(way / np.maximum((along * along).sum(1), 1e-18), 0.0, 1.0)
    weights = np.zeros((len(triangles), 3))
    weights[:, first], weights[:, second] = 1.0 - share, share
    return weights
