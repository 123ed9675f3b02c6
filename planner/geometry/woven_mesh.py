"""A triangle mesh of a region for simulating cloth: rows along warp and weft, shifted at random.

A mesh of triangles folds without resistance only along its edges: across them it would have to stretch, and does so
more than any cloth (membrane locking). Woven cloth creases best along its threads, so the rows run along both axes of
the pattern. Where they lie is random but beside edges along them: no row is put where a fold is planned.
"""

import itertools
import math

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region

_APART = 0.45
"""The least distance between two points of the boundary, and from it to inner points, in edge lengths."""

_FLAT = 1e-3
"""The area of a triangle below which it is dropped, in squares of the edge length."""

_LIFT = 1e-4
"""The weight of every second point, in squares of the edge length: the diagonals of squares join these.

So diagonals run both ways in turns. With the same one in every square cloth folds along one bias and not along the
other: a garment's left sleeve was another cloth than its right one.
"""

_TURN = 1e-6
"""A slight shear, in edge lengths, that decides between diagonals where the weights do not."""


def woven_mesh(region: Region, edge_m: float, seed: int = 0) -> tuple[FloatArray, NDArray[np.int64]]:
    """Return the points, shape (n, 2), m, and the triangles, counter-clockwise, shape (m, 3), of a region's mesh.

    Args:
        region: a connected region; its corners are points of the mesh.
        edge_m: the distance between rows (m).
        seed: the rows' shift; the same seed gives the same mesh.
    """
    shape = shapely.orient_polygons(region.shape)
    shift = np.random.default_rng(seed).uniform(0.0, edge_m, 2)
    border = np.concatenate([_along(ring, edge_m, shift) for ring in shapely.get_rings(shape)])
    points = np.concatenate([border, _lattice(shape, edge_m, shift)])
    return points, _triangles(points, shape, edge_m, shift)


def _along(ring: shapely.LinearRing, edge_m: float, shift: FloatArray) -> FloatArray:
    """Return the corners of a ring and the points between them at which rows end, evened where they are too close."""
    return np.array(
        [
            (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]))
            for a, b in itertools.pairwise(shapely.get_coordinates(ring).tolist())
            for share in _shares(a, b, edge_m, shift)
        ]
    )


def _shares(start: Point2, end: Point2, edge_m: float, shift: FloatArray) -> list[float]:
    """Return the fractions of an edge at which points lie, its start among them, its end not."""
    length = math.dist(start, end)
    crossed = []
    for axis in (0, 1):
        low, high = sorted((start[axis], end[axis]))
        rows = np.arange(math.ceil((low - shift[axis]) / edge_m), math.floor((high - shift[axis]) / edge_m) + 1)
        if high - low > 0.5 * length:  # rows that run along the edge rather than across it do not end there
            crossed += ((shift[axis] + rows * edge_m - start[axis]) / (end[axis] - start[axis])).tolist()
    if min(abs(end[0] - start[0]), abs(end[1] - start[1])) < _FLAT * edge_m:
        crossed = list(_off_ends(np.array(crossed), length / edge_m))
    kept = [0.0]
    for share in sorted(crossed):
        if (share - kept[-1]) * length >= _APART * edge_m and (1.0 - share) * length >= _APART * edge_m:
            kept.append(share)
    ends = [*kept, 1.0]
    wide = [(a, b) for a, b in itertools.pairwise(ends) if (b - a) * length > 1.5 * edge_m]
    return sorted([*kept, *((a + b) / 2.0 for a, b in wide)])


def _off_ends(shares: FloatArray, length: float) -> FloatArray:
    """Return fractions of an edge of some edge lengths at which rows end, as far from its ends as they should be."""
    shares = np.where(shares < 0.5, _evened(shares * length) / length, shares)
    return np.where(shares > 0.5, 1.0 - _evened((1.0 - shares) * length) / length, shares)


def _evened(gaps: FloatArray) -> FloatArray:
    """Return how far rows lie from an edge along them, of the distances at which they would lie, in edge lengths.

    The first row is .65 to .95 from it, and the next one no further from that than rows are: cloth turns over round the
    ends of fingers that hold an edge, at its first row. With the rows as they happen to fall 4 of 16 edges of strips
    that were folded over, aimed 3 cm short, landed short of their place by up to 15 mm, the others up to 31 mm beyond;
    with these all landed 0 to 31 mm beyond (rows 15 and 18 mm apart).
    """
    chosen = [gaps < 0.45, gaps < 0.65, gaps < 0.95, gaps < 1.0, gaps < 1.45]
    return np.select(
        chosen,
        [np.full_like(gaps, 0.8), np.full_like(gaps, 0.75), gaps, np.full_like(gaps, 0.85), 0.9 + gaps / 2.0],
        gaps,
    )


def _lattice(shape: shapely.Geometry, edge_m: float, shift: FloatArray) -> FloatArray:
    low, high = np.array(shapely.bounds(shape)).reshape(2, 2)
    first, last = np.floor((low - shift) / edge_m), np.ceil((high - shift) / edge_m)
    rows = [shift[axis] + edge_m * np.arange(first[axis], last[axis] + 1.0) for axis in (0, 1)]
    points = np.stack(np.meshgrid(*rows), axis=-1).reshape(-1, 2)
    points = points[shapely.contains_xy(shape, points[:, 0], points[:, 1])]
    points = _off_edges(points, shape, edge_m)
    is_inside = shapely.contains_xy(shape, points[:, 0], points[:, 1])
    is_apart = shapely.distance(shape.boundary, shapely.points(points)) >= _APART * edge_m
    return np.asarray(points[is_inside & is_apart])


def _off_edges(points: FloatArray, shape: shapely.Geometry, edge_m: float) -> FloatArray:
    """Return points inside a shape, those of rows along its edges as far from these as they should be."""
    moved = points.copy()
    for ring in shapely.get_rings(shape):
        for start, end in itertools.pairwise(shapely.get_coordinates(ring)):
            along, across = (0, 1) if abs(end[0] - start[0]) > abs(end[1] - start[1]) else (1, 0)
            if abs(end[across] - start[across]) > _FLAT * edge_m:
                continue
            way = float(np.sign(end[along] - start[along]))
            inwards = way if along == 0 else -way  # the shape is to the left of its edges
            gaps = inwards * (points[:, across] - start[across]) / edge_m
            low, high = sorted((start[along], end[along]))
            is_beside = (points[:, along] > low) & (points[:, along] < high) & (gaps > 0.0) & (gaps < 1.45)
            moved[is_beside, across] = start[across] + inwards * edge_m * _evened(gaps[is_beside])
    return moved


def _triangles(points: FloatArray, shape: shapely.Geometry, edge_m: float, shift: FloatArray) -> NDArray[np.int64]:
    is_second = np.round((points - shift) / edge_m).sum(axis=1) % 2.0 == 0.0
    found = _regular(points + _TURN * points[:, ::-1], np.where(is_second, _LIFT * edge_m**2, 0.0))
    middles = points[found].mean(axis=1)
    first, second = (points[found[:, i]] - points[found[:, 0]] for i in (1, 2))
    areas = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    found[areas < 0.0] = found[areas < 0.0][:, ::-1]
    is_kept = shapely.contains_xy(shape, middles[:, 0], middles[:, 1]) & (np.abs(areas) > 2.0 * _FLAT * edge_m**2)
    return np.asarray(found[is_kept])


def _regular(points: FloatArray, weights: FloatArray) -> NDArray[np.int64]:
    """Return the triangles of weighted points, shapes (n, 2), m, and (n,), m^2; with equal weights Delaunay's."""
    lifted = np.column_stack([points, (points * points).sum(axis=1) - weights])
    hull = ConvexHull(lifted)
    return np.asarray(hull.simplices[hull.equations[:, 2] < 0.0], dtype=np.int64)
