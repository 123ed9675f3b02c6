"""Lists the visible shapes of an SVG drawing, with groups, transforms and references resolved."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from svgpathtools.parser import parse_transform

from app.files.import_errors import broken
from app.files.markup import Element
from app.files.svg_lengths import numbers_in, user_units, viewport
from app.files.svg_style import StyleSheet, is_hidden, is_invisible
from planner.geometry.pose import FloatArray

SHAPES_MAX, VISITS_MAX, CHARACTERS_MAX = 5_000, 20_000, 8_000_000
"""Largest numbers of shapes, of elements visited and of their attributes' characters; references can multiply them."""

_GROUPS = frozenset({"svg", "g", "a", "switch"})

_REFERENCES_DEEP = 20
"""Largest nesting depth of `use` references."""

_QUARTERS = ((1, 1), (-1, 1), (-1, -1), (1, -1))


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """A shape as drawn.

    Attributes:
        element: the element that draws it.
        data: its outline as path data.
        matrix: the transform from its coordinates to the drawing's, shape (3, 3).
        style: its style properties.
    """

    element: Element
    data: str
    matrix: FloatArray
    style: Mapping[str, str]


def shapes_of(root: Element) -> Iterator[Shape]:
    """Yield all visible shapes, in drawing order.

    Raises:
        ImportedFileError: a transform, a length or a reference is invalid, or there are too many shapes.
    """
    for count, shape in enumerate(_Drawn(root).shapes()):
        if count >= SHAPES_MAX:
            raise broken(f"there are more than {SHAPES_MAX} shapes in it")
        yield shape


class _Drawn:
    def __init__(self, root: Element) -> None:
        self._root = root
        self._sheet = StyleSheet.of(root)
        self._by_id = {element.attributes.get("id"): element for element in root.walk()}
        self._visited = self._read = 0

    def shapes(self) -> Iterator[Shape]:
        style = self._sheet.style(self._root, {})
        for child in self._root.children:
            yield from self._within(child, np.eye(3), style, 0)

    def _within(self, element: Element, outer: FloatArray, around: Mapping[str, str], deep: int) -> Iterator[Shape]:
        """Yield the shapes that an element draws within a transform and a style, `deep` references down."""
        self._visited += 1
        self._read += sum(len(value) for value in element.attributes.values())
        if self._visited > VISITS_MAX or self._read > CHARACTERS_MAX:
            raise broken(f"line {element.line}: its references draw too much, more than {VISITS_MAX} elements")
        style = self._sheet.style(element, around)
        if is_hidden(style):
            return
        matrix = outer @ _transform(element)
        if element.tag in _GROUPS:
            inner = matrix @ viewport(element) if element.tag == "svg" else matrix
            for child in element.children:
                yield from self._within(child, inner, style, deep)
        elif element.tag == "use":
            yield from self._referred(element, matrix, style, deep)
        elif not is_invisible(style):
            data = path_data(element)
            if data:
                yield Shape(element, data, matrix, style)

    def _referred(self, use: Element, matrix: FloatArray, style: Mapping[str, str], deep: int) -> Iterator[Shape]:
        address = use.attributes.get("href", "")
        target = self._by_id.get(address[1:]) if address.startswith("#") else None
        if target is None:
            raise broken(f"line {use.line}: it refers to {address[:60]!r}, which is not in this file")
        if deep >= _REFERENCES_DEEP:
            raise broken(f"line {use.line}: references go more than {_REFERENCES_DEEP} deep")
        placed = matrix @ _translation(user_units(use, "x"), user_units(use, "y"))
        if target.tag == "symbol":
            inner = placed @ viewport(target)
            for child in target.children:
                yield from self._within(child, inner, style, deep + 1)
        else:
            yield from self._within(target, placed, style, deep + 1)


def path_data(element: Element) -> str:
    """Return the outline of a shape as path data; empty for an element that draws none."""
    match element.tag:
        case "path":
            return element.attributes.get("d", "")
        case "line":
            x1, y1, x2, y2 = (user_units(element, name) for name in ("x1", "y1", "x2", "y2"))
            return f"M {x1!r} {y1!r} L {x2!r} {y2!r}"
        case "polyline" | "polygon":
            return _polygon(element)
        case "rect":
            return _rectangle(element)
        case "circle" | "ellipse":
            radius = user_units(element, "r")
            rx, ry = (radius, radius) if element.tag == "circle" else _radii(element)
            cx, cy = user_units(element, "cx"), user_units(element, "cy")
            return _rounded(cx, cy, 0.0, 0.0, rx, ry) if min(rx, ry) > 0.0 else ""
    return ""


def _polygon(element: Element) -> str:
    numbers = numbers_in(element.attributes.get("points", ""), element)
    points = [f"{x!r} {y!r}" for x, y in zip(numbers[::2], numbers[1::2], strict=False)]
    closing = " Z" if element.tag == "polygon" else ""
    return f"M {' L '.join(points)}{closing}" if len(points) > 1 else ""


def _rectangle(element: Element) -> str:
    x, y, width, height = (user_units(element, name) for name in ("x", "y", "width", "height"))
    if min(width, height) <= 0.0:
        return ""
    rx, ry = _radii(element)
    rx, ry = min(rx, width / 2), min(ry, height / 2)
    if min(rx, ry) <= 0.0:
        return f"M {x!r} {y!r} H {x + width!r} V {y + height!r} H {x!r} Z"
    return _rounded(x + width / 2, y + height / 2, width / 2 - rx, height / 2 - ry, rx, ry)


def _radii(element: Element) -> tuple[float, float]:
    """Return the radii along x and y; a missing radius equals the other."""
    rx, ry = user_units(element, "rx", math.nan), user_units(element, "ry", math.nan)
    rx, ry = (ry if math.isnan(rx) else rx), (rx if math.isnan(ry) else ry)
    return (0.0, 0.0) if math.isnan(rx) else (rx, ry)


def _rounded(cx: float, cy: float, width: float, height: float, rx: float, ry: float) -> str:
    """Return a rectangle of this half size about its centre, grown by an ellipse; at size zero, the ellipse."""
    parts = []
    for sx, sy in _QUARTERS:
        side = (cx + sx * (width + rx), cy + sy * height)
        end = (cx + sx * width, cy + sy * (height + ry))
        start, stop = (side, end) if sx * sy > 0 else (end, side)
        parts.append(f"{start[0]!r} {start[1]!r} A {rx!r} {ry!r} 0 0 1 {stop[0]!r} {stop[1]!r}")
    return f"M {' L '.join(parts)} Z"


def _translation(x: float, y: float) -> FloatArray:
    return np.array([[1.0, 0.0, x], [0.0, 1.0, y], [0.0, 0.0, 1.0]])


def _transform(element: Element) -> FloatArray:
    text = element.attributes.get("transform", "")
    try:
        with np.errstate(all="raise"):
            matrix = np.asarray(parse_transform(text, strict=True))
    except (ValueError, ArithmeticError) as error:
        raise broken(f"line {element.line}: transform={text[:60]!r} is not understood: {error}") from None
    if not np.all(np.isfinite(matrix)):
        raise broken(f"line {element.line}: transform={text[:60]!r} is too large")
    return matrix
