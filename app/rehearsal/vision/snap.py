"""Draw an outline to the strongest edge near it."""

import cv2
import numpy as np
from numpy.typing import NDArray

from app.rehearsal.vision.picture import Image
from planner.geometry.pose import FloatArray

STEP = 2.0
"""The spacing of the points of an outline (pixels)."""

_SMOOTH = 2
_AWAY = 0.35
"""By which share an edge at the end of the reach counts less than one at the outline itself."""


def snapped(image: Image, outline: FloatArray, reach: float) -> tuple[FloatArray, float]:
    """Return an outline drawn to the strongest edges within `reach` pixels, and how strong these are (of 255).

    The edge of each point is looked for along the normal; then the shifts of neighbours are made alike by their median,
    so that a print on the cloth or a grain of the table pulls at none of them alone.
    """
    points = spaced(outline, STEP)
    normals = normals_of(points)
    offsets = np.arange(-reach, reach + 0.5, 0.5)
    steep = steepness(image, points, normals, offsets)
    weighed = steep * (1.0 - _AWAY * np.abs(offsets) / reach)
    best = weighed.argmax(axis=1)
    shift = _running_median(offsets[best] + peaks(weighed, best) * (offsets[1] - offsets[0]), _SMOOTH)
    strength = float(np.median(steep[np.arange(len(best)), best]))
    return np.asarray(points + shift[:, None] * normals), strength


def steepness(image: Image, points: FloatArray, normals: FloatArray, offsets: FloatArray) -> FloatArray:
    """Return how steep a picture is across an outline, of the colour that is steepest there (of 255 per pixel).

    Args:
        image: blue, green, red.
        points: of the outline, shape (n, 2), pixels.
        normals: across it, shape (n, 2).
        offsets: how far along them, evenly apart, shape (m,), pixels; the answer has shape (n, m).
    """
    places = points[:, None] + offsets[None, :, None] * normals[:, None]
    blurred = cv2.GaussianBlur(image, (0, 0), 1.2)
    profile = np.stack([_sampled(np.ascontiguousarray(blurred[:, :, k]), places) for k in range(3)], axis=2)
    return np.asarray(np.abs(np.gradient(profile, axis=1)).max(axis=2) / (offsets[1] - offsets[0]))


def spaced(ring: FloatArray, step: float) -> FloatArray:
    """Return points evenly along a ring, `step` apart, shape (n, k); columns beyond x and y come along."""
    closed = np.concatenate([ring, ring[:1]])
    reached = np.concatenate([[0.0], np.hypot(*np.diff(closed[:, :2], axis=0).T).cumsum()])
    places = np.linspace(0.0, reached[-1], max(8, round(reached[-1] / step)), endpoint=False)
    return np.column_stack([np.interp(places, reached, column) for column in closed.T])


def normals_of(points: FloatArray) -> FloatArray:
    """Return the unit normals of a ring of points, shape (n, 2): outwards where it goes clockwise as seen."""
    along = np.roll(points, -3, axis=0) - np.roll(points, 3, axis=0)
    length = np.maximum(np.hypot(*along.T), 1e-9)
    return np.column_stack([along[:, 1] / length, -along[:, 0] / length])


def _sampled(channel: Image, places: FloatArray) -> FloatArray:
    maps = np.asarray(places, np.float32)
    return np.asarray(
        cv2.remap(
            np.asarray(channel, np.float32),
            maps[:, :, 0],
            maps[:, :, 1],
            cv2.INTER_LINEAR,
            borderMode=cv2.BORDER_REPLICATE,
        ),
        np.float64,
    )


def peaks(values: FloatArray, best: NDArray[np.int64]) -> FloatArray:
    """Return how far the top of a parabola through each row's best value and its neighbours is from it (steps)."""
    rows, middle = np.arange(len(best)), np.clip(best, 1, values.shape[1] - 2)
    before, at, after = (values[rows, middle + k] for k in (-1, 0, 1))
    bend = before - 2.0 * at + after
    return np.where(bend < -1e-9, np.clip(0.5 * (before - after) / np.minimum(bend, -1e-9), -0.5, 0.5), 0.0)


def _running_median(values: FloatArray, half: int) -> FloatArray:
    return np.asarray(np.median([np.roll(values, k) for k in range(-half, half + 1)], axis=0))
