"""Lengths in SVG, and how long one of its units is."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.files.import_errors import broken
from app.files.markup import Element
from planner.geometry.pose import FloatArray

INCH_M = 0.0254
PX_PER_INCH = 96.0
"""CSS has 96 px to the inch, and that is what a px in SVG means when anything says how large the drawing is."""

_PX_M = INCH_M / PX_PER_INCH
_IN_M = {
    "mm": 1e-3,
    "cm": 1e-2,
    "in": INCH_M,
    "pt": INCH_M / 72.0,
    "pc": INCH_M / 6.0,
    "q": 0.25e-3,
}
_LONGEST = 100
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*([a-z]*|%)\s*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class ViewBox:
    """The part of the drawing that is seen, in its own units."""

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """The sheet on which a drawing is.

    Attributes:
        unit_m: how long one of its units is (m); None: it does not say.
        stretch: how much longer a unit is along x and y where the sheet is not drawn to one scale; mostly 1.
        view_box: the part that is seen; None: not said.
    """

    unit_m: float | None
    stretch: tuple[float, float]
    view_box: ViewBox | None


def sheet_of(root: Element) -> Sheet:
    """The sheet that the root element describes by width, height and viewBox.

    Raises:
        ImportedFileError: its viewBox is none.
    """
    box = _view_box(root)
    width_m, height_m = (_physical_m(root.attributes.get(name, "")) for name in ("width", "height"))
    if box is None:
        return Sheet(None if width_m is None and height_m is None else _PX_M, (1.0, 1.0), None)
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


def user_units(element: Element, name: str, default: float = 0.0) -> float:
    """An attribute that is a length, in user units; physical lengths are so many px.

    Raises:
        ImportedFileError: it is no length, or a percentage.
    """
    text = element.attributes.get(name)
    if text is None or text.strip() == "auto":
        return default
    found = _length(text)
    unit = found[2].lower() if found else ""
    if found is None or unit not in ("", "px", *_IN_M):
        raise broken(f"line {element.line}: {name}={text[:40]!r} is no length that can be read")
    return finite(float(found[1]) * (_IN_M[unit] / _PX_M if unit in _IN_M else 1.0), element)


def finite(value: float, element: Element) -> float:
    """The value; raises `ImportedFileError` if it is beyond all numbers."""
    if not math.isfinite(value):
        raise broken(f"line {element.line}: a number of <{element.tag[:40]}> is too large")
    return value


def numbers_in(text: str, element: Element) -> list[float]:
    """All numbers in a list, however they are separated; raises `ImportedFileError` where there is anything else."""
    if _NUMBER.sub(" ", text).replace(",", " ").strip():
        raise broken(f"line {element.line}: {text[:40]!r} is no list of numbers")
    return [finite(float(number), element) for number in _NUMBER.findall(text)]


def viewport(element: Element) -> FloatArray:
    """What a nested element `svg` or a `symbol` does to the coordinates within it, shape (3, 3)."""
    place: Mapping[str, float] = {name: user_units(element, name) for name in ("x", "y")}
    box = _view_box(element)
    width, height = (_plain(element, name) for name in ("width", "height"))
    matrix = np.array([[1.0, 0.0, place["x"]], [0.0, 1.0, place["y"]], [0.0, 0.0, 1.0]])
    if box is None or width is None or height is None:
        return matrix
    scale = min(width / box.width, height / box.height)
    dx, dy = (width - scale * box.width) / 2, (height - scale * box.height) / 2
    fitted = np.array([[scale, 0.0, dx - scale * box.x], [0.0, scale, dy - scale * box.y], [0.0, 0.0, 1.0]])
    return np.asarray(matrix @ fitted)


def _plain(element: Element, name: str) -> float | None:
    text = element.attributes.get(name, "")
    return None if not text or "%" in text else user_units(element, name) or None


def _physical_m(text: str) -> float | None:
    """A length with a physical unit (m); None for px, percentages and what is no length."""
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
