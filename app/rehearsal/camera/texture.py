"""Textures of a table and of cloth, by chance."""

import cv2
import numpy as np
from numpy.typing import NDArray

from app.rehearsal.camera.look import Look

FloatImage = NDArray[np.float32]


def wood(look: Look, side: int, rng: np.random.Generator) -> FloatImage:
    """Return a table of `side` pixels a side, grained along its rows: blue, green, red."""
    grain = stretched(rng, side, (20, 2), 2.0)
    knots = stretched(rng, side, (20, 20), 1.3)
    shade = 22 * look.wood * (grain / grain.std() + 0.6 * knots / knots.std())
    tint = np.array([0.7, 0.9, 1.0], np.float32)
    return np.asarray(np.asarray(look.table, np.float32) + shade[:, :, None] * tint, np.float32)


def stretched(rng: np.random.Generator, side: int, times: tuple[int, int], blur: float) -> FloatImage:
    """Return noise of so many pixels, blurred and then stretched across and down."""
    across, down = times
    noise = rng.standard_normal((side // down + 1, side // across + 1), dtype=np.float32)
    if blur:
        noise = np.asarray(cv2.GaussianBlur(noise, (0, 0), blur), np.float32)
    return np.asarray(cv2.resize(noise, (side, side), interpolation=cv2.INTER_CUBIC), np.float32)
