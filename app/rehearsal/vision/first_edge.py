"""Find where rays over cloth in a picture come to its first edge: where its colour changes for good.

The edge of a part that was folded over lies on the cloth below, which shows its other face, or another part of a print,
or on the table. Where it looks like what it lies on, no edge is found before that of the stack.
"""

import cv2
import numpy as np

from app.rehearsal.camera.camera import Camera
from app.rehearsal.vision.picture import Image
from planner.geometry.pose import BoolArray, FloatArray

_STEP_M = 0.0015
"""The distance between the points of a ray that are looked at (m)."""

_START_M = 0.03
"""The colour of so much of the rays, from their starts, is the cloth's (m)."""

_FOR_GOOD_M = 0.006
"""A colour that differs for so long has changed for good (m)."""

_LEAST, _SPREADS = 18.0, 5.0
"""The least change of colour (of 255), and how many standard deviations of the cloth's own it is at least."""


def first_edges(
    image: Image, camera: Camera, hidden: BoolArray, starts: FloatArray, ends: FloatArray, height_m: float
) -> FloatArray:
    """Return how far from its start each ray comes to an edge, shape (n,), m; NaN if it does not, or that is hidden.

    Args:
        image: blue, green, red.
        camera: the camera that took it.
        hidden: which pixels show something else, shape of the picture.
        starts: where rays start, on cloth of one colour, table frame, shape (n, 2), m; all are as long.
        ends: where they end, shape (n, 2), m.
        height_m: how high over the table they are (m).
    """
    if not len(starts):
        return np.empty(0)
    length_m = float(np.hypot(*(ends - starts).T).max())
    shares = np.linspace(0.0, 1.0, max(2, round(length_m / _STEP_M)))
    points = starts[:, None] + shares[:, None] * (ends - starts)[:, None]
    flat = np.column_stack([points.reshape(-1, 2), np.full(points.shape[0] * points.shape[1], height_m)])
    pixels = camera.pixels(flat).astype(np.float32).reshape(*points.shape[:2], 2)
    across, down = pixels[..., 0], pixels[..., 1]
    colours = cv2.remap(image, across, down, cv2.INTER_LINEAR).astype(np.float64)
    is_hidden = np.asarray(cv2.remap(hidden.astype(np.uint8), across, down, cv2.INTER_NEAREST, borderValue=1)) > 0
    cloth = colours[:, shares * length_m <= _START_M]
    middle = np.median(cloth.reshape(-1, 3), axis=0)
    spread = 1.4826 * float(np.median(np.linalg.norm(cloth - middle, axis=2)))
    differs = np.asarray(np.linalg.norm(colours - middle, axis=2) > max(_LEAST, _SPREADS * spread))
    count = max(1, round(_FOR_GOOD_M / _STEP_M))
    changed = np.asarray(np.lib.stride_tricks.sliding_window_view(differs | is_hidden, count, axis=1).all(axis=2))
    first = changed.argmax(axis=1)
    rows = np.arange(len(first))
    is_seen = changed[rows, first] & ~is_hidden[rows, first]
    return np.where(is_seen, shares[first] * length_m, np.nan)
