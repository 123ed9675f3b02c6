"""Reads pattern specifications of GarmentCode: flat panels that are sewn together, each a piece of its own.

An edge is a straight line, a Bezier curve of degree two or three, or an arc of a circle. Control points are given along
the edge and to its left, as shares of its length (github.com/maria-korosteleva/GarmentCode, pattern/core.py).
"""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from svg.path import Arc, CubicBezier, Line, QuadraticBezier

from app.files.curve import Segment, SvgCurve
from app.files.import_errors import ImportedFileError, broken
from app.files.sketch import DrawnLine, Sketch
from planner.errors import FieldError
from planner.geometry.pose import FloatArray
from planner.strict_model import first_error

PANELS_MAX, EDGES_MAX = 200, 500
"""Largest numbers of panels, and of edges of each."""

_GAP = 0.1
"""Space between panels that are laid beside each other, as a share of the width of the wider one."""

_SAME = 1e-3
"""Difference of the lengths of two edges that are alike, as a share of them."""

_Number = Annotated[float, Field(allow_inf_nan=False, ge=-1e6, le=1e6)]
_Pair: TypeAlias = tuple[_Number, _Number]


class _Read(BaseModel):
    """A JSON object of which only some fields matter here."""

    model_config = ConfigDict(extra="ignore", frozen=True)


class _Bezier(_Read):
    type: Literal["quadratic", "cubic"]
    params: list[_Pair] = Field(min_length=1, max_length=2)


class _Circle(_Read):
    type: Literal["circle"]
    params: tuple[Annotated[float, Field(gt=0.0, le=1e6)], bool, bool]


class _Edge(_Read):
    endpoints: tuple[int, int]
    curvature: _Pair | _Bezier | _Circle | None = None


class _Panel(_Read):
    vertices: list[_Pair] = Field(min_length=3, max_length=EDGES_MAX)
    edges: list[_Edge] = Field(min_length=3, max_length=EDGES_MAX)


class _Side(_Read):
    panel: str
    edge: int


class _Pattern(_Read):
    panels: dict[str, _Panel] = Field(min_length=1, max_length=PANELS_MAX)
    stitches: list[list[_Side]] = []


class _Properties(_Read):
    curvature_coords: Literal["relative", "absolute"] = "relative"
    units_in_meter: Annotated[float, Field(gt=0.0, le=1e6)] = 100.0


class _Specification(_Read):
    pattern: _Pattern
    properties: _Properties = _Properties()


def read_panels(values: Mapping[str, Any]) -> Sketch:
    """Return the drawing of a pattern's panels, side by side; a left and a right half that are sewn become one.

    Raises:
        ImportedFileError: a panel is not valid; the message names the field.
    """
    try:
        asked = _Specification.model_validate(values)
    except ValidationError as error:
        found = first_error(error, FieldError, values)
        raise broken(f"it is a pattern specification, but {found.field}: {found.message}") from None
    panels = asked.pattern.panels
    is_relative = asked.properties.curvature_coords == "relative"
    segments = {name: _segments(name, panel, is_relative=is_relative) for name, panel in panels.items()}
    places = _beside_each_other(segments, _halves(asked.pattern))
    lines = [DrawnLine("outline", SvgCurve(tuple(segments[name]), places[name], name)) for name in panels]
    return Sketch((), (), 1.0 / asked.properties.units_in_meter).with_lines(lines)


def _segments(name: str, panel: _Panel, *, is_relative: bool) -> list[Segment]:
    """Return the edges of a panel as a path's segments."""
    points, made = [complex(*vertex) for vertex in panel.vertices], []
    for number, edge in enumerate(panel.edges):
        first, last = edge.endpoints
        if not (0 <= first < len(points) and 0 <= last < len(points)):
            raise _wrong(name, number, f"there is no vertex {max(edge.endpoints)}")
        if first != panel.edges[number - 1].endpoints[1]:
            raise _wrong(name, number, f"it begins at vertex {first}, where the edge before does not end")
        start, end = points[first], points[last]
        if start == end:
            raise _wrong(name, number, "it has no length")
        made.append(_segment(start, end, edge.curvature, is_relative=is_relative))
    return made


def _wrong(panel: str, edge: int, what: str) -> ImportedFileError:
    return broken(f"it is a pattern specification, but edge {edge} of panel {panel[:40]!r} is not valid: {what}")


def _segment(start: complex, end: complex, bend: _Pair | _Bezier | _Circle | None, *, is_relative: bool) -> Segment:
    if bend is None:
        return Line(start, end)
    if isinstance(bend, _Circle):
        radius, is_large, is_right = bend.params
        least = abs(end - start) / 2.0
        return Arc(start, complex(1.0, 1.0) * max(radius, least), 0.0, is_large, is_right, end)
    points = bend.params if isinstance(bend, _Bezier) else [bend]
    controls = [start + complex(*point) * (end - start) if is_relative else complex(*point) for point in points]
    if len(controls) == 1:
        return QuadraticBezier(start, controls[0], end)
    first, second = controls
    return CubicBezier(start, first, second, end)


def _halves(pattern: _Pattern) -> dict[str, tuple[int, str, int]]:
    """Return for a left half the edge along which it is sewn to its right half, that half, and its edge."""
    found: dict[str, tuple[int, str, int]] = {}
    for stitch in pattern.stitches:
        if len(stitch) != 2 or any(_edge_of(pattern, side) is None for side in stitch):
            continue
        one, other = sorted(stitch, key=lambda side: side.panel)
        is_pair = one.panel != other.panel and one.panel.replace("left", "right") == other.panel
        if is_pair and one.panel not in found:
            found[one.panel] = (one.edge, other.panel, other.edge)
    return found


def _edge_of(pattern: _Pattern, side: _Side) -> _Edge | None:
    """Return the straight edge that a side of a stitch names; None if it names none."""
    edges = pattern.panels[side.panel].edges if side.panel in pattern.panels else []
    edge = edges[side.edge] if 0 <= side.edge < len(edges) else None
    return edge if edge is not None and edge.curvature is None else None


def _beside_each_other(
    segments: Mapping[str, Sequence[Segment]], halves: Mapping[str, tuple[int, str, int]]
) -> dict[str, FloatArray]:
    """Return where each panel lies, as matrices of shape (3, 3): in a row, and halves where they are sewn."""
    places: dict[str, FloatArray] = {}
    right, behind = 0.0, {half for _, half, _ in halves.values()}
    for name in (name for name in segments if name not in behind):
        inner = {name: np.eye(3)}
        if name in halves:
            edge, half, its_edge = halves[name]
            onto = _onto(segments[half], its_edge, segments[name], edge)
            inner |= {half: np.eye(3) if onto is None else onto}
            if onto is None:  # they are not alike: they are pieces of their own
                inner[half] = _shifted(np.ptp(_corners(segments[name], np.eye(3))[:, 0]) * (1.0 + _GAP), 0.0)
        corners = np.concatenate([_corners(segments[one], place) for one, place in inner.items()])
        low, width = corners.min(axis=0), float(np.ptp(corners[:, 0]))
        right += _GAP * width
        places |= {one: _shifted(right - low[0], -low[1]) @ place for one, place in inner.items()}
        right += (1.0 + _GAP) * width
    return places


def _signed_area(segments: Sequence[Segment]) -> float:
    """Return the area between the corners of a panel, above zero if its edges go round to the left."""
    return float(sum((one.start.conjugate() * one.end).imag for one in segments)) / 2.0


def _corners(segments: Sequence[Segment], place: FloatArray) -> FloatArray:
    return SvgCurve(tuple(segments), place).extent


def _shifted(x: float, y: float) -> FloatArray:
    return np.array([[1.0, 0.0, x], [0.0, 1.0, y], [0.0, 0.0, 1.0]])


def _onto(panel: Sequence[Segment], edge: int, other: Sequence[Segment], its: int) -> FloatArray | None:
    """Return the rotation and shift that lay a panel beside another, edge on edge; None if these differ in length."""
    start, end = other[its].start, other[its].end
    if (_signed_area(panel) > 0.0) == (
        _signed_area(other) > 0.0
    ):  # both go round alike: the edges run against each other
        start, end = end, start
    along, wanted = panel[edge].end - panel[edge].start, end - start
    if abs(abs(along) - abs(wanted)) > _SAME * abs(wanted):
        return None
    turn = wanted / along / abs(wanted / along)
    shift = start - turn * panel[edge].start
    return np.array([[turn.real, -turn.imag, shift.real], [turn.imag, turn.real, shift.imag], [0.0, 0.0, 1.0]])
