"""Cloth as it looks: two faces, some distance apart, and a hem around each layer that bulges from one to the other.

A surface of cloth has no thickness. Each triangle is moved by half of it to both sides, so those that meet at a bend
part by less than the thickness, which nobody sees.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import LENGTH_M
from planner.motion.sample import ClothSurface

_SIDES = np.array([[0, 1], [1, 2], [2, 0]])
_FULL = 0.8
"""The distance of the faces, as a share of the height of a layer: faces of two layers are never at one height."""

_HEM = np.array([[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4]])
"""Triangles between the lines at the front, half way and at the back, from one end of a stretch of hem to the other."""


@dataclass(frozen=True, slots=False)
class ThickCloth:
    """A surface of cloth with a thickness.

    Attributes:
        cloth: the surface half way between its faces.
        layer_m: the height that a layer takes in a stack (m).
    """

    cloth: ClothSurface
    layer_m: float

    @property
    def _half_m(self) -> float:
        return _FULL / 2 * self.layer_m

    @property
    def faces(self) -> tuple[FloatArray, FloatArray]:
        """The corners of the triangles of the front and of the back, three for each, shape (3 m, 3), m."""
        half = np.repeat(self._half_m * self._normals, 3, axis=0)
        corners = self._corners.reshape(-1, 3)
        return corners + half, corners - half

    @property
    def edges(self) -> FloatArray:
        """The stretches of edge that no two triangles of a layer share, on the bulge, shape (n, 2, 3), m."""
        ends, outwards, _ = self._hems
        return np.asarray(ends + outwards[:, None])

    @property
    def hem(self) -> tuple[FloatArray, NDArray[np.int64]]:
        """The hem's vertices, shape (6 n, 3), m, and its triangles, shape (4 n, 3), seen from outside."""
        ends, outwards, up = self._hems
        lines = np.stack([ends + up[:, None], ends + outwards[:, None], ends - up[:, None]], axis=2)
        triangles = 6 * np.arange(len(ends))[:, None, None] + _HEM
        return lines.reshape(-1, 3), triangles.reshape(-1, 3)

    @cached_property
    def _corners(self) -> FloatArray:
        return np.asarray(self.cloth.vertices[self.cloth.triangles])

    @cached_property
    def _normals(self) -> FloatArray:
        """The unit normals on the front of the triangles, shape (m, 3)."""
        a, b, c = self._corners.transpose(1, 0, 2)
        return _units(np.cross(b - a, c - a))

    @cached_property
    def _hems(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The stretches of edge, shape (n, 2, 3), and half the thickness away from the cloth and to its front."""
        owners, sides = free_sides(self.cloth)
        ends = self._corners[owners[:, None], _SIDES[sides]]
        normals, half_m = self._normals[owners], self._half_m
        return ends, half_m * _units(np.cross(ends[:, 1] - ends[:, 0], normals)), half_m * normals


def free_sides(cloth: ClothSurface) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the triangles' sides that no two of a layer share: the triangles, shape (n,), and which side of each.

    Triangles need not share vertices: corners at the same place are the same corner.
    """
    corners = np.round(cloth.vertices[cloth.triangles] / LENGTH_M).astype(np.int64)
    layers = np.broadcast_to(cloth.layers[:, None, None], (*corners.shape[:2], 1))
    places = np.concatenate([corners, layers], axis=2)
    _, names = np.unique(places.reshape(-1, 4), axis=0, return_inverse=True)
    ends = names.reshape(-1, 3)[:, _SIDES].reshape(-1, 2)
    _, first, counts = np.unique(np.sort(ends, axis=1), axis=0, return_index=True, return_counts=True)
    free = first[counts == 1]
    return free // 3, free % 3


def _units(vectors: FloatArray) -> FloatArray:
    """Return vectors, shape (n, 3), with a length of 1; those without a length stay as they are."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.where(lengths > 0.0, lengths, 1.0))
