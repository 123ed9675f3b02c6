"""Paint triangles into a picture without a graphics card: which of them is nearest at each pixel, and how bright it is.

A kernel goes through the triangles and keeps, for each pixel, the nearest one so far. Whatever the triangles are, the
picture is right where they hide or cut each other.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.kernels import kernel

Triangles: TypeAlias = NDArray[np.int64]
Numbers: TypeAlias = NDArray[np.int32]
Plane: TypeAlias = NDArray[np.float32]

_NEAR_M = 0.05
"""Triangles that come nearer to the lens are left out (m)."""


def nearest(
    pixels: FloatArray, depths: FloatArray, lights: FloatArray, triangles: Triangles, size_px: tuple[int, int]
) -> tuple[Numbers, Plane]:
    """Return which triangle each pixel shows, -1 for none, and how bright it is there, shape (height, width).

    Args:
        pixels: where the vertices are in the picture, shape (n, 2).
        depths: how far ahead of the lens they are, shape (n,), m.
        lights: how bright they are, shape (n,).
        triangles: shape (m, 3).
        size_px: the picture's width and height.
    """
    shape = size_px[::-1]
    numbers, nearness, brightness = (
        np.full(shape, -1, np.int32),
        np.zeros(shape, np.float32),
        np.zeros(shape, np.float32),
    )
    shown = np.flatnonzero(depths[triangles].min(axis=1) > _NEAR_M)
    inverses = 1.0 / np.where(depths > _NEAR_M, depths, 1.0)
    _paint(numbers, nearness, brightness, pixels, inverses, lights, triangles, shown)
    return numbers, brightness


@kernel
def _paint(
    numbers: Numbers,
    nearness: Plane,
    brightness: Plane,
    pixels: FloatArray,
    inverses: FloatArray,
    lights: FloatArray,
    triangles: Triangles,
    shown: NDArray[np.int64],
) -> None:
    """Write each triangle shown where it is the nearest; 1 / depth is linear in the picture."""
    height, width = numbers.shape
    for number in shown:
        a, b, c = triangles[number]
        ax, ay = pixels[a]
        bx, by = pixels[b]
        cx, cy = pixels[c]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0.0:
            continue
        first, last = max(0, int(np.ceil(min(ay, by, cy)))), min(height - 1, int(np.floor(max(ay, by, cy))))
        left, right = max(0, int(np.ceil(min(ax, bx, cx)))), min(width - 1, int(np.floor(max(ax, bx, cx))))
        for y in range(first, last + 1):
            for x in range(left, right + 1):
                second = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
                third = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
                if second >= 0.0 and third >= 0.0 and second + third <= 1.0:
                    own = 1.0 - second - third
                    near = inverses[a] * own + inverses[b] * second + inverses[c] * third
                    if near > nearness[y, x]:
                        nearness[y, x] = near
                        numbers[y, x] = number
                        brightness[y, x] = lights[a] * own + lights[b] * second + lights[c] * third
