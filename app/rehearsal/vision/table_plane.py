"""The plane of the table in a picture, by a rectangle of known sides that lies on it.

Four corners give a homography, but a small sheet tells little of the perspective: half a pixel at one corner makes a
shirt beside it 5 % longer. So a camera is fitted to the corners, with square pixels, its axis in the middle of the
picture, and a focal length near to what cameras have.
"""

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np
from scipy.optimize import least_squares

from planner.geometry.pose import BoolArray, FloatArray

_CORNER_PX = 0.2
"""Standard deviation of a corner found in a picture (pixels)."""

_FREE = 2
"""The number of measurements (four corners and a focal length) beyond the number of fitted parameters."""

_NEAREST_M = 0.05
"""The least distance from a camera to what it shows (m)."""

_EDGE_PX = 0.6
"""All edges of a sheet may be seen so far outside or inside of where they are (pixels): blur and its shadow do that."""

_DRAWS = 32
"""The number of random cameras from which the uncertainty of sizes is estimated."""


@dataclass(frozen=True, slots=True)
class Focal:
    """What is known of a camera's focal length.

    Attributes:
        sides: the focal length, in longer sides of the picture.
        spread: the standard deviation of its logarithm.
    """

    sides: float
    spread: float


USUAL_FOCAL = Focal(0.95, 0.3)
"""The usual focal lengths of cameras; an assumption."""


@dataclass(frozen=True, slots=True, eq=False)
class Plane:
    """The table's plane as a picture shows it.

    Attributes:
        by: what it was found by: "a4", "letter" or "marker".
        to_table: the homography from pixels to the table (m): the origin in the middle of the sheet or marker, x along
            its longer (or upper) side, y up, z towards the camera; shape (3, 3).
        corners: its corners in the picture, shape (4, 2), pixels.
        misfit: how badly the corners fit what a camera sees of it, as a sum of squared standard deviations.
        draws: other homographies that the corners allow, as likely as they are.
    """

    by: str
    to_table: FloatArray
    corners: FloatArray
    misfit: float
    draws: tuple[FloatArray, ...]

    def on_table(self, pixels: FloatArray) -> FloatArray:
        """Return where pixels, shape (n, 2), are on the table (m)."""
        across = np.column_stack([pixels, np.ones(len(pixels))]) @ self.to_table.T
        return np.asarray(across[:, :2] / across[:, 2:])

    def up_rad(self, pixel: FloatArray) -> float:
        """Return the direction on the table that is up in the picture, at a pixel of shape (2,)."""
        here, above = self.on_table(np.array([pixel, pixel - np.array([0.0, 1.0])]))  # a picture's y runs down
        return math.atan2(above[1] - here[1], above[0] - here[0])

    def is_above(self, pixels: FloatArray) -> bool:
        """Return whether all pixels, shape (n, 2), show the table and none what is at its horizon or beyond."""
        depth = np.column_stack([pixels, np.ones(len(pixels))]) @ self.to_table[2]
        return bool(depth.min() * depth.max() > 0 and np.abs(depth).max() < 8.0 * np.abs(depth).min())

    def size_error(self, pixels: FloatArray) -> float:
        """Return by which share the size of a figure, its pixels of shape (n, 2), may be wrong: at about 95 of 100."""
        spans = [float(np.ptp(replace(self, to_table=one).on_table(pixels), axis=0).max()) for one in self.draws]
        worse = math.sqrt(max(1.0, self.misfit / _FREE))  # corners further off than their noise say that it is larger
        by_corners = 2.0 * worse * float(np.std(spans) / np.mean(spans))
        sides = np.hypot(*(np.roll(self.corners, -1, axis=0) - self.corners).T)
        return math.hypot(by_corners, 2.0 * _EDGE_PX / float(sides.mean()))

    def covers(self, shape: tuple[int, ...]) -> BoolArray:
        """Return which pixels it covers, with a margin."""
        middle = self.corners.mean(axis=0)
        mask = np.zeros(shape[:2], np.uint8)
        cv2.fillConvexPoly(mask, np.asarray(middle + 1.12 * (self.corners - middle), np.int32), 1)
        return mask > 0


def plane_of(
    by: str, quad: FloatArray, width_m: float, height_m: float, shape: tuple[int, ...], focal: Focal = USUAL_FOCAL
) -> Plane:
    """Return the plane in which a rectangle lies.

    Args:
        by: what the rectangle is.
        quad: its corners in the picture, clockwise from its upper left one, shape (4, 2), pixels.
        width_m: its upper side (m).
        height_m: its left side (m).
        shape: the picture's height and width (pixels).
        focal: what is known of the camera's focal length.
    """
    x, y = width_m / 2.0, height_m / 2.0
    corners = np.array([(-x, y, 0.0), (x, y, 0.0), (x, -y, 0.0), (-x, -y, 0.0)])
    height, width = shape[:2]
    longer, middle = float(max(width, height)), np.array([width / 2.0, height / 2.0])

    def off(row: FloatArray) -> FloatArray:
        seen = _seen(row, longer) @ np.column_stack([corners[:, :2], np.ones(4)]).T
        gaps = (seen[:2] / seen[2]).T + middle - quad
        return np.append(gaps.ravel() / _CORNER_PX, (row[6] - math.log(focal.sides)) / focal.spread)

    _, turns, places, _ = cv2.solvePnPGeneric(
        corners, quad.astype(np.float64), _intrinsic(focal.sides * longer, middle), None, flags=cv2.SOLVEPNP_IPPE
    )
    starts = [
        _row(np.asarray(turn, np.float64).ravel(), np.asarray(place, np.float64).ravel(), focal)
        for turn, place in zip(turns, places, strict=True)
    ]
    fits = [least_squares(off, start, x_scale=0.1, max_nfev=60) for start in starts]
    found = min(fits, key=lambda fit: float(fit.cost))  # a tilt and its opposite look much alike
    shift = np.array([[1.0, 0.0, middle[0]], [0.0, 1.0, middle[1]], [0.0, 0.0, 1.0]])
    covariance = np.linalg.inv(found.jac.T @ found.jac + 1e-9 * np.eye(7))
    rows = np.random.default_rng(0).multivariate_normal(found.x, covariance, _DRAWS, method="cholesky")
    to_table, *draws = (np.asarray(np.linalg.inv(shift @ _seen(row, longer)), np.float64) for row in (found.x, *rows))
    return Plane(by, to_table, quad, float(2.0 * found.cost), tuple(draws))


def clockwise(quad: FloatArray) -> FloatArray:
    """Return corners in the order that is clockwise in the picture, whose y runs down."""
    (ax, ay), (bx, by) = quad[1] - quad[0], quad[2] - quad[0]
    return quad if ax * by - ay * bx > 0 else quad[::-1]


def _row(turn: FloatArray, place: FloatArray, focal: Focal) -> FloatArray:
    """Return a camera's turn and place as the row that is fitted, see `_seen`."""
    right, down, depth = place[0], place[1], max(float(place[2]), _NEAREST_M)
    at = [focal.sides * right / depth, focal.sides * down / depth, math.log(focal.sides / depth)]
    return np.array([*turn, *at, math.log(focal.sides)])


def _seen(row: FloatArray, longer: float) -> FloatArray:
    """Return the homography from the plane to pixels from the picture's middle.

    The row is the turn (3), where the plane's origin is seen (2, in longer sides of the picture), the logarithm of the
    scale there (longer sides per metre), and that of the focal length. A scale, and not a depth: seen from straight
    above, focal length and depth cannot be distinguished, but their quotient is known well.
    """
    turned, _ = cv2.Rodrigues(np.ascontiguousarray(row[:3]))
    focal, depth = math.exp(float(row[6])), math.exp(float(row[6] - row[5]))
    place = depth * np.array([row[3] / focal, row[4] / focal, 1.0])
    return np.asarray(np.diag([focal * longer, focal * longer, 1.0]) @ np.column_stack([turned[:, :2], place]))


def _intrinsic(focal: float, middle: FloatArray) -> FloatArray:
    return np.array([[focal, 0.0, middle[0]], [0.0, focal, middle[1]], [0.0, 0.0, 1.0]])
