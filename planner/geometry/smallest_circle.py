"""Centres of the smallest circles round pairs and triples of points."""

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import ANGLE_RAD


def pair_centres(points: FloatArray) -> FloatArray:
    """Return the midpoints of all pairs of points, shape (n, 2) -> (n(n-1)/2, 2), m."""
    i, j = np.triu_indices(len(points), k=1)
    return np.asarray((points[i] + points[j]) / 2)


def triple_centres(points: FloatArray) -> FloatArray:
    """Return the centres of the smallest circles round all triples of points, shape (n, 2) -> (m, 2), m.

    For an acute triangle it is the circumcentre; otherwise the middle of the longest side.
    """
    one = np.arange(len(points))
    triples = np.argwhere((one[:, None, None] < one[:, None]) & (one[:, None] < one))
    corners = points[triples]
    sides = np.stack([corners[:, (i + 1) % 3] - corners[:, (i + 2) % 3] for i in range(3)], axis=1)
    squares = (sides**2).sum(axis=2)
    longest = squares.argmax(axis=1)
    rows = np.arange(len(triples))
    is_acute = squares.sum(axis=1) - 2 * squares[rows, longest] > ANGLE_RAD
    middles = (corners[rows, (longest + 1) % 3] + corners[rows, (longest + 2) % 3]) / 2
    return np.where(is_acute[:, None], _circumcentres(corners, squares), middles)


def _circumcentres(corners: FloatArray, squares: FloatArray) -> FloatArray:
    """Return circumcentres by barycentric weights a^2 (b^2 + c^2 - a^2); the corners' mean for a flat triangle."""
    weights = squares * (squares.sum(axis=1, keepdims=True) - 2 * squares)
    totals = weights.sum(axis=1, keepdims=True)
    safe = np.where(np.abs(totals) > 0.0, totals, 1.0)
    return np.asarray((corners * (weights / safe)[:, :, None]).sum(axis=1))
