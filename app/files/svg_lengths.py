"""Reads lengths in SVG, and the length of an SVG drawing's unit."""

import math
import re
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from app.files.import_errors import broken
from app.files.markup import Element
from planner.geometry.pose import FloatArray

INCH_M = 0.0254
PX_PER_INCH = 96.0
"""Pixels per inch, as CSS defines them. SVG uses the same px as soon as the drawing states its physical size."""

_PX_M = INCH_M / PX_PER_INCH

_IN_M = {"mm": 1e-3, "cm": 1e-2, "in": INCH_M, "pt": INCH_M / 72.0, "pc": INCH_M / 6.0, "q": 0.25e-3}
"""Lengths of the physical units of CSS (m)."""

Sides: TypeAlias = tuple[float, float]
"""Width and height of the viewport that percentages are of, in user units."""

_DEFAULT_SIDES: Sides = (300.0, 150.0)
"""Width and height of a sheet that says nothing of its size, as CSS has it (px)."""

_UPRIGHT = frozenset({"y", "y1", "y2", "cy", "ry", "height"})
"""The lengths whose percentages are of the height."""

_SIDES = ("width", "height")

_LONGEST = 100
"""Longest text that is parsed as a length (characters)."""

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*([a-z]*|%)\s*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class ViewBox:
    """The visible part of the drawing, in its own units."""

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """The sheet on which a drawing lies.

    Attributes:
        unit_m: the length of its unit (m); None if the file does not say.
        stretch: factors on the unit along x and y if the sheet is not drawn to one scale; usually 1.
        view_box: the visible part; the whole sheet if the file does not say.
    """

    unit_m: float | None
    stretch: tuple[float, float]
    view_box: ViewBox


def sheet_of(root: Element) -> Sheet:
    """Return the sheet that the root element describes by width, height and viewBox.

    Raises:
        ImportedFileError: the viewBox is invalid.
    """
    box = _view_box(root)
    width_m, height_m = (_physical_m(root.attributes.get(name, "")) for name in ("width", "height"))
    if box is None:
        width, height = (_plain(root.attributes.get(name, "")) for name in _SIDES)
        whole = ViewBox(0.0, 0.0, width or _DEFAULT_SIDES[0], height or _DEFAULT_SIDES[1])
        return Sheet(None if width_m is None and height_m is None else _PX_M, (1.0, 1.0), whole)
    scales = [
        size_m / units
        for size_m, units in ((width_m, box.width), (height_m, box.height))
        if size_m is not None and size_m > 0.0
    ]
    if not scales:
        return Sheet(None, (1.0, 1.0), box)
    fitting = root.attributes.get("preserveAspectRatio", "")
    if len(scales) == 2 and fitting.strip().startswith("none"):
        return Sheet(scales[0], (1.0, scales[1] / scales[0]), box)
    return Sheet(max(scales) if "slice" in fitting else min(scales), (1.0, 1.0), box)


def user_units(element: Element, name: str, sides: Sides, default: float = 0.0) -> float:
    """Return a length attribute in user units; convert physical lengths as px, percentages by the viewport's sides.

    Raises:
        ImportedFileError: it is not a length.
    """
    text = element.attributes.get(name)
    if text is None or text.strip() == "auto":
        return default
    found = _length(text)
    unit = found[2].lower() if found else ""
    if found is None or unit not in ("", "px", "%", *_IN_M):
        raise broken(f"line {element.line}: {name}={text[:40]!r} is no length that can be read")
    if unit == "%":
        return finite(float(found[1]) / 100.0 * _whole(name, sides), element)
    return finite(float(found[1]) * (_IN_M[unit] / _PX_M if unit in _IN_M else 1.0), element)


def _whole(name: str, sides: Sides) -> float:
    """Return the length that percentages of an attribute are of."""
    if name == "r":
        return math.hypot(*sides) / math.sqrt(2.0)
    return sides[1] if name in _UPRIGHT else sides[0]


def finite(value: float, element: Element) -> float:
    """Return the value; raise `ImportedFileError` if it is not finite."""
    if not math.isfinite(value):
        raise broken(f"line {element.line}: a number of <{element.tag[:40]}> is too large")
    return value


def numbers_in(text: str, element: Element) -> list[float]:
    """Return the numbers in a list, with any separators; raise `ImportedFileError` for anything else in it."""
    if _NUMBER.sub(" ", text).replace(",", " ").strip():
        raise broken(f"line {element.line}: {text[:40]!r} is no list of numbers")
    return [finite(float(number), element) for number in _NUMBER.findall(text)]


def viewport(element: Element, sides: Sides) -> tuple[FloatArray, Sides]:
    """Return the transform that a nested `svg` or `symbol` applies to its content, shape (3, 3), and its own sides."""
    x, y = (user_units(element, name, sides) for name in ("x", "y"))
    box = _view_box(element)
    width, height = (user_units(element, name, sides, side) for name, side in zip(_SIDES, sides, strict=True))
    matrix = np.array([[1.0, 0.0, x], [0.0, 1.0, y], [0.0, 0.0, 1.0]])
    if box is None or min(width, height) <= 0.0:
        return matrix, (width, height)
    scale = min(width / box.width, height / box.height)
    dx, dy = (width - scale * box.width) / 2, (height - scale * box.height) / 2
    fitted = np.array([[scale, 0.0, dx - scale * box.x], [0.0, scale, dy - scale * box.y], [0.0, 0.0, 1.0]])
    return np.asarray(matrix @ fitted), (box.width, box.height)


def _plain(text: str) -> float | None:
    """Return a length in user units; None for a percentage, for zero and for anything that is not a length."""
    found = _length(text)
    unit = found[2].lower() if found else "%"
    if found is None or unit not in ("", "px", *_IN_M):
        return None
    value = float(found[1]) * (_IN_M[unit] / _PX_M if unit in _IN_M else 1.0)
    return value if 0.0 < value < math.inf else None


def _physical_m(text: str) -> float | None:
    """Return a length with a physical unit (m); None for px, percentages and anything that is not a length."""
    found = _length(text)
    return float(found[1]) * _IN_M[found[2].lower()] if found and found[2].lower() in _IN_M else None


def _length(text: str) -> re.Match[str] | None:
    return _LENGTH.fullmatch(text) if len(text) <= _LONGEST else None


def _view_box(element: Element) -> ViewBox | None:
    text = element.attributes.get("viewBox")
    if text is None:
        return None
    numbers = numbers_in(text, element)
    if len(numbers) != 4 or min(numbers[2:]) <= 0.0:
        raise broken(f"line {element.line}: viewBox={text[:60]!r} is not four numbers, the last two positive")
    return ViewBox(*numbers)
