"""Threads on painted cloth, as `static/weave.js` has them drawn in the 3D view.

Along warp and weft of the pattern threads of 1 mm are uneven in bands of 3 and of 8 mm. Threads finer than a pixel are
left out.
"""

import numpy as np

from planner.geometry.pose import FloatArray

_THREAD_M, _BANDS_M = 0.001, (0.003, 0.008)
_OVER, _UNEVEN = 0.12, 0.055
"""How much more light a thread returns where it lies on top, and bands at most, as shares."""

_GAMMA = 2.2
"""The exponent from a colour's number to its light."""


def woven(places: FloatArray, pixel_m: FloatArray) -> FloatArray:
    """Return by what cloth's colour is multiplied for its threads, shape (n,): about 1.

    Args:
        places: coordinates of the pattern, shape (n, 2), m.
        pixel_m: how much of the cloth a pixel shows there, shape (n,), m.
    """
    threads = places / _THREAD_M
    over = _shown(pixel_m / _THREAD_M) * np.sin(np.pi * threads[:, 0]) * np.sin(np.pi * threads[:, 1])
    bands = [_uneven(places / width_m, pixel_m / width_m) for width_m in _BANDS_M]
    return np.asarray((1.0 + _OVER * over + _UNEVEN * sum(bands)) ** (1.0 / _GAMMA))


def _uneven(threads: FloatArray, pixel: FloatArray) -> FloatArray:
    number, along = np.floor(threads), threads / 20.0
    return _shown(pixel) * (_tone(number[:, 0], along[:, 1]) + _tone(number[:, 1] + 311.0, along[:, 0]))


def _shown(pixel: FloatArray) -> FloatArray:
    """Return how much of threads is seen by how many of them a pixel shows: 0 to 1."""
    return 1.0 - _eased(np.clip((pixel - 0.4) / 0.8, 0.0, 1.0))


def _tone(thread: FloatArray, along: FloatArray) -> FloatArray:
    """Return how bright a thread is, from -1 to 1, which changes along it."""
    part = np.floor(along)
    start, end = (_chance(thread + 57.0 * (part + n)) for n in (0.0, 1.0))
    return np.asarray(2.0 * (start + (end - start) * _eased(along - part)) - 1.0)


def _chance(number: FloatArray) -> FloatArray:
    """Return a number from 0 to 1 that looks like chance."""
    return np.asarray(np.sin(12.9898 * number) * 43758.5453 % 1.0)


def _eased(share: FloatArray) -> FloatArray:
    return share * share * (3.0 - 2.0 * share)
