"""Lists the visible shapes of an SVG drawing, with groups, transforms and references resolved."""

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from app.files.import_errors import broken
from app.files.markup import Element
from app.files.svg_lengths import Sides, numbers_in, user_units, viewport
from app.files.svg_paint import is_black, is_hidden, is_invisible
from app.files.svg_style import StyleSheet
from planner.geometry.pose import FloatArray

SHAPES_MAX, VISITS_MAX, CHARACTERS_MAX = 5_000, 20_000, 8_000_000
"""Largest numbers of shapes, of elements visited and of their attributes' characters; references can multiply them."""

_GROUPS = frozenset({"svg", "g", "a", "switch"})

_REFERENCES_DEEP = 20
"""Largest nesting depth of `use` references."""

_URL = re.compile(r"url\(\s*['\"]?#([^'\")]+)['\"]?\s*\)")

_DRAWN_HERE = frozenset({"mask", "g", "path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "title"})
"""Elements of a mask that are looked at; a mask with others, such as pictures, may show anything."""

_QUARTERS = ((1, 1), (-1, 1), (-1, -1), (1, -1))


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """A shape as drawn.

    Attributes:
        element: the element that draws it.
        data: its outline as path data.
        matrix: the transform from its coordinates to the drawing's, shape (3, 3).
        style: its style properties.
        clips: the areas to which it is clipped, each as the shapes that make it up.
    """

    element: Element
    data: str
    matrix: FloatArray
    style: Mapping[str, str]
    clips: tuple[tuple["Shape", ...], ...] = ()


def shapes_of(root: Element, sides: Sides) -> Iterator[Shape]:
    """Yield all shapes that are not hidden, in drawing order.

    Args:
        root: the root of the drawing.
        sides: width and height of its sheet, in its own units.

    Raises:
        ImportedFileError: a transform, a length or a reference is invalid, or there are too many shapes.
    """
    for count, shape in enumerate(_Drawn(root).shapes(sides)):
        if count >= SHAPES_MAX:
            raise broken(f"there are more than {SHAPES_MAX} shapes in it")
        yield shape


class _Drawn:
    def __init__(self, root: Element) -> None:
        self._root = root
        self._sheet = StyleSheet.of(root)
        self._by_id = {element.attributes.get("id"): element for element in root.walk()}
        self._visited = self._read = 0

    def shapes(self, sides: Sides) -> Iterator[Shape]:
        style = self._sheet.style(self._root, {})
        if is_hidden(style):
            return
        for child in self._root.children:
            yield from self._within(child, _Around(np.eye(3), style, sides))

    def _within(self, element: Element, around: "_Around") -> Iterator[Shape]:
        """Yield the shapes that an element draws within what is around it."""
        self._visited += 1
        self._read += sum(len(value) for value in element.attributes.values())
        if self._visited > VISITS_MAX or self._read > CHARACTERS_MAX:
            raise broken(f"line {element.line}: its references draw too much, more than {VISITS_MAX} elements")
        style = self._sheet.style(element, around.style)
        if is_hidden(style) or self._is_masked(style.get("mask", ""), around):
            return
        here = replace(around, matrix=around.matrix @ transform_of(element), style=style)
        here = self._clipped(here, style.get("clip-path", ""))
        if element.tag in _GROUPS:
            inner = here.in_viewport(element) if element.tag == "svg" else here
            for child in element.children:
                yield from self._within(child, inner)
        elif element.tag == "use":
            yield from self._referred(element, here)
        elif not is_invisible(style):
            data = path_data(element, here.sides)
            if data:
                yield Shape(element, data, here.matrix, style, here.clips)

    def _clipped(self, here: "_Around", clip_path: str) -> "_Around":
        """Return what is around an element's content, clipped; a clip that is relative to a box is not read."""
        clip = self._named(clip_path, "clipPath")
        if clip is None or clip.attributes.get("clipPathUnits") == "objectBoundingBox":
            return here
        shapes = self._content(clip, here, transform_of(clip))
        return replace(here, clips=(*here.clips, shapes)) if shapes else here

    def _is_masked(self, mask: str, around: "_Around") -> bool:
        """Return whether an element has a mask in which all is black, so that nothing of the element is seen."""
        found = self._named(mask, "mask")
        if found is None or found.attributes.get("mask-type") == "alpha":
            return False
        if any(one.tag not in _DRAWN_HERE for one in found.walk()):
            return False
        return all(is_black(shape.style) for shape in self._content(found, around, np.eye(3)))

    def _named(self, reference: str, tag: str) -> Element | None:
        """Return the element that a `url(#...)` names, if it has a tag; else None."""
        found = _URL.search(reference)
        element = None if found is None else self._by_id.get(found[1])
        return element if element is not None and element.tag == tag else None

    def _content(self, element: Element, around: "_Around", matrix: FloatArray) -> tuple[Shape, ...]:
        """Return the shapes in a clip or a mask, moved by a matrix."""
        if around.deep >= _REFERENCES_DEEP:
            raise broken(f"line {element.line}: references go more than {_REFERENCES_DEEP} deep")
        inner = _Around(around.matrix @ matrix, self._sheet.style_in_place(element), around.sides, around.deep + 1)
        return tuple(shape for child in element.children for shape in self._within(child, inner))

    def _referred(self, use: Element, here: "_Around") -> Iterator[Shape]:
        address = use.attributes.get("href", "")
        target = self._by_id.get(address[1:]) if address.startswith("#") else None
        if target is None:
            raise broken(f"line {use.line}: it refers to {address[:60]!r}, which is not in this file")
        if here.deep >= _REFERENCES_DEEP:
            raise broken(f"line {use.line}: references go more than {_REFERENCES_DEEP} deep")
        x, y = (user_units(use, name, here.sides) for name in ("x", "y"))
        placed = replace(here, matrix=here.matrix @ _translation(x, y), deep=here.deep + 1)
        if target.tag == "symbol":
            inner = placed.in_viewport(target)
            for child in target.children:
                yield from self._within(child, inner)
        else:
            yield from self._within(target, placed)


@dataclass(frozen=True, slots=True, eq=False)
class _Around:
    """What is around an element.

    Attributes:
        matrix: the transform from its coordinates to the drawing's, shape (3, 3).
        style: the style around it.
        sides: width and height of the viewport around it.
        deep: the number of references that led to it.
        clips: the areas to which it is clipped.
    """

    matrix: FloatArray
    style: Mapping[str, str]
    sides: Sides
    deep: int = 0
    clips: tuple[tuple[Shape, ...], ...] = ()

    def in_viewport(self, element: Element) -> "_Around":
        """Return what is around the content of a nested `svg` or a `symbol`."""
        matrix, sides = viewport(element, self.sides)
        return replace(self, matrix=self.matrix @ matrix, sides=sides)


def path_data(element: Element, sides: Sides) -> str:
    """Return the outline of a shape as path data; empty for an element that draws none."""
    match element.tag:
        case "path":
            return element.attributes.get("d", "")
        case "line":
            x1, y1, x2, y2 = (user_units(element, name, sides) for name in ("x1", "y1", "x2", "y2"))
            return f"M {x1!r} {y1!r} L {x2!r} {y2!r}"
        case "polyline" | "polygon":
            return _polygon(element)
        case "rect":
            return _rectangle(element, sides)
        case "circle" | "ellipse":
            radius = user_units(element, "r", sides)
            rx, ry = (radius, radius) if element.tag == "circle" else _radii(element, sides)
            cx, cy = user_units(element, "cx", sides), user_units(element, "cy", sides)
            return _rounded(cx, cy, 0.0, 0.0, rx, ry) if min(rx, ry) > 0.0 else ""
    return ""


def _polygon(element: Element) -> str:
    numbers = numbers_in(element.attributes.get("points", ""), element)
    points = [f"{x!r} {y!r}" for x, y in zip(numbers[::2], numbers[1::2], strict=False)]
    closing = " Z" if element.tag == "polygon" else ""
    return f"M {' L '.join(points)}{closing}" if len(points) > 1 else ""


def _rectangle(element: Element, sides: Sides) -> str:
    x, y, width, height = (user_units(element, name, sides) for name in ("x", "y", "width", "height"))
    if min(width, height) <= 0.0:
        return ""
    rx, ry = _radii(element, sides)
    rx, ry = min(rx, width / 2), min(ry, height / 2)
    if min(rx, ry) <= 0.0:
        return f"M {x!r} {y!r} H {x + width!r} V {y + height!r} H {x!r} Z"
    return _rounded(x + width / 2, y + height / 2, width / 2 - rx, height / 2 - ry, rx, ry)


def _radii(element: Element, sides: Sides) -> tuple[float, float]:
    """Return the radii along x and y; a missing radius equals the other."""
    rx, ry = user_units(element, "rx", sides, math.nan), user_units(element, "ry", sides, math.nan)
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
