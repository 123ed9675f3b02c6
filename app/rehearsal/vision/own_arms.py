"""Measure the offset of a part of a robot in a picture from where it should be seen.

A robot knows where its arms are, and so where they ought to be seen. The result is the shift that brings the
outline of a part onto the steepest edges of the picture: first on a grid, where all points of the outline vote, then by
robust least squares, together with how much too wide the outline is seen: without that, a part of which only one side
is seen would seem shifted to that side.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from app.rehearsal.camera.camera import Camera
from app.rehearsal.camera.robot_shape import hidden, rising
from app.rehearsal.vision.picture import Image
from app.rehearsal.vision.snap import normals_of, peaks, spaced, steepness
from planner.geometry.pose import FloatArray

_MOST_M = 0.03
"""The largest shift that is tried, each way (m)."""

_GRID_M = 0.0015
"""The spacing of the shifts that are tried first (m)."""

_AS_STEEP = 0.9
"""Shifts whose edges have this share of the steepest one's slope fit as well; the likeliest of them is taken."""

_STEP_PX, _APART_PX = 0.5, 2.0
"""The spacing of the samples across an outline, and along it (pixels)."""

_NEAR_PX = 4.0
"""The distance from the best shift of the grid within which edges are looked for (pixels)."""

_EDGE_PX, _ALIKE_PX = 1.0, 10.0
"""The error of an edge seen (standard deviation), and the length along which such errors are alike (pixels)."""

_WIDER_PX = 1.0
"""How much wider than it should be an outline may be seen, to each side (standard deviation, pixels).

Pixels that a part only touches show it, light blooms, and hulls are of some points of a mesh.
"""

_ACROSS_PX = 3.0
"""How far to both sides a point of an outline must have nothing of the robot, and something of it (pixels)."""

_LEAST_POINTS = 30

_FAINT = 5.0
"""The least steepness of edges beside an outline that is seen, the median (of 255 per pixel); noise has 1 to 2."""

_ROUNDS = 5


@dataclass(frozen=True, slots=True, eq=False)
class SeenBeside:
    """The offset of something seen from where it should be.

    Attributes:
        shift_m: from where it should be seen to where it is seen, in the table's plane, shape (2,), m.
        covariance_m2: of the shift, shape (2, 2), m2; large across ways in which no outline tells of it.
    """

    shift_m: FloatArray
    covariance_m2: FloatArray


def seen_beside(
    image: Image, camera: Camera, parts: list[FloatArray], others: list[FloatArray], likely_m2: FloatArray
) -> SeenBeside | None:
    """Return the offset of some parts of a robot as seen from where they should be; None if too little is seen.

    Args:
        image: blue, green, red.
        camera: where the camera is believed to be.
        parts: the points of these parts, table frame, each of shape (n, 3), m.
        others: those of the robot's other parts, which may hide them.
        likely_m2: the covariance of the offset known beforehand, shape (2, 2), m2.
    """
    points, normals = _outline(parts, others, camera)
    if len(points) < _LEAST_POINTS:
        return None
    slopes = _slopes(points, normals, camera)
    reach = float(np.abs(slopes).sum(axis=1).max()) * _MOST_M + _NEAR_PX
    offsets = np.arange(-np.ceil(reach), np.ceil(reach) + _STEP_PX, _STEP_PX)
    steep = steepness(image, camera.pixels(points), normals, offsets)
    if float(np.median(steep.max(axis=1))) < _FAINT:
        return None
    return _refined(_best_of_grid(likely_m2, slopes, offsets, steep), slopes, offsets, steep)


def _outline(parts: list[FloatArray], others: list[FloatArray], camera: Camera) -> tuple[FloatArray, FloatArray]:
    """Return points of some parts at the robot's outline, shape (n, 3), m, and the normals in the picture, (n, 2)."""
    robot, found = hidden([*parts, *others], camera), [np.empty((0, 7))]
    for part in rising(parts, camera):
        hull = cv2.convexHull(camera.pixels(part).astype(np.float32), returnPoints=False)[:, 0]
        ring = spaced(np.column_stack([camera.pixels(part[hull]), part[hull]]), _APART_PX)
        pixels, normals = ring[:, :2], normals_of(ring[:, :2])
        outwards = np.sign(((pixels - pixels.mean(axis=0)) * normals).sum(axis=1))
        found.append(np.column_stack([ring, outwards[:, None] * normals]))
    rows = np.concatenate(found)
    pixels, points, normals = rows[:, :2], rows[:, 2:5], rows[:, 5:]
    within, beyond = pixels - _ACROSS_PX * normals, pixels + _ACROSS_PX * normals
    size = np.array(camera.size_px)
    is_shown = ((np.minimum(within, beyond) >= 0.0) & (np.maximum(within, beyond) <= size - 1)).all(axis=1)
    points, normals, within, beyond = (one[is_shown] for one in (points, normals, within, beyond))
    (c, r), (c_out, r_out) = np.round(within).astype(np.int64).T, np.round(beyond).astype(np.int64).T
    is_outer = robot[r, c] & ~robot[r_out, c_out]
    return points[is_outer], normals[is_outer]


def _slopes(points: FloatArray, normals: FloatArray, camera: Camera) -> FloatArray:
    """Return how far points move along their normals for a shift in the table's plane, shape (n, 2), pixels per m."""
    here = camera.pixels(points)
    moved = [camera.pixels(points + _GRID_M * axis) - here for axis in np.eye(3)[:2]]
    return np.column_stack([(one * normals).sum(axis=1) / _GRID_M for one in moved])


def _best_of_grid(likely_m2: FloatArray, slopes: FloatArray, offsets: FloatArray, steep: FloatArray) -> FloatArray:
    """Return the likeliest of the shifts with the steepest edges, shape (2,), m.

    Edges steeper than the median count as the median does.
    """
    axis = np.arange(-_MOST_M, _MOST_M + _GRID_M / 2.0, _GRID_M)
    shifts = np.stack(np.meshgrid(axis, axis), axis=2).reshape(-1, 2)
    at = np.round((slopes @ shifts.T - offsets[0]) / _STEP_PX).astype(np.int64)
    capped = np.minimum(steep, np.median(steep.max(axis=1)))
    votes = np.take_along_axis(capped, at, axis=1).sum(axis=0)
    best = shifts[votes >= _AS_STEEP * votes.max()]
    return np.asarray(best[(best @ np.linalg.inv(likely_m2) * best).sum(axis=1).argmin()])


def _refined(shift_m: FloatArray, slopes: FloatArray, offsets: FloatArray, steep: FloatArray) -> SeenBeside:
    """Return the shift by least squares to the steepest edge near each point; edges further away count less."""
    factors = np.column_stack([slopes, np.ones(len(slopes))])
    held = np.diag([_EDGE_PX / _MOST_M, _EDGE_PX / _MOST_M, _EDGE_PX / _WIDER_PX]) ** 2
    state = np.append(shift_m, 0.0)
    for _ in range(_ROUNDS):
        ought = factors @ state
        near = np.where(np.abs(offsets - ought[:, None]) <= _NEAR_PX, steep, 0.0)
        at = near.argmax(axis=1)
        left = offsets[at] + _STEP_PX * peaks(near, at) - ought
        weights = near.max(axis=1) / near.max() / (1.0 + (left / _EDGE_PX) ** 2)
        information = factors.T @ (weights[:, None] * factors) * _APART_PX / _ALIKE_PX + held
        state = state + np.linalg.solve(information, factors.T @ (weights * left) * _APART_PX / _ALIKE_PX)
    return SeenBeside(state[:2], np.linalg.inv(information)[:2, :2] * _EDGE_PX**2)
