"""Decides which colours mean a fold: blue for all layers, red for the last flap.

Drawing programs offer many blues, so the hue decides, unless the colour is nearly grey.
"""

import colorsys
import re
from typing import TypeAlias

Rgb: TypeAlias = tuple[float, float, float]
"""Red, green and blue, 0..1."""

BLUE_DEG = (195.0, 265.0)
RED_DEG = (-25.0, 25.0)
"""The hues that count as blue and as red (degrees)."""

_CHROMA_MIN = 0.25
"""Least difference between the largest and the smallest of red, green and blue; colours below count as grey."""

_LONGEST = 100
"""Longest text that is parsed as a colour (characters)."""

_NAMED = {
    "blue": "0000ff",
    "cornflowerblue": "6495ed",
    "crimson": "dc143c",
    "darkblue": "00008b",
    "darkred": "8b0000",
    "deepskyblue": "00bfff",
    "dodgerblue": "1e90ff",
    "firebrick": "b22222",
    "indianred": "cd5c5c",
    "mediumblue": "0000cd",
    "midnightblue": "191970",
    "navy": "000080",
    "orangered": "ff4500",
    "red": "ff0000",
    "royalblue": "4169e1",
    "steelblue": "4682b4",
    "tomato": "ff6347",
}
_HEX = re.compile(r"#(?:[0-9a-f]{3,4}|[0-9a-f]{6}|[0-9a-f]{8})")
_FUNCTION = re.compile(r"(rgb|hsl)a?\(([^()]*)\)")
_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(%?)(?:deg)?")


def kind_of(rgb: Rgb | None) -> str | None:
    """Return the kind of fold that a colour means, "blue" or "red", or None."""
    if rgb is None or max(rgb) - min(rgb) < _CHROMA_MIN:
        return None
    hue_deg = 360.0 * colorsys.rgb_to_hsv(*rgb)[0]
    if BLUE_DEG[0] <= hue_deg <= BLUE_DEG[1]:
        return "blue"
    is_red = hue_deg <= RED_DEG[1] or hue_deg - 360.0 >= RED_DEG[0]
    return "red" if is_red else None


def css_rgb(text: str) -> Rgb | None:
    """Return a CSS colour: a name, ``#rgb``, ``#rrggbb``, ``rgb()`` or ``hsl()``; None for any other text."""
    if len(text) > _LONGEST:
        return None
    wanted = text.strip().lower()
    wanted = f"#{_NAMED[wanted]}" if wanted in _NAMED else wanted
    if _HEX.fullmatch(wanted):
        return hex_rgb(wanted[1:])
    function = _FUNCTION.fullmatch(wanted)
    return None if function is None else _called(function[1], _NUMBER.findall(function[2]))


def hex_rgb(digits: str) -> Rgb:
    """Return the colour of three or six hexadecimal digits; ignore a fourth, or a seventh and eighth (alpha)."""
    wide = digits if len(digits) >= 6 else "".join(2 * digit for digit in digits)
    red, green, blue = (int(wide[i : i + 2], 16) / 255.0 for i in (0, 2, 4))
    return (red, green, blue)


def _called(name: str, numbers: list[tuple[str, str]]) -> Rgb | None:
    if len(numbers) < 3:
        return None
    first, second, third = numbers[:3]
    if name == "hsl":
        hue, saturation, lightness = float(first[0]) / 360.0, float(second[0]) / 100.0, float(third[0]) / 100.0
        return colorsys.hls_to_rgb(hue % 1.0, _kept(lightness), _kept(saturation))
    red, green, blue = (_kept(float(number) / (100.0 if percent else 255.0)) for number, percent in numbers[:3])
    return (red, green, blue)


def _kept(value: float) -> float:
    return min(max(value, 0.0), 1.0)
