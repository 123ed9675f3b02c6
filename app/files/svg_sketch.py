"""Reads SVG: closed paths are candidates for the outline; open paths in blue or red are folds."""

import json
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
from svg.path import Arc, Close, Line, Move, Path, parse_path

from app.files.curve import Curve, DrawnCurve, Segment, SvgCurve
from app.files.fold_colour import kind_of
from app.files.import_errors import broken
from app.files.markup import Element, read_markup
from app.files.piece_labels import names_fold, piece_in, says_on_fold, size_in
from app.files.sketch import DrawnLine, FoldLine, MirrorLine, Role, Sketch
from app.files.svg_lengths import Sheet, Sides, sheet_of
from app.files.svg_page import box_of, is_frame, is_frame_around, is_page, may_be_garment
from app.files.svg_paint import WHITE_MIN, colour_of, is_filled, is_stroked, is_white
from app.files.svg_shapes import Shape, shapes_of
from planner.errors import FieldError
from planner.geometry.arrangement import clipped, is_clipped_away, signed_area
from planner.geometry.pose import FloatArray
from planner.strict_model import LARGEST_M

KEPT = "data-pleat"
"""The attribute in which an exported drawing keeps the data that its lines do not show."""

GRIP_RADIUS = "data-pleat-grip-radius-m"
"""The attribute in which an exported fold line keeps its grip radius (m)."""

SEGMENTS_MAX = 20_000
"""Largest number of path segments in a drawing."""

_BAD = (ArithmeticError, AssertionError, AttributeError, LookupError, TypeError, ValueError)
"""Exceptions that svg.path raises on invalid path data."""

_FARTHEST = 1e12
"""Largest coordinate of a curve, in units of the drawing."""

_COARSE = 1e-3
"""Precision with which areas are compared, as a share of the sheet."""

_NAMED = frozenset({"g", "path", "polygon", "polyline", "rect", "use", "svg"})

_FOREIGN = re.compile(r"[^MmZzLlHhVvCcSsQqTtAaEe0-9+\-.,\s]")
"""A character that path data does not have."""


def read_svg(data: bytes) -> Sketch:
    """Return the drawing in an SVG file.

    Raises:
        ImportedFileError: the file is not SVG, or part of it cannot be read; the message gives the line.
    """
    root = read_markup(data)
    if root.tag != "svg":
        raise broken(f"it begins with <{root.tag[:40]}>, not with <svg>")
    reading = _Reading(root, sheet_of(root))
    for shape in shapes_of(root, reading.sides):
        reading.add(shape)
    return reading.sketch()


@dataclass(frozen=True, slots=True, eq=False)
class _Area:
    """A closed line.

    Attributes:
        line: the line, with its size.
        has_edge: whether a line is drawn along its edge, in a colour that shows on paper.
        is_white: whether nothing of it shows on white paper.
        covers_sheet: whether it is a rectangle as large as the sheet, or larger.
        may_be_frame: whether it is a rectangle that nothing is painted in, as far from all edges of the sheet.
        box: its lowest and highest coordinates, shape (2, 2), in units of the drawing.
        size: the area in it.
    """

    line: DrawnLine
    has_edge: bool
    is_white: bool
    covers_sheet: bool
    may_be_frame: bool
    box: FloatArray
    size: float


class _Reading:
    """Reads the shapes of a drawing, one after the other."""

    def __init__(self, root: Element, sheet: Sheet) -> None:
        self._root, self._sheet = root, sheet
        self._kept = _kept(root)
        texts = [(e, e.whole_text()) for e in root.walk() if e.tag in ("text", "textPath")]
        self._texts = [e for e, text in texts if says_on_fold(text)]
        self._fold_words = [e for e, text in texts if names_fold(text)]
        self._on_fold, self._named_fold = _paths_of(self._texts), _paths_of(self._fold_words)
        self._sizes: dict[Element, str | None] = {}
        self._pieces: dict[Element, str | None] = {}
        self._says_on_fold: dict[tuple[Element, bool], bool] = {}
        self._areas: list[_Area] = []
        self._lines: list[DrawnLine] = []
        self._segments, self._has_open = 0, False

    @property
    def sides(self) -> Sides:
        """Width and height of the sheet in its own units."""
        return self._sheet.view_box.width, self._sheet.view_box.height

    def add(self, shape: Shape) -> None:
        """Take the lines of a shape that can be seen."""
        has_stroke, has_area = is_stroked(shape.style), is_filled(shape.style)
        size = self._size_of(shape.element)
        clips = [self._rings(clip) for clip in shape.clips]
        for curve, is_closed in self._curves(shape):
            if not (has_stroke or has_area) or (not is_closed and is_clipped_away(self._coarse(curve), clips)):
                continue
            if is_closed:
                for part in self._left_of(curve, clips):
                    self._areas.append(self._area(shape, part, size, has_stroke=has_stroke, has_area=has_area))
            else:
                self._add_open(shape, curve, size, has_stroke=has_stroke)

    def _add_open(self, shape: Shape, curve: SvgCurve, size: str | None, *, has_stroke: bool) -> None:
        kind = kind_of(colour_of(shape.style.get("stroke", ""), shape.style)) if has_stroke else None
        if self._kept is None and self._is_on_fold(shape, is_coloured=kind is not None):
            self._lines.append(DrawnLine("mirror", MirrorLine(curve, is_beside=True), size))
            return
        if kind is not None:
            fold = FoldLine(kind, curve, _name(shape.element), _grip_radius(shape.element))
            self._lines.append(DrawnLine("fold", fold, size))
            return
        self._has_open = True
        self._lines.append(DrawnLine("outline", curve, size))
        if not has_stroke and len(curve.segments) > 1:  # its area is painted as if it were closed
            closing = Line(curve.segments[-1].end, curve.segments[0].start)
            self._lines.append(DrawnLine("white", SvgCurve((*curve.segments, closing), curve.matrix), size))

    def _area(self, shape: Shape, curve: Curve, size: str | None, *, has_stroke: bool, has_area: bool) -> _Area:
        edge = colour_of(shape.style.get("stroke", ""), shape.style) if has_stroke else None
        has_edge = has_stroke and (edge is None or min(edge) < WHITE_MIN)
        is_area_white = not has_area or is_white(shape.style)
        points, sheet = self._coarse(curve), self._corners()
        box = box_of(points)
        with np.errstate(all="ignore"):  # coordinates may be as large as numbers get
            area = abs(float(signed_area(points[:-1])))
            covers = is_page(box, area, sheet)
            surrounds = has_edge and is_area_white and is_frame(box, area, sheet)
        line = DrawnLine("outline", curve, size)
        return _Area(line, has_edge, not has_edge and is_area_white, covers, surrounds, box, area)

    def sketch(self) -> Sketch:
        """Return the drawing."""
        why = "its width and height have no unit such as mm or in"
        sketch = Sketch(
            (),
            (),
            self._sheet.unit_m,
            why,
            self._root.title,
            self._kept,
            says_fold=self._kept is None and self._says_fold(),
        )
        return sketch.with_lines([*self._closed(), *self._lines])

    def _closed(self) -> Iterator[DrawnLine]:
        """Yield the closed lines, each with its role.

        A rectangle as large as the sheet is the page: with an edge where a garment may be drawn on it; without one
        unless it is dark and nothing else has an edge or is white upon it. On a dark page what is white can be seen.
        A frame is an outline only if nothing else is.
        """
        is_page_dark = False
        frame = self._frame()
        drawn = [one for one in self._areas if one is not frame]
        others = [one for one in drawn if one.has_edge or not one.covers_sheet]
        inner = (one.size for one in others if not (one.covers_sheet or one.is_white))
        is_drawn_on = self._kept is None and (
            self._has_open or may_be_garment(max(inner, default=0.0), self._corners())
        )
        for one in drawn:
            is_paper = one.covers_sheet and (is_drawn_on or not one.has_edge)
            if is_paper and not (one.is_white or one.has_edge):
                is_page_dark = True
                is_paper = any(other.has_edge or other.is_white for other in others)
            role: Role = "page" if is_paper else "white" if one.is_white and not is_page_dark else "outline"
            yield replace(one.line, role=role)
        if frame is not None:
            yield replace(frame.line, role="white")

    def _frame(self) -> _Area | None:
        """Return the rectangle a little inside of the sheet that is only a frame around a garment; None if none is."""
        frame = max(
            (one for one in self._areas if one.may_be_frame and not one.covers_sheet),
            key=lambda one: one.size,
            default=None,
        )
        if frame is None or self._kept is not None:
            return None
        areas = [
            (one.box, one.size) for one in self._areas if one is not frame and not (one.covers_sheet or one.is_white)
        ]
        curves = [one.line for one in self._lines if one.role == "outline"]
        lines = [self._coarse(cast(Curve, curve)) for curve in curves]
        folds = [one.line.curve.extent[[0, -1]] for one in self._lines if isinstance(one.line, FoldLine)]
        gap = _COARSE * max(self.sides)
        return frame if is_frame_around(frame.box, areas, lines, folds, gap) else None

    def _says_fold(self) -> bool:
        """Return whether a text says that a piece is cut on the fold, or a closed shape or a group is named so."""
        named = (label for e in self._root.walk() if e.tag in _NAMED for label in labels_of(e))
        has_folds = any(one.role == "fold" for one in self._lines)
        return bool(self._texts or (self._fold_words and not has_folds)) or any(map(says_on_fold, named))

    def _is_on_fold(self, shape: Shape, *, is_coloured: bool) -> bool:
        """Return whether an open line says that it is a fold line: by its names, its markers, or a text on it.

        The word fold alone does not say so of a line in the colour of a fold.
        """
        element = shape.element
        if (element, is_coloured) not in self._says_on_fold:
            said = [element.attributes.get(name, "") for name in ("class", "marker-start", "marker-end")]
            said += [shape.style.get(name, "") for name in ("marker-start", "marker-end")]
            names, own = labels_of(element), element.attributes.get("id")
            is_named = any(map(says_on_fold, (*names, *said))) or own in self._on_fold
            is_alone = not is_coloured and (any(map(names_fold, names)) or own in self._named_fold)
            self._says_on_fold[element, is_coloured] = is_named or is_alone
        return self._says_on_fold[element, is_coloured]

    def _size_of(self, element: Element) -> str | None:
        """Return the size that an element or a group around it is labelled with."""
        if element not in self._sizes:
            said = next((size for label in labels_of(element) if (size := size_in(label)) is not None), None)
            outer = element.parent
            self._sizes[element] = said or (None if outer is None else self._size_of(outer))
        return self._sizes[element]

    def _piece_of(self, element: Element) -> str | None:
        """Return the name of the piece that an element, or else a group around it, is labelled with."""
        if element not in self._pieces:
            named = next((name for label in labels_of(element) if (name := piece_in(label)) is not None), None)
            outer = element.parent if element.parent is not self._root else None
            self._pieces[element] = named or (None if outer is None else self._piece_of(outer))
        return self._pieces[element]

    def _curves(self, shape: Shape) -> Iterator[tuple[SvgCurve, bool]]:
        for curve, is_closed in _curves(shape, _upwards(self._sheet)):
            self._segments += len(curve.segments)
            if self._segments > SEGMENTS_MAX:
                raise broken(f"line {shape.element.line}: there are more than {SEGMENTS_MAX} segments in it")
            yield replace(curve, piece=self._piece_of(shape.element)), is_closed

    def _coarse(self, curve: Curve) -> FloatArray:
        """Return points on a curve that are precise to a thousandth of the sheet, in its own units."""
        return curve.flattened(_COARSE * max(self.sides))

    def _rings(self, clip: tuple[Shape, ...]) -> list[FloatArray]:
        rings = [self._coarse(curve) for shape in clip for curve, _ in self._curves(shape)]
        return [ring for ring in rings if len(ring) > 2]

    def _left_of(self, curve: SvgCurve, clips: Sequence[Sequence[FloatArray]]) -> list[Curve]:
        """Return what is left of a closed line within clips."""
        ring = self._coarse(curve)[:-1]
        parts = clipped(ring, clips) if clips and len(ring) > 2 else None
        if parts is None:
            return [curve]
        closed = [np.concatenate([part, part[:1]]) for part in parts]
        return [DrawnCurve.through(points, is_bent=curve.is_bent, piece=curve.piece) for points in closed]

    def _corners(self) -> FloatArray:
        """Return the lowest and the highest coordinates of the sheet, shape (2, 2), in units of the drawing."""
        box = self._sheet.view_box
        corners = np.array([[box.x, box.y, 1.0], [box.x + box.width, box.y + box.height, 1.0]])
        return np.sort((corners @ _upwards(self._sheet).T)[:, :2], axis=0)


def _paths_of(texts: Iterable[Element]) -> set[str]:
    """Return the ids of the lines that texts are written along."""
    return {e.attributes.get("href", "")[1:] for text in texts for e in text.walk()} - {""}


def labels_of(element: Element) -> list[str]:
    """Return the names that an element has: its label, title and id, and classes that name a size."""
    named = [element.attributes.get(name, "") for name in ("label", "id", "data-name", "name")]
    classes = [name for name in element.attributes.get("class", "").split() if "size" in name.lower()]
    return [label for label in (element.title or "", *named, *classes) if label]


def _upwards(sheet: Sheet) -> FloatArray:
    """Return the matrix from the sheet's coordinates, y down, to those of a drawing, y up."""
    sx, sy = sheet.stretch
    return np.diag([sx, -sy, 1.0])


def _curves(shape: Shape, upwards: FloatArray) -> Iterator[tuple[SvgCurve, bool]]:
    """Yield the subpaths of a shape, and whether each is closed."""
    if (foreign := _FOREIGN.search(shape.data)) is not None:
        raise _unread(shape, f"paths have no {foreign[0]!r}")
    try:
        path = parse_path(shape.data)
    except _BAD as error:
        raise _unread(shape, str(error) or "an arc leads nowhere") from None
    for segments in _subpaths(_segments(path)):
        curve = SvgCurve(tuple(segments), upwards @ shape.matrix)
        if not np.all(np.abs(curve.extent) <= _FARTHEST):
            raise _unread(shape, "a number in it is too large")
        yield curve, segments[0].start == segments[-1].end


def _segments(path: Path) -> Iterator[Segment]:
    """Yield the segments of a path that lead somewhere; an arc without a radius is a straight line."""
    for segment in path:
        if isinstance(segment, Move) or (isinstance(segment, Arc | Close) and segment.start == segment.end):
            continue
        if isinstance(segment, Arc) and 0.0 in (segment.radius.real, segment.radius.imag):
            yield Line(segment.start, segment.end)
        else:
            yield cast(Segment, segment)


def _subpaths(segments: Iterable[Segment]) -> Iterator[list[Segment]]:
    """Yield the connected sequences of segments; a sequence also ends where it returns to its start."""
    subpath: list[Segment] = []
    for segment in segments:
        if subpath and (segment.start != subpath[-1].end or subpath[-1].end == subpath[0].start):
            yield subpath
            subpath = []
        subpath.append(segment)
    if subpath:
        yield subpath


def _unread(shape: Shape, why: str) -> FieldError:
    return broken(f"line {shape.element.line}: the data of this <{shape.element.tag}> is not understood: {why[:200]}")


def _name(element: Element) -> str | None:
    return element.title or element.attributes.get("label") or element.attributes.get("id")


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
