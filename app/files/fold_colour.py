"""Decides which colours mean which kind of fold (`FOLD_LOOKS`).

Drawing programs offer many blues, so the hue decides, unless the colour is nearly grey.
"""

import colorsys
import math
import re
from collections.abc import Callable, Mapping
from typing import TypeAlias

from PIL import ImageColor

from app.files.colour_spaces import (
    Rgb,
    from_polar,
    rgb_of_lab,
    rgb_of_linear,
    rgb_of_oklab,
    rgb_of_xyz,
    rgb_of_xyz_d50,
)
from app.fold_looks import FOLD_LOOKS

_CHROMA_MIN = 0.25
"""Least difference between the largest and the smallest of red, green and blue; colours below count as grey."""

_LONGEST = 100
"""Longest text that is parsed as a colour (characters)."""

_NAMED = {name: "#{:02x}{:02x}{:02x}".format(*ImageColor.getrgb(name)[:3]) for name in ImageColor.colormap}
"""The colours that CSS has names for, as ``#rrggbb``."""

_HEX = re.compile(r"#(?:[0-9a-f]{3,4}|[0-9a-f]{6}|[0-9a-f]{8})")
_FUNCTION = re.compile(r"(rgb|hsl|hwb|lab|lch|oklab|oklch|color)a?\(([^()]*)\)")

_SPACES: Mapping[str, Callable[[float, float, float], Rgb] | None] = {
    "srgb": None,
    "display-p3": None,
    "a98-rgb": None,
    "prophoto-rgb": None,
    "rec2020": None,
    "srgb-linear": rgb_of_linear,
    "xyz": rgb_of_xyz,
    "xyz-d65": rgb_of_xyz,
    "xyz-d50": rgb_of_xyz_d50,
}
"""The spaces of ``color()``; None for those whose numbers are red, green and blue: hues differ by too little."""

_LABS: Mapping[str, tuple[Callable[[float, float, float], Rgb], float, float, float]] = {
    "lab": (rgb_of_lab, 100.0, 125.0, 0.0),
    "lch": (rgb_of_lab, 100.0, 0.0, 150.0),
    "oklab": (rgb_of_oklab, 1.0, 0.4, 0.0),
    "oklch": (rgb_of_oklab, 1.0, 0.0, 0.4),
}
"""Functions with a lightness: the conversion, and what 100 % is of lightness, of a and b, of chroma (0: none)."""

_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d{1,3})?|none)(%|deg|grad|rad|turn)?")
_Number: TypeAlias = tuple[str, str]

_COMMA = re.compile(r",(?![^(]*\))")
"""A comma that is not in the brackets of a colour."""

_PERCENT = re.compile(r"(?:^|(?<=[\s)]))(\d{1,3}(?:\.\d{0,9})?)%(?=\s|$)(?![^(]*\))")
"""A percentage that is not in the brackets of a colour."""

_UNITS_DEG: Mapping[str, float] = {"deg": 1.0, "grad": 0.9, "rad": math.degrees(1.0), "turn": 360.0}
"""The units of hues (degrees)."""

_LARGEST = 1e4
"""The largest number that a colour is read with; larger ones mean the same as this."""


def kind_of(rgb: Rgb | None) -> str | None:
    """Return the kind of fold that a colour means, or None."""
    if rgb is None or max(rgb) - min(rgb) < _CHROMA_MIN:
        return None
    turn_deg = 360.0 * colorsys.rgb_to_hsv(*rgb)[0]
    hue_deg = turn_deg if turn_deg < 180.0 else turn_deg - 360.0
    return next((kind for kind, look in FOLD_LOOKS.items() if look.hues_deg[0] <= hue_deg <= look.hues_deg[1]), None)


def css_rgb(text: str) -> Rgb | None:
    """Return a CSS colour: a name, ``#rgb``, ``#rrggbb``, or a function such as ``rgb()`` or ``oklch()``; else None.

    A profile's colour after it, as in ``#00f icc-color(...)``, is left out.
    """
    if len(text) > _LONGEST:
        return None
    wanted = text.lower().partition(" icc-color")[0].strip()
    wanted = _NAMED.get(wanted, wanted)
    if _HEX.fullmatch(wanted):
        return hex_rgb(wanted[1:])
    function = _FUNCTION.fullmatch(wanted)
    return _chosen(wanted) if function is None else _called(function[1], function[2])


def alpha_of(text: str) -> float:
    """Return the opacity of a CSS colour, 0..1; 1 if it has no alpha or is not a colour."""
    if len(text) > _LONGEST:
        return 1.0
    wanted = text.strip().lower()
    if _HEX.fullmatch(wanted) and len(wanted) in (5, 9):
        digits = wanted[-1] * 2 if len(wanted) == 5 else wanted[-2:]
        return int(digits, 16) / 255.0
    function = _FUNCTION.fullmatch(wanted)
    numbers = [] if function is None else _NUMBER.findall(_without_space(function[2]))
    return _share(numbers[3], 1.0) if len(numbers) > 3 else 1.0


def hex_rgb(digits: str) -> Rgb:
    """Return the colour of three or six hexadecimal digits; ignore a fourth, or a seventh and eighth (alpha)."""
    wide = digits if len(digits) >= 6 else "".join(2 * digit for digit in digits)
    red, green, blue = (int(wide[i : i + 2], 16) / 255.0 for i in (0, 2, 4))
    return (red, green, blue)


def _chosen(text: str) -> Rgb | None:
    """Return the colour of ``light-dark()``, on a light ground, or of ``color-mix()``."""
    name, bracket, inner = text.partition("(")
    parts = [part.strip() for part in _COMMA.split(inner[:-1])]
    if not bracket or not inner.endswith(")"):
        return None
    if name == "light-dark" and len(parts) == 2:
        return css_rgb(parts[0])
    return _mixed(parts[1:]) if name == "color-mix" and len(parts) == 3 else None


def _mixed(parts: list[str]) -> Rgb | None:
    """Return the mixture of two colours, each with its percentage or without, in sRGB: hues differ by too little."""
    shares = [None if (found := _PERCENT.search(part)) is None else float(found[1]) / 100.0 for part in parts]
    one, other = shares
    if one is None:
        one = 0.5 if other is None else 1.0 - other
    weights = [max(one, 0.0), max(1.0 - one if other is None else other, 0.0)]
    colours = [_PERCENT.sub("", part).strip() for part in parts]
    weights = [0.0 if text == "transparent" else by * alpha_of(text) for text, by in zip(colours, weights, strict=True)]
    known = [(css_rgb(text), by) for text, by in zip(colours, weights, strict=True) if by > 0.0]
    mixed = [0.0, 0.0, 0.0]
    for rgb, by in known:
        if rgb is None:
            return None
        mixed = [so_far + by / sum(weights) * value for so_far, value in zip(mixed, rgb, strict=True)]
    red, green, blue = mixed
    return (red, green, blue) if known else None


def _called(name: str, text: str) -> Rgb | None:
    space = text.split()[0] if name == "color" and text.split() else "srgb"
    numbers = _NUMBER.findall(_without_space(text))
    if space not in _SPACES or len(numbers) < 3:
        return None
    if name in _LABS:
        return _of_lab(name, numbers)
    if name == "color" and (convert := _SPACES[space]) is not None:
        x, y, z = (_value(number, 1.0) for number in numbers[:3])
        return convert(x, y, z)
    if name in ("rgb", "color"):
        red, green, blue = (_share(number, 255.0 if name == "rgb" else 1.0) for number in numbers[:3])
        return (red, green, blue)
    hue = _hue_deg(numbers[0]) / 360.0 % 1.0
    second, third = (_share((number, "%"), 1.0) for number, _ in numbers[1:3])
    if name == "hsl":
        return colorsys.hls_to_rgb(hue, third, second)
    white, black = (second, third) if second + third <= 1.0 else (second / (second + third), third / (second + third))
    red, green, blue = (white + pure * (1.0 - white - black) for pure in colorsys.hsv_to_rgb(hue, 1.0, 1.0))
    return (red, green, blue)


def _of_lab(name: str, numbers: list[_Number]) -> Rgb:
    convert, white, most, chroma = _LABS[name]
    lightness = min(max(_value(numbers[0], white), 0.0), white)
    if chroma:
        a, b = from_polar(max(_value(numbers[1], chroma), 0.0), _hue_deg(numbers[2]))
    else:
        a, b = (_value(number, most) for number in numbers[1:3])
    return convert(lightness, a, b)


def _without_space(text: str) -> str:
    """Return the numbers of a function without the name of a colour space before them."""
    first, gap, rest = text.strip().partition(" ")
    return rest if gap and first in _SPACES else text


def _hue_deg(number: _Number) -> float:
    return _value(number, 360.0) * _UNITS_DEG.get(number[1], 1.0)


def _value(number: _Number, whole: float) -> float:
    """Return a number, or a percentage of a whole."""
    value = 0.0 if number[0] == "none" else min(max(float(number[0]), -_LARGEST), _LARGEST)
    return value / 100.0 * whole if number[1] == "%" else value


def _share(number: _Number, whole: float) -> float:
    """Return a number or a percentage as a share of a whole, 0..1."""
    return min(max(_value(number, whole) / whole, 0.0), 1.0)
