"""The distance of each pixel of a picture from the table's colour and texture.

The table's colours are those at the picture's border. Light falls unevenly, so their lightness and colour are first
made even: a quadratic surface is fitted to what looks like the table, again and again without what does not. What is
left is compared with the few colours that the border has, each with its own spread: a grained table has several.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

from app.rehearsal.vision.picture import Image
from planner.geometry.pose import BoolArray

FloatImage = NDArray[np.float32]

BORDER = 0.06
"""The border's width, as a share of the picture's shorter side."""

_LEAST_SPREAD = np.array([7.0, 3.5, 3.5, 3.0], np.float32)
"""Least spread of lightness, the two colours and roughness within one colour of the table."""

_COLOURS = 4
_ROUNDS = 4
_RARE = 0.08


def border_of(shape: tuple[int, ...]) -> BoolArray:
    """Return which pixels lie at the border of a picture."""
    border = np.ones(shape[:2], bool)
    wide = max(2, round(BORDER * min(shape[:2])))
    border[wide:-wide, wide:-wide] = False
    return border


def unlikeness(image: Image, outside: BoolArray, table: BoolArray) -> FloatImage:
    """Return how many spreads each pixel is from the nearest colour of the table, shape of the picture.

    Args:
        image: blue, green, red.
        outside: which pixels are known not to be cloth: a sheet of paper.
        table: which pixels show the table for all that is known: those at the border.
    """
    features = _features(image)
    border = table & ~outside
    even = features - _surface(features, border)
    centres, spreads = _border_colours(even[border])
    nearest = np.full(image.shape[:2], np.inf, np.float32)
    for centre, spread in zip(centres, spreads, strict=True):
        nearest = np.minimum(nearest, (((even - centre) / spread) ** 2).sum(axis=2))
    return np.asarray(np.sqrt(nearest), np.float32)


def _features(image: Image) -> FloatImage:
    """Return lightness, the two colours and roughness of each pixel, a little smoothed."""
    smooth = cv2.bilateralFilter(image, 7, 30, 5)
    lab = cv2.cvtColor(np.asarray(smooth, np.float32) / np.float32(255.0), cv2.COLOR_BGR2Lab)
    light = np.ascontiguousarray(lab[:, :, 0])
    mean = cv2.blur(light, (9, 9))
    rough = np.sqrt(np.maximum(cv2.blur(light * light, (9, 9)) - mean * mean, 0.0))
    return np.asarray(np.dstack([lab, rough]), np.float32)


def _surface(features: FloatImage, border: BoolArray) -> FloatImage:
    """Return the quadratic surface through what looks like the table, without its mean, shape of the features."""
    height, width = border.shape
    down, across = (one.ravel() for one in np.mgrid[-1 : 1 : height * 1j, -1 : 1 : width * 1j].astype(np.float32))
    terms = np.stack([np.ones_like(down), across, down, across * down, across**2, down**2], axis=1)
    flat = features.reshape(len(terms), -1)
    used = at_border = border.ravel()
    surface = np.zeros_like(flat)
    for _ in range(_ROUNDS):
        some = terms[used]
        # Six normal equations are solved sooner than the least squares of all pixels.
        shares, _, _, _ = np.linalg.lstsq(some.T @ some, some.T @ flat[used], rcond=None)
        surface = terms @ shares
        off = np.abs(flat - surface)
        spread = np.maximum(1.5 * np.median(off[used], axis=0), _LEAST_SPREAD)
        used = (off < 2.5 * spread).all(axis=1)
        if used.mean() < BORDER:
            used = at_border
    return np.asarray((surface - surface[at_border].mean(axis=0)).reshape(features.shape), np.float32)


def _border_colours(samples: FloatImage) -> tuple[FloatImage, FloatImage]:
    """Return the colours of the border and their spreads, shape (k, 4), without those that few pixels have."""
    some = samples[:: max(1, len(samples) // 6000)]
    criteria = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 30, 0.1)
    cv2.setRNGSeed(7)
    _, labels, centres = cv2.kmeans(
        np.asarray(some / _LEAST_SPREAD, np.float32),
        _COLOURS,
        np.empty(0, np.int32),
        criteria,
        3,
        cv2.KMEANS_PP_CENTERS,
    )
    chosen = labels.ravel()
    kept = [k for k in range(len(centres)) if (chosen == k).mean() >= _RARE]
    spreads = [np.maximum(some[chosen == k].std(axis=0), _LEAST_SPREAD) for k in kept]
    return np.asarray(centres[kept] * _LEAST_SPREAD, np.float32), np.asarray(spreads, np.float32)
