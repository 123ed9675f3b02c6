"""Draw triangles into an image of their numbers, the nearest on top."""

import cv2
import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray

Numbers = NDArray[np.int32]

_SHIFT = 4
_FINE = 1 << _SHIFT
"""Corners of triangles are at sixteenths of a pixel."""


def drawn(pixels: FloatArray, triangles: NDArray[np.int64], depths: FloatArray, size_px: tuple[int, int]) -> Numbers:
    """Return which triangle each pixel shows, shape (height, width); -1 where it shows none.

    The triangles are painted one over the other, the farthest first: cloth that lies in layers has no triangles that
    run through each other.

    Args:
        pixels: where the vertices are in the image, shape (n, 2).
        triangles: shape (m, 3).
        depths: how far ahead of the camera the vertices are, shape (n,), m.
        size_px: the image's width and height.
    """
    numbers = np.full(size_px[::-1], -1, np.int32)
    corners = np.clip(pixels, -4.0 * max(size_px), 4.0 * max(size_px))
    fixed = np.round(corners[triangles] * _FINE).astype(np.int32)
    for number in np.argsort(-depths[triangles].mean(axis=1), kind="stable").tolist():
        cv2.fillConvexPoly(numbers, fixed[number], number, cv2.LINE_8, _SHIFT)
    return numbers


def shares(numbers: Numbers, pixels: FloatArray, triangles: NDArray[np.int64]) -> tuple[NDArray[np.bool_], FloatArray]:
    """Return which pixels show a triangle, and how near each of these is to its corners, shape (k, 3), summing to 1.

    Perspective within one triangle is left out: they are small.
    """
    shown = numbers >= 0
    rows, columns = np.nonzero(shown)
    (ax, ay), (bx, by), (cx, cy) = pixels[triangles[numbers[shown]]].transpose(1, 2, 0)
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    area = np.where(np.abs(area) < 1e-6, 1e-6, area)
    second = ((columns - ax) * (cy - ay) - (rows - ay) * (cx - ax)) / area
    third = ((bx - ax) * (rows - ay) - (by - ay) * (columns - ax)) / area
    found = np.clip(np.column_stack([1.0 - second - third, second, third]), 0.0, 1.0)
    return shown, np.asarray(found / found.sum(axis=1, keepdims=True))
