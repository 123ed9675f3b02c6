"""Reads SVG: closed paths are candidates for the outline; open paths in blue or red are folds."""

import json
import re
from collections.abc import Iterator
from typing import Any, TypeAlias

import numpy as np
from svgpathtools import Arc, CubicBezier, Line, QuadraticBezier, parse_path

from app.files.curve import SvgCurve
from app.files.fold_colour import css_rgb, kind_of
from app.files.import_errors import broken
from app.files.markup import Element, read_markup
from app.files.sketch import FoldLine, Sketch
from app.files.svg_lengths import Sheet, sheet_of
from app.files.svg_shapes import Shape, shapes_of
from planner.errors import FieldError
from planner.geometry.pose import FloatArray
from planner.strict_model import LARGEST_M

KEPT = "data-pleat"
"""The attribute in which an exported drawing keeps the data that its lines do not show."""

GRIP_RADIUS = "data-pleat-grip-radius-m"
"""The attribute in which an exported fold line keeps its grip radius (m)."""

SEGMENTS_MAX = 20_000
"""Largest number of path segments in a drawing."""

_BAD = (ArithmeticError, AssertionError, AttributeError, LookupError, TypeError, ValueError, UserWarning)
"""Exceptions that svgpathtools raises on invalid path data; its warning is about arcs without a radius."""

_COMMAND = re.compile(r"[A-Za-z]")
_Segment: TypeAlias = Line | QuadraticBezier | CubicBezier | Arc


def read_svg(data: bytes) -> Sketch:
    """Return the drawing in an SVG file.

    Raises:
        ImportedFileError: the file is not SVG, or part of it cannot be read; the message gives the line.
    """
    root = read_markup(data)
    if root.tag != "svg":
        raise broken(f"it begins with <{root.tag[:40]}>, not with <svg>")
    sheet = sheet_of(root)
    curves: list[SvgCurve] = []
    folds: list[FoldLine] = []
    others = segments = 0
    for shape in shapes_of(root):
        kind = kind_of(css_rgb(shape.style.get("stroke", "")))
        for curve, is_closed in _curves(shape, _upwards(sheet)):
            segments += len(curve.segments)
            if segments > SEGMENTS_MAX:
                raise broken(f"line {shape.element.line}: there are more than {SEGMENTS_MAX} segments in it")
            if kind is None or is_closed:
                curves.append(curve)
                others += not is_closed
            else:
                folds.append(FoldLine(kind, curve, _name(shape.element), _grip_radius(shape.element)))
    why = "its width and height have no unit such as mm or in"
    notes = (_others(others),) if others else ()
    return Sketch(tuple(curves), tuple(folds), sheet.unit_m, why, root.child_text("title"), _kept(root), notes)


def _others(count: int) -> str:
    what, are = ("1 open line is", "it is") if count == 1 else (f"{count} open lines are", "they are")
    return f"{what} neither blue nor red, so {are} no fold."


def _upwards(sheet: Sheet) -> FloatArray:
    """Return the matrix from the sheet's coordinates, y down, to those of a drawing, y up."""
    sx, sy = sheet.stretch
    return np.diag([sx, -sy, 1.0])


def _curves(shape: Shape, upwards: FloatArray) -> Iterator[tuple[SvgCurve, bool]]:
    """Yield the subpaths of a shape, and whether each is closed."""
    if not set(_COMMAND.findall(shape.data)) <= set("MmZzLlHhVvCcSsQqTtAaEe"):
        raise _unread(shape, "there is a command in it that paths do not have")
    try:
        with np.errstate(divide="raise", over="raise", invalid="raise"):
            path = parse_path(shape.data)
    except _BAD as error:
        raise _unread(shape, str(error) or "an arc leads nowhere") from None
    for segments in _subpaths(list(path)):
        curve = SvgCurve(tuple(segments), upwards @ shape.matrix)
        if not np.all(np.isfinite(curve.extent)):
            raise _unread(shape, "a number in it is too large")
        yield curve, segments[0].start == segments[-1].end


def _subpaths(segments: list[_Segment]) -> Iterator[list[_Segment]]:
    """Yield the connected sequences of segments; a sequence also ends where it returns to its start."""
    subpath: list[_Segment] = []
    for segment in segments:
        if segment.start is None or segment.end is None:
            continue
        if subpath and (segment.start != subpath[-1].end or subpath[-1].end == subpath[0].start):
            yield subpath
            subpath = []
        subpath.append(segment)
    if subpath:
        yield subpath


def _unread(shape: Shape, why: str) -> FieldError:
    return broken(f"line {shape.element.line}: the data of this <{shape.element.tag}> is not understood: {why[:200]}")


def _name(element: Element) -> str | None:
    return element.child_text("title") or element.attributes.get("label") or element.attributes.get("id")


def _grip_radius(element: Element) -> float | None:
    try:
        radius_m = float(element.attributes.get(GRIP_RADIUS, ""))
    except ValueError:
        return None
    return radius_m if 0.0 < radius_m <= LARGEST_M else None


def _kept(root: Element) -> dict[str, Any] | None:
    try:
        kept = json.loads(root.attributes.get(KEPT, ""))
    except (ValueError, RecursionError):
        return None
    return kept if isinstance(kept, dict) else None
