"""How stiffly cloth bends at the edges of its triangles: with a moment that grows as the angle does.

MuJoCo's energy of bending is quadratic in the vertices' places, so it grows as 1 - cos of the angle, and its moment as
the sine: an edge of cloth doubled back at one row of the mesh had next to none that opened it, and stayed there under
its own weight, where a strip of cloth as stiff springs open. The moment of a strip grows as its curvature.
"""

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray

_FLAT = 0.2
"""How far from folded flat a hinge has its whole moment (rad): flat, it does not know which way it opens."""

_MOST = (math.pi - _FLAT) / math.sin(_FLAT)
"""The largest factor, which is that of a hinge so far from flat."""

_TINY_M4 = 1e-24


@dataclass(frozen=True, slots=True, eq=False)
class Hinges:
    """The edges at which two triangles meet.

    Attributes:
        numbers: of the edges, shape (k,).
        corners: the two ends of each and the corner of either triangle beyond it, shape (k, 4).
        flat: MuJoCo's coefficients, which hold for small angles, shape (k, c).
    """

    numbers: NDArray[np.int64]
    corners: NDArray[np.int64]
    flat: FloatArray

    @staticmethod
    def of(model: mujoco.MjModel) -> "Hinges":
        """Return the hinges of a model whose one flex bends."""
        numbers = np.flatnonzero((model.flex_edgeflap >= 0).all(axis=1))
        corners = np.column_stack([model.flex_edge, model.flex_edgeflap])[numbers]
        return Hinges(numbers, corners, model.flex_bending.reshape(len(model.flex_edge), -1)[numbers].copy())

    def stiffen(self, model: mujoco.MjModel, positions: FloatArray) -> None:
        """Give a model the coefficients for where its vertices are, shape (n, 3), m."""
        scale = angle_over_sine(bent_rad(positions[self.corners]))
        model.flex_bending.reshape(len(model.flex_edge), -1)[self.numbers] = self.flat * scale[:, None]


def bent_rad(corners: FloatArray) -> FloatArray:
    """Return the angles between pairs of triangles, 0 where they lie in one plane, shape (k,), rad.

    Args:
        corners: the two ends of the edge that they share and the corner of either beyond it, shape (k, 4, 3), m.
    """
    along, one, other = (corners[:, i] - corners[:, 0] for i in (1, 2, 3))
    first, second = np.cross(along, one), np.cross(other, along)
    sizes = np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
    cosines = (first * second).sum(axis=1) / np.maximum(sizes, _TINY_M4)
    return np.asarray(np.arccos(np.clip(cosines, -1.0, 1.0)))


def angle_over_sine(angles: FloatArray) -> FloatArray:
    """Return by how much more a moment has to be that grows as the angle (rad) than one that grows as its sine."""
    return np.asarray(np.minimum(1.0 / np.maximum(np.sinc(angles / math.pi), 1.0 / _MOST), _MOST))
