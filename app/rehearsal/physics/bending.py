"""How cloth bends at the edges of its mesh: a moment that grows as the angle, and the friction of threads."""

import math

import mujoco
import numpy as np

from planner.geometry.pose import FloatArray

_FLAT = 0.2
"""The angle from folded flat up to which the moment fades out (rad): folded flat, a hinge has no side to open to."""

_MOST = (math.pi - _FLAT) / math.sin(_FLAT)
"""The largest factor: that of a hinge at this angle from folded flat."""

_STIFFER = 3.0
"""How much stiffer cloth is while its threads do not slide yet: so soon is friction whole after bending has turned."""

_TINY_M4, _TINY_RAD = 1e-24, 1e-9


class Hinges:
    """The edges at which two triangles meet.

    MuJoCo's energy of bending is quadratic in the vertices' places, so it grows as 1 - cos of the angle, and its moment
    as the sine: an edge doubled back at one row of the mesh had next to none that opened it, and stayed there under its
    own weight, where a strip of cloth as stiff springs open. The moment of a strip grows as its curvature.

    Threads that slide on each other while cloth bends add the moment of their friction, and take it off while cloth
    opens (2HB of the Kawabata system is the distance of both curves). Cloth that is bent less than friction bears stays
    as it is. Angles have no sign here, so cloth that is bent through flat meets its friction a little late.
    """

    def __init__(self, model: mujoco.MjModel, rest: FloatArray, friction_per_m: float) -> None:
        """Find the hinges of a model whose one flex bends.

        Args:
            model: with MuJoCo's own coefficients, which hold for small angles.
            rest: the vertices of the flat cloth, shape (n, 3), m.
            friction_per_m: the curvature at which stiffness bears as much as friction (1/m).
        """
        self._numbers = np.flatnonzero((model.flex_edgeflap >= 0).all(axis=1))
        self._corners = np.column_stack([model.flex_edge, model.flex_edgeflap])[self._numbers]
        self._flat = model.flex_bending.reshape(len(model.flex_edge), -1)[self._numbers].copy()
        self._friction_rad = friction_per_m * _widths_m(rest[self._corners])
        self._slid_rad = np.zeros(len(self._numbers))

    def rest(self, positions: FloatArray) -> None:
        """Let the threads rest where vertices are, shape (n, 3), m: friction holds neither way."""
        self._slid_rad = bent_rad(positions[self._corners])

    def stiffen(self, model: mujoco.MjModel, positions: FloatArray) -> None:
        """Give a model the coefficients for where its vertices have got to, shape (n, 3), m."""
        bent = bent_rad(positions[self._corners])
        moments, self._slid_rad = moments_rad(bent, self._slid_rad, self._friction_rad)
        scale = angle_over_sine(bent) * moments / np.maximum(bent, _TINY_RAD)
        model.flex_bending.reshape(len(model.flex_edge), -1)[self._numbers] = self._flat * scale[:, None]


def moments_rad(bent: FloatArray, slid: FloatArray, friction: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the moments that open hinges, over their stiffness, and where their threads have slid to, shape (k,), rad.

    Args:
        bent: the angles, shape (k,), rad.
        slid: the angles at which friction would hold neither way, shape (k,), rad.
        friction: the moment of whole friction over stiffness, shape (k,), rad.
    """
    slid = np.clip(slid, bent - friction / _STIFFER, bent + friction / _STIFFER)
    return np.maximum(bent + _STIFFER * (bent - slid), 0.0), slid


def bent_rad(corners: FloatArray) -> FloatArray:
    """Return the angles between pairs of triangles, 0 where they lie in one plane, shape (k,), rad.

    Args:
        corners: the two ends of the edge that they share and the corner of either beyond it, shape (k, 4, 3), m.
    """
    first, second = _normals(corners)
    sizes = np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
    cosines = (first * second).sum(axis=1) / np.maximum(sizes, _TINY_M4)
    return np.asarray(np.arccos(np.clip(cosines, -1.0, 1.0)))


def angle_over_sine(angles: FloatArray) -> FloatArray:
    """Return the bounded ratios of angles (rad) to their sines: by so much a moment linear in the angle is larger."""
    return np.asarray(np.minimum(1.0 / np.maximum(np.sinc(angles / math.pi), 1.0 / _MOST), _MOST))


def _widths_m(corners: FloatArray) -> FloatArray:
    """Return the widths of cloth that bend at hinges: half of both triangles' heights over it, shape (k,), m."""
    first, second = _normals(corners)
    along = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    return np.asarray((np.linalg.norm(first, axis=1) + np.linalg.norm(second, axis=1)) / (2.0 * along))


def _normals(corners: FloatArray) -> tuple[FloatArray, FloatArray]:
    along, one, other = (corners[:, i] - corners[:, 0] for i in (1, 2, 3))
    return np.cross(along, one), np.cross(other, along)
