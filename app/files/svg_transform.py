"""Reads the transform of an SVG element."""

import math
import re
from collections.abc import Callable, Mapping

import numpy as np

from app.files.import_errors import broken
from app.files.markup import Element
from app.files.svg_lengths import numbers_in
from planner.geometry.pose import FloatArray

_STEP = re.compile(r"[\s,]*([A-Za-z]+)\s*\(([^()]*)\)")


def transform_of(element: Element) -> FloatArray:
    """Return the matrix of an element's transform attribute, shape (3, 3).

    Raises:
        ImportedFileError: it is not a list of transforms, or its numbers are too large.
    """
    text = element.attributes.get("transform", "")
    matrix = np.eye(3)
    if _STEP.sub("", text).strip(" \t\r\n,"):
        raise _unread(element, text)
    for name, numbers in _STEP.findall(text):
        try:
            a, b, c, d, e, f = _ENTRIES[name](*numbers_in(numbers, element))
        except (KeyError, TypeError):  # no such transform, or not with so many numbers
            raise _unread(element, f"{name}({numbers})") from None
        with np.errstate(all="ignore"):
            matrix = matrix @ np.array([[a, c, e], [b, d, f], [0.0, 0.0, 1.0]])
    if not np.all(np.isfinite(matrix)):
        raise broken(f"line {element.line}: transform={text[:60]!r} is too large")
    return matrix


def _unread(element: Element, text: str) -> Exception:
    return broken(f"line {element.line}: transform={text[:60]!r} is not understood")


_Entries = tuple[float, float, float, float, float, float]
"""The six numbers of a matrix, column by column, as `matrix(...)` takes them."""


def _matrix(a: float, b: float, c: float, d: float, e: float, f: float) -> _Entries:
    return a, b, c, d, e, f


def _translate(x: float, y: float = 0.0) -> _Entries:
    return 1.0, 0.0, 0.0, 1.0, x, y


def _scale(x: float, y: float | None = None) -> _Entries:
    return x, 0.0, 0.0, x if y is None else y, 0.0, 0.0


def _rotate(angle_deg: float, x: float = 0.0, y: float = 0.0) -> _Entries:
    cos, sin = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return cos, sin, -sin, cos, x - cos * x + sin * y, y - sin * x - cos * y


def _skew_x(angle_deg: float) -> _Entries:
    return 1.0, 0.0, math.tan(math.radians(angle_deg)), 1.0, 0.0, 0.0


def _skew_y(angle_deg: float) -> _Entries:
    return 1.0, math.tan(math.radians(angle_deg)), 0.0, 1.0, 0.0, 0.0


_ENTRIES: Mapping[str, Callable[..., _Entries]] = {
    "matrix": _matrix,
    "translate": _translate,
    "scale": _scale,
    "rotate": _rotate,
    "skewX": _skew_x,
    "skewY": _skew_y,
}
