"""The lights of the 3D view, and surface colours that look as intended under them.

The browser maps light to screen colours by a tone curve (the ACES fit of three.js), which greys and darkens: cream
looks cold white. The lights here are white: the sky, viser's own sun overhead, which casts the shadows, a key light
from where cameras mostly are, and a rim light from behind the robot. Their sum on level surfaces is known, so the curve
can be inverted: `paint` is the surface colour that looks like the colour wanted on a level surface in this light, and
`ink` that of a line, on which no light falls. Colours brighter than the curve can show are approximated as closely as
possible. Upright surfaces get less light and look darker, which shows their form.
"""

import functools
import itertools
import math

import numpy as np
import viser
from numpy.typing import NDArray

from app.ui.colours import Rgb
from planner.geometry.pose import FloatArray, Point3

SKY = "/sky"

_SKY_INTENSITY = 2.6
_GROUND_COLOUR = (120, 120, 122)
_LAMPS: tuple[tuple[str, Point3, float], ...] = (("/key", (2.0, 2.6, 2.2), 1.5), ("/rim", (-2.6, -1.6, 1.3), 1.9))
"""Lights that cast no shadows: name, direction they shine from (table frame), intensity."""
_SUN_INTENSITY = 3.0  # of viser's default light, which is nearly overhead and casts the shadows
_SUN_COSINE = 1.0 / math.hypot(1.0, 0.2, 0.2)
_SHEEN = 0.011  # reflection of the lights in a surface of any colour, measured from where cameras mostly are
_LAMPS_LEVEL = sum(intensity * at[2] / math.hypot(*at) for _, at, intensity in _LAMPS)
_LEVEL_LIGHT = (_SKY_INTENSITY + _SUN_INTENSITY * _SUN_COSINE + _LAMPS_LEVEL) / math.pi

_EXPOSURE = 1.0 / 0.6
_FIRST_STEP = 32
_INTO_FILM = np.array([[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]])
_OUT_OF_FILM = np.array([[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]])
_SHOULDER = (0.0245786, 0.000090537, 0.983729, 0.4329510, 0.238081)


def add_lights(server: viser.ViserServer) -> None:
    """Add white light from all round, more of it from above, viser's own overhead light, a key and a rim light."""
    server.scene.configure_environment_map(None)
    server.scene.configure_default_lights(enabled=True, cast_shadow=True)
    server.scene.add_light_hemisphere(
        SKY, sky_color=(255, 255, 255), ground_color=_GROUND_COLOUR, intensity=_SKY_INTENSITY, position=(0.0, 0.0, 1.0)
    )
    for name, position, intensity in _LAMPS:
        server.scene.add_light_directional(name, position=position, intensity=intensity)


def paint(wanted: Rgb) -> Rgb:
    """Return the colour of a level surface that looks as wanted, or as near to it as possible."""
    return _before_film(wanted, _LEVEL_LIGHT, _SHEEN)


def ink(wanted: Rgb) -> NDArray[np.uint8]:
    """Return the colour of a line, on which no light falls, that looks as wanted, or nearly; shape (3,)."""
    return np.array(_before_film(wanted, 1.0, 0.0), dtype=np.uint8)


def seen(painted: Rgb) -> Rgb:
    """Return how a level surface of a colour looks."""
    return _on_film(painted, _LEVEL_LIGHT, _SHEEN)


def seen_line(inked: Rgb) -> Rgb:
    """Return how a line of a colour looks."""
    return _on_film(inked, 1.0, 0.0)


def _on_film(colour: Rgb, light: float, sheen: float) -> Rgb:
    a, b, c, d, e = _SHOULDER
    x = _INTO_FILM @ ((_linear(colour) * light + sheen) * _EXPOSURE)
    film = (x * (x + a) - b) / (x * (c * x + d) + e)
    return _codes(_OUT_OF_FILM @ film)


@functools.cache
def _before_film(wanted: Rgb, light: float, sheen: float) -> Rgb:
    """Return the colour before the tone curve whose image is nearest to a wanted colour.

    Bright saturated colours are beyond what the curve shows. Clipping each channel would change their hue, so a search
    in ever smaller steps goes from the clipped colour to the nearest.
    """
    film = np.linalg.solve(_OUT_OF_FILM, _linear(wanted))
    nearest = _codes((np.linalg.solve(_INTO_FILM, _unshouldered(film)) / _EXPOSURE - sheen) / light)
    step = _FIRST_STEP
    while step:
        around = [_moved(nearest, turn, step) for turn in itertools.product((0, -1, 1), repeat=3)]
        best = min(around, key=lambda colour: math.dist(_on_film(colour, light, sheen), wanted))
        nearest, step = best, step if best != nearest else step // 2
    return nearest


def _moved(colour: Rgb, turn: tuple[int, ...], step: int) -> Rgb:
    red, green, blue = (min(max(part + way * step, 0), 255) for part, way in zip(colour, turn, strict=True))
    return red, green, blue


def _unshouldered(film: FloatArray) -> FloatArray:
    """Solve film = (x(x + a) - b) / (x(cx + d) + e) for x >= 0."""
    a, b, c, d, e = _SHOULDER
    square, line, rest = 1.0 - c * film, a - d * film, -b - e * film
    return np.asarray((-line + np.sqrt(line**2 - 4.0 * square * rest)) / (2.0 * square))


def _linear(colour: Rgb) -> FloatArray:
    encoded = np.array(colour) / 255.0
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def _codes(linear: FloatArray) -> Rgb:
    kept = np.clip(linear, 0.0, 1.0)
    encoded = np.where(kept <= 0.0031308, kept * 12.92, 1.055 * kept ** (1 / 2.4) - 0.055)
    red, green, blue = (round(255.0 * float(part)) for part in encoded)
    return red, green, blue
