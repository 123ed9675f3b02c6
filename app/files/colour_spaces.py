"""Converts colours of the spaces in CSS to sRGB.

The formulas and matrices are those of CSS Color Module Level 4, https://www.w3.org/TR/css-color-4/#color-conversion-code;
those of Oklab are Björn Ottosson's, https://bottosson.github.io/posts/oklab/.
"""

import math
from typing import TypeAlias

import numpy as np

from planner.geometry.pose import FloatArray

Rgb: TypeAlias = tuple[float, float, float]
"""Red, green and blue, 0..1."""

_LINEAR_OF_XYZ = np.array(
    [
        [3.2409699419, -1.5373831776, -0.4986107603],
        [-0.9692436363, 1.8759675015, 0.0415550574],
        [0.0556300797, -0.2039769589, 1.0569715142],
    ]
)
"""From XYZ under D65 to linear sRGB."""

_D65_OF_D50 = np.array(
    [
        [0.9554734528, -0.0230985368, 0.0632593087],
        [-0.0283697070, 1.0099954580, 0.0210413990],
        [0.0123140017, -0.0205076964, 1.3303659366],
    ]
)
"""From XYZ under D50 to XYZ under D65, by Bradford's method."""

_D50 = np.array([0.3457 / 0.3585, 1.0, (1.0 - 0.3457 - 0.3585) / 0.3585])
"""White under D50, as XYZ."""

_LMS_OF_OKLAB = np.array(
    [
        [1.0, 0.3963377774, 0.2158037573],
        [1.0, -0.1055613458, -0.0638541728],
        [1.0, -0.0894841775, -1.2914855480],
    ]
)
_LINEAR_OF_LMS = np.array(
    [
        [4.0767416621, -3.3077115913, 0.2309699292],
        [-1.2684380046, 2.6097574011, -0.3413193965],
        [-0.0041960863, -0.7034186147, 1.7076147010],
    ]
)


def rgb_of_lab(lightness: float, a: float, b: float) -> Rgb:
    """Return a colour of CIE Lab under D50, its lightness 0..100."""
    y = (lightness + 16.0) / 116.0
    roots = np.array([y + a / 500.0, y, y - b / 200.0])
    kappa, epsilon = 24389.0 / 27.0, 216.0 / 24389.0
    shares = np.where(roots**3 > epsilon, roots**3, (116.0 * roots - 16.0) / kappa)
    return rgb_of_xyz_d50(*(shares * _D50).tolist())


def rgb_of_oklab(lightness: float, a: float, b: float) -> Rgb:
    """Return a colour of Oklab, its lightness 0..1."""
    return _encoded(_LINEAR_OF_LMS @ (_LMS_OF_OKLAB @ np.array([lightness, a, b])) ** 3)


def rgb_of_xyz(x: float, y: float, z: float) -> Rgb:
    """Return a colour of CIE XYZ under D65."""
    return _encoded(_LINEAR_OF_XYZ @ np.array([x, y, z]))


def rgb_of_xyz_d50(x: float, y: float, z: float) -> Rgb:
    """Return a colour of CIE XYZ under D50."""
    return _encoded(_LINEAR_OF_XYZ @ (_D65_OF_D50 @ np.array([x, y, z])))


def rgb_of_linear(red: float, green: float, blue: float) -> Rgb:
    """Return a colour of linear sRGB."""
    return _encoded(np.array([red, green, blue]))


def from_polar(chroma: float, hue_deg: float) -> tuple[float, float]:
    """Return the coordinates a and b of a chroma and a hue."""
    return chroma * math.cos(math.radians(hue_deg)), chroma * math.sin(math.radians(hue_deg))


def _encoded(linear: FloatArray) -> Rgb:
    """Return linear sRGB as sRGB; what a screen cannot show is clipped, as browsers do."""
    kept = np.clip(np.nan_to_num(linear), 0.0, 1.0)
    red, green, blue = np.where(kept > 0.0031308, 1.055 * kept ** (1.0 / 2.4) - 0.055, 12.92 * kept).tolist()
    return (red, green, blue)
