"""Cloth as it looks: two faces, some distance apart, and a hem around each layer that bulges from one to the other.

A surface of cloth has no thickness. Its triangles share their corners within a layer, where it lies and where it is
lifted, and the corners are moved by half of it to both sides: so bent cloth is shaded smoothly. Where cloth is folded
flat its two layers end at one line of the pattern: they are joined by a half round as high as what lies between them.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import LENGTH_M, SORTING_M
from planner.motion.cloth_surface import ClothSurface

_SIDES = np.array([[0, 1], [1, 2], [2, 0]])
_FULL = 0.8
"""The distance of the faces, as a share of the height of a layer: faces of two layers are never at one height."""

_HEM_LINES, _ROUND_LINES = 3, 7
"""How many lines along a stretch of edge are joined by triangles: at a hem, and round a crease."""

_FOLDED = 0.9
"""The cosine of the angle between the layers of a crease from which on it is folded flat."""


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
        """The vertices of the front and of the back, shape (n, 3), m."""
        half = self._half_m * self.normals
        return self.vertices + half, self.vertices - half

    @property
    def vertices(self) -> FloatArray:
        """The vertices half way between the faces, shape (n, 3), m."""
        return np.asarray(self._corners.reshape(-1, 3)[self._shared[0]])

    @cached_property
    def normals(self) -> FloatArray:
        """The unit normals on the front at the vertices, shape (n, 3)."""
        return blended_normals(self.vertices, self.triangles)

    @property
    def triangles(self) -> NDArray[np.int64]:
        """The triangles of either face, shape (m, 3), counter-clockwise as seen from the front."""
        return self._shared[1]

    @property
    def pattern(self) -> FloatArray:
        """The pattern's coordinates of either face's vertices, shape (n, 2), m."""
        return np.asarray(self.cloth.pattern[self.cloth.triangles.ravel()[self._shared[0]]])

    @property
    def edges(self) -> FloatArray:
        """The stretches of edge at which cloth ends, on the bulge, shape (n, 2, 3), m."""
        ends, outwards, _ = (part[self._is_hem] for part in self._free)
        return np.asarray(ends + outwards[:, None])

    @property
    def hem(self) -> tuple[FloatArray, NDArray[np.int64]]:
        """The vertices of hems and creases, shape (n, 3), m, and their triangles, shape (m, 3), seen from outside."""
        ends, outwards, up = (part[self._is_hem] for part in self._free)
        hems = np.stack([ends + up[:, None], ends + outwards[:, None], ends - up[:, None]], axis=2)
        rounds = self._rounds
        bent = len(hems) * 2 * _HEM_LINES + _strips(len(rounds), _ROUND_LINES)
        vertices = np.concatenate([hems.reshape(-1, 3), rounds.reshape(-1, 3)])
        return vertices, np.concatenate([_strips(len(hems), _HEM_LINES), bent])

    @cached_property
    def _shared(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Which of the triangles' corners are the faces' vertices, shape (n,), and the triangles, shape (m, 3).

        Vertices are in the order of the corners: while cloth moves without being cut anew, the triangles stay the same.
        """
        is_lifted = np.asarray(np.isnan(self.cloth.unrolled[self.cloth.triangles]).any(axis=(1, 2)))
        _, first, names = np.unique(2 * self._names + is_lifted[:, None], return_index=True, return_inverse=True)
        order = np.argsort(first)
        return first[order], np.argsort(order)[names].reshape(-1, 3)

    @cached_property
    def _corners(self) -> FloatArray:
        return np.asarray(self.cloth.vertices[self.cloth.triangles])

    @cached_property
    def _facets(self) -> FloatArray:
        """The unit normals on the front of the triangles, shape (m, 3)."""
        a, b, c = self._corners.transpose(1, 0, 2)
        return _units(np.cross(b - a, c - a))

    @cached_property
    def _free(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Each layer's stretches of edge, shape (n, 2, 3), and half the thickness away from it and to its front."""
        owners, sides = self._sides
        ends = self._corners[owners[:, None], _SIDES[sides]]
        normals, half_m = self._facets[owners], self._half_m
        return ends, half_m * _units(np.cross(ends[:, 1] - ends[:, 0], normals)), half_m * normals

    @cached_property
    def _names(self) -> NDArray[np.int64]:
        """A number for the place of each corner in its layer, shape (m, 3)."""
        steps = np.round(self._corners / LENGTH_M).astype(np.int64)
        layers = np.broadcast_to(self.cloth.layers[:, None, None], (*steps.shape[:2], 1))
        _, names = np.unique(np.concatenate([steps, layers], axis=2).reshape(-1, 4), axis=0, return_inverse=True)
        return names.reshape(-1, 3)

    @cached_property
    def _sides(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The triangles' sides that no two of a layer share: the triangles, shape (n,), and which side of each."""
        ends = np.sort(self._names[:, _SIDES], axis=2) @ np.array([self._names.size, 1])
        _, first, counts = np.unique(ends, return_index=True, return_counts=True)
        free = first[counts == 1]
        return free // 3, free % 3

    @cached_property
    def _creases(self) -> NDArray[np.int64]:
        """The pairs of stretches at which cloth is folded flat, shape (n, 2)."""
        owners, sides = self._sides
        traced = self.cloth.pattern[self.cloth.triangles][owners[:, None], _SIDES[sides]]
        ends = np.round(traced / SORTING_M).astype(np.int64)
        is_turned = (ends[:, 0, 0] > ends[:, 1, 0]) | (
            (ends[:, 0, 0] == ends[:, 1, 0]) & (ends[:, 0, 1] > ends[:, 1, 1])
        )
        names = np.where(is_turned[:, None, None], ends[:, ::-1], ends).reshape(-1, 4)
        _, found, counts = np.unique(names, axis=0, return_inverse=True, return_counts=True)
        in_order = np.argsort(found.ravel(), kind="stable")
        firsts = (np.cumsum(counts) - counts)[counts == 2]
        pairs = np.stack([in_order[firsts], in_order[firsts + 1]], axis=1)
        _, outwards, _ = self._free
        is_flat = (outwards[pairs[:, 0]] * outwards[pairs[:, 1]]).sum(axis=1) > _FOLDED * self._half_m**2
        return np.asarray(pairs[is_flat])

    @property
    def _is_hem(self) -> NDArray[np.bool_]:
        """Which stretches of edge belong to no crease, shape (n,)."""
        is_hem = np.ones(len(self._sides[0]), dtype=np.bool_)
        is_hem[self._creases] = False
        return is_hem

    @property
    def _rounds(self) -> FloatArray:
        """The lines round the creases, from either end of their stretches of edge, shape (n, 2, lines, 3), m."""
        ends, outwards, up = self._free
        one, other = self._creases.T
        there = ends[other]
        is_turned = np.linalg.norm(there - ends[one], axis=2).sum(axis=1) > np.linalg.norm(
            there[:, ::-1] - ends[one], axis=2
        ).sum(axis=1)
        there = np.where(is_turned[:, None, None], there[:, ::-1], there)
        apart, middle = (ends[one] - there) / 2.0, (ends[one] + there) / 2.0
        is_inside_out = (apart.sum(axis=1) * up[one]).sum(axis=1) < 0.0
        apart, middle = (np.where(is_inside_out[:, None, None], part[:, ::-1], part) for part in (apart, middle))
        radius = np.linalg.norm(apart, axis=2, keepdims=True) + self._half_m
        across, out = radius * _units(apart), radius * _units(outwards[one])[:, None]
        turn = np.linspace(0.0, np.pi, _ROUND_LINES)[:, None]
        return np.asarray(middle[:, :, None] + np.cos(turn) * across[:, :, None] + np.sin(turn) * out[:, :, None])


def blended_normals(vertices: FloatArray, triangles: NDArray[np.int64]) -> FloatArray:
    """Return unit normals at vertices, shape (n, 3): the mean of their triangles', shape (m, 3), by area."""
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    facing, corners = np.repeat(np.cross(b - a, c - a), 3, axis=0), triangles.ravel()
    return _units(np.stack([np.bincount(corners, facing[:, axis], len(vertices)) for axis in range(3)], axis=1))


def _strips(count: int, lines: int) -> NDArray[np.int64]:
    """Return the triangles between lines from one end to the other of each of some stretches, shape (n, 3)."""
    at = np.arange(lines - 1)[:, None]
    strip = np.concatenate([at + np.array([0, 1, lines]), at + np.array([1, lines + 1, lines])])
    return np.asarray((2 * lines * np.arange(count)[:, None, None] + strip).reshape(-1, 3))


def _units(vectors: FloatArray) -> FloatArray:
    """Return vectors, shape (..., 3), with a length of 1; those without a length stay as they are."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(lengths > 0.0, lengths, 1.0))
