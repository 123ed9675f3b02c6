"""The stiffness of woven cloth in its plane: stiff to pull along its threads, softer to push, soft in shear.

MuJoCo's own elasticity is alike in all directions, so cloth that hardly stretches would neither shear nor give way
where it is pushed together. Real threads turn against each other, and buckle at once, on lengths that a mesh does not
resolve; without that a mesh locks where a crease is folded over. MuJoCo's energy is quadratic in how much the squared
lengths of a triangle's edges have grown, and so is that of threads, with other coefficients.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.rehearsal.physics.fabric import Fabric
from planner.geometry.pose import FloatArray
from planner.kernels import kernel


@dataclass(frozen=True, slots=True, eq=False)
class Weave:
    """The stiffness of each triangle; its edge i is the one opposite to corner i.

    Attributes:
        threads: the stiffness of threads that are pulled, that are pushed together, and in shear, shape (3,), N/m.
        triangles: shape (m, 3).
        squares: the squared lengths of the edges without tension, shape (m, 3), m^2.
        strains: for warp, weft and shear the strain by each edge's growth in squared length, shape (m, 3, 3), 1/m^2.
        areas: shape (m,), m^2.
    """

    threads: FloatArray
    triangles: NDArray[np.int64]
    squares: FloatArray
    strains: FloatArray
    areas: FloatArray

    @staticmethod
    def of(pattern: FloatArray, triangles: NDArray[np.int64], fabric: Fabric, edge_m: float) -> "Weave":
        """Return the weave of a mesh.

        Args:
            pattern: the vertices in the frame of warp and weft, shape (n, 2), m.
            triangles: shape (m, 3).
            fabric: the cloth.
            edge_m: the distance between rows (m).
        """
        edges = _edges(pattern, triangles)
        x, y = edges[..., 0], edges[..., 1]
        strains: FloatArray = np.linalg.inv(2.0 * np.stack([x * x, y * y, x * y], axis=-1)).astype(np.float64)
        areas = np.abs(x[:, 0] * y[:, 1] - y[:, 0] * x[:, 1]) / 2.0
        threads = np.array([fabric.stretch_n_m, fabric.pushed_n_m(edge_m), fabric.shear_n_m])
        return Weave(threads, triangles, (edges * edges).sum(axis=-1), strains, areas)

    def stiffness(self, positions: FloatArray) -> FloatArray:
        """Return each triangle's coefficients in MuJoCo's order where the vertices are somewhere, shape (n, 3), m.

        Returns:
            Shape (m, 6), N/m^3: with the growths d of the squared lengths the energy is d S d / 4, of which a row has
            the upper half.
        """
        found: FloatArray = _stiffness(positions, self.triangles, self.squares, self.strains, self.areas, self.threads)
        return found


@kernel
def _stiffness(
    positions: FloatArray,
    triangles: NDArray[np.int64],
    squares: FloatArray,
    strains: FloatArray,
    areas: FloatArray,
    threads: FloatArray,
) -> FloatArray:
    """Return the coefficients of `Weave.stiffness`; `threads` are the stiffness pulled, pushed, and in shear (N/m)."""
    found, grown, moduli = np.empty((len(triangles), 6)), np.empty(3), np.empty(3)
    pulled, pushed, moduli[2] = threads
    for number in range(len(triangles)):
        for edge in range(3):
            one, other = triangles[number, edge - 2], triangles[number, edge - 1]
            squared = 0.0
            for axis in range(3):
                squared += (positions[one, axis] - positions[other, axis]) ** 2
            grown[edge] = squared - squares[number, edge]
        strain = strains[number]
        for way in range(2):
            along = strain[way, 0] * grown[0] + strain[way, 1] * grown[1] + strain[way, 2] * grown[2]
            moduli[way] = pushed if along < 0.0 else pulled
        at = 0
        for row in range(3):
            for column in range(row, 3):
                total = 0.0
                for way in range(3):
                    total += moduli[way] * strain[way, row] * strain[way, column]
                found[number, at] = 2.0 * areas[number] * total
                at += 1
    return found


def _edges(points: FloatArray, triangles: NDArray[np.int64]) -> FloatArray:
    corners = points[triangles]
    return np.asarray(np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1))
