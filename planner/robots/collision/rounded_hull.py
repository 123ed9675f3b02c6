"""A convex body of few corners that contains a cloud of points.

The convex hull of a mesh has a hundred corners and more, and every support query visits all of them. Leaving out
corners would cut into the mesh. So some corners are left out and the body is rounded by the distance of the furthest
one left out: the points within that radius of the reduced hull contain the mesh. Two such bodies are apart where their
hulls are further apart than the sum of both radii.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING, Any

import coal
import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import GRID_M
from planner.robots.kept_arrays import Arrays

if TYPE_CHECKING:
    from scipy.spatial import ConvexHull

IntArray = NDArray[np.int32]

_MIRROR = np.array([1.0, -1.0, 1.0])
_DIRECTIONS = np.array([d for d in product((-1.0, 0.0, 1.0), repeat=3) if any(d)])
"""Directions whose extreme points are the first corners kept: the faces, edges and corners of a cube."""

_POINT, _UPRIGHT = coal.Sphere(0.0), np.eye(3)

_BATCH = 64
"""How many of the furthest points are sorted at once."""

_FLAT_M, _THICKNESS_M = 5e-5, 1e-3
"""Points that are thinner than the first are made as thick as the second (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class RoundedHull:
    """All points within a radius of the convex hull of some corners.

    Attributes:
        corners: shape (n, 3), m.
        faces: the corner indices of each triangle of the hull, counter-clockwise from outside, shape (m, 3).
        radius_m: how far the body extends beyond the hull (m).
    """

    corners: FloatArray
    faces: IntArray
    radius_m: float

    def __post_init__(self) -> None:
        """Validate the corners, the faces and the radius; raise `ValueError` if they do not form a rounded hull."""
        if self.corners.ndim != 2 or self.corners.shape[1:] != (3,) or self.faces.shape[1:] != (3,):
            raise ValueError(f"corners of shape {self.corners.shape} and faces of {self.faces.shape} make no hull")
        if len(self.faces) < 4 or self.faces.min() < 0 or self.faces.max() >= len(self.corners):
            raise ValueError("faces must be of corners that there are, and at least four")
        if not self.radius_m >= 0.0:
            raise ValueError(f"{self.radius_m} m is no radius")

    def convex(self) -> coal.Convex:
        """Return the hull of the corners as coal's ``Convex``, without the rounding."""
        points, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
        for corner in self.corners:
            points.append(corner)
        for i, j, k in self.faces.tolist():
            triangles.append(coal.Triangle(i, j, k))
        return coal.Convex(points, triangles)

    def mirrored(self) -> "RoundedHull":
        """Return the mirror image in y."""
        return RoundedHull(self.corners * _MIRROR, self.faces[:, ::-1].copy(), self.radius_m)


def rounded_hull(points: FloatArray, radius_max_m: float, is_symmetric: bool = False) -> RoundedHull:
    """Return a body that contains points, shape (n, 3), that do not all lie in one plane (m).

    Corners are added one by one, always the point that is furthest outside the hull of those before, until none is
    further out than `radius_max_m` (m). With `is_symmetric` the body is symmetric in y, even if the points are not.
    """
    points = points[_qhull(points).vertices]
    kept = points[np.argmax(points @ _DIRECTIONS.T, axis=0)]
    away = np.full(len(points), np.inf)
    while True:
        hull = _exact_hull(np.vstack([kept, kept * _MIRROR]) if is_symmetric else kept)
        furthest = _furthest(points, hull, away)
        if away[furthest] <= radius_max_m:
            return replace(hull, radius_m=float(away[furthest]) + GRID_M)
        kept = np.vstack([kept, points[furthest]])


def _furthest(points: FloatArray, hull: RoundedHull, away: FloatArray) -> int:
    """Return the point that is furthest outside of a hull.

    `away` holds how far the points were outside of a smaller hull (m), so none is further out now. It is brought up to
    date, but only for the points that might be the furthest.
    """
    convex = hull.convex()
    best, best_m = -1, -1.0
    for number in _falling(away):
        if away[number] < best_m - GRID_M:
            break
        away[number] = _distance(points[number], convex)
        if away[number] > best_m or (away[number] == best_m and number < best):
            best, best_m = number, float(away[number])
    return best


def _falling(values: FloatArray) -> Iterator[int]:
    """Yield the indices of values from the largest to the smallest; to sort all of them takes as long as the hull."""
    left = values.copy()
    for first in range(0, len(left), _BATCH):
        batch = np.argpartition(-left, min(_BATCH, len(left) - 1))[: min(_BATCH, len(left) - first)]
        yield from batch[np.argsort(-left[batch], kind="stable")].tolist()
        left[batch] = -np.inf


def hull_corners(points: FloatArray) -> FloatArray:
    """Return the corners of the convex hull of points, shape (n, 3); flat ones are thickened by a millimetre."""
    centred = points - points.mean(axis=0)
    _, _, axes = np.linalg.svd(centred[:: max(len(centred) // 10_000, 1)], full_matrices=False)
    if len(axes) < 3 or np.ptp(centred @ axes.T, axis=0).min() < _FLAT_M:
        points = np.vstack([points + 0.5 * side * _THICKNESS_M * axis for axis in np.eye(3) for side in (-1.0, 1.0)])
    corners: FloatArray = points[_qhull(points).vertices]
    return corners


def _exact_hull(points: FloatArray) -> RoundedHull:
    """Return the convex hull of points, not rounded."""
    points = np.unique(points, axis=0)
    found = _qhull(points)
    number = np.full(len(points), -1)
    number[found.vertices] = np.arange(len(found.vertices))
    faces = number[found.simplices]
    corners = points[found.vertices]
    a, b, c = (corners[faces[:, k]] for k in range(3))
    is_inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), found.equations[:, :3]) < 0.0
    faces[is_inwards] = faces[is_inwards][:, ::-1]
    return RoundedHull(corners, faces.astype(np.int32), 0.0)


def _distance(point: FloatArray, convex: coal.Convex) -> float:
    """Return how far a point is from a hull (m), 0 inside."""
    there = coal.Transform3s(_UPRIGHT, point)
    request, here = coal.DistanceRequest(), coal.Transform3s.Identity()
    return max(float(coal.distance(convex, here, _POINT, there, request, coal.DistanceResult())), 0.0)


def _qhull(points: FloatArray) -> "ConvexHull":
    from scipy.spatial import ConvexHull  # slow to import, and needed only where shapes are made

    return ConvexHull(points)


def hull_from(arrays: Arrays, name: str) -> RoundedHull:
    """Return the hull of a name; raise one of several errors where it is missing or malformed."""
    return RoundedHull(arrays[f"{name}/corners"], arrays[f"{name}/faces"], float(arrays[f"{name}/radius"]))


def hull_arrays(name: str, hull: RoundedHull) -> dict[str, NDArray[Any]]:
    """Return the arrays by which a hull is kept."""
    return {
        f"{name}/corners": hull.corners,
        f"{name}/faces": hull.faces,
        f"{name}/radius": np.array(hull.radius_m),
    }
