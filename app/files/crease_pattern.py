"""Reads crease patterns in the FOLD format (github.com/edemaine/fold, doc/spec.md): the key frame, flat.

Its creases are a finished model's, all at once. Those that run straight from edge to edge are lines that cloth can be
folded over one after the other, in the file's order; others take several layers or paper.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from app.files.curve import DrawnCurve
from app.files.import_errors import broken
from app.files.sketch import DrawnLine, FoldLine, Sketch
from planner.errors import FieldError
from planner.geometry.pose import FloatArray
from planner.strict_model import first_error

EDGES_MAX = 20_000
"""Largest number of edges, and of vertices."""

_UNITS_M = {"in": 0.0254, "pt": 0.0254 / 72.0, "m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9}
"""Lengths of units by the format's names (m)."""

_STRAIGHT_RAD = 1e-3
"""Angle up to which creases that meet are one line (rad)."""

_FLAT = 1e-6
"""Height above the plane up to which a pattern is flat, as a share of its size."""


class _Frame(BaseModel):
    """The fields of a key frame that matter here."""

    model_config = ConfigDict(extra="ignore", frozen=True, allow_inf_nan=False)

    vertices_coords: list[list[float]] = Field(min_length=3, max_length=EDGES_MAX)
    edges_vertices: list[tuple[int, int]] = Field(min_length=3, max_length=EDGES_MAX)
    edges_assignment: list[str] = []
    frame_unit: str = ""
    file_title: str = ""


def read_fold(values: Mapping[str, Any]) -> Sketch:
    """Return the drawing of a crease pattern.

    Raises:
        ImportedFileError: it is not valid, or not flat; the message names the field.
    """
    try:
        frame = _Frame.model_validate(values)
    except ValidationError as error:
        found = first_error(error, FieldError, values)
        raise broken(f"it is a FOLD file, but {found.field}: {found.message}") from None
    points = _flat(frame.vertices_coords)
    if not all(0 <= vertex < len(points) for edge in frame.edges_vertices for vertex in edge):
        raise broken("it is a FOLD file, but edges_vertices: there are edges of vertices that are not in it")
    assigned = frame.edges_assignment or ["U"] * len(frame.edges_vertices)
    if len(assigned) != len(frame.edges_vertices):
        raise broken(f"it is a FOLD file, but edges_assignment: expected {len(frame.edges_vertices)} of them")
    edges = list(zip(frame.edges_vertices, assigned, strict=True))
    boundary = [edge for edge, kind in edges if kind == "B"] or frame.edges_vertices
    outer = {vertex for edge in boundary for vertex in edge}
    lines = _straight(points, [edge for edge, kind in edges if kind in ("M", "V")])
    folds = [line for line in lines if line[0] in outer and line[-1] in outer]
    drawn = [DrawnLine("outline", _curve(points, edge)) for edge in boundary]
    for start, *_, end in folds:
        drawn.append(DrawnLine("fold", FoldLine("blue", _curve(points, _smaller_left(points, (start, end))))))
    left = len(lines) - len(folds)
    notes = [f"Creases that do not run from edge to edge were left out: {left}."] if left else []
    unit_m = _UNITS_M.get(frame.frame_unit)
    why = "its frame_unit is none of " + ", ".join(_UNITS_M)
    return Sketch((), (), unit_m, why, frame.file_title or None, notes=tuple(notes)).with_lines(drawn)


def _flat(coordinates: Sequence[Sequence[float]]) -> FloatArray:
    """Return the vertices, shape (n, 2)."""
    if {len(vertex) for vertex in coordinates} - {2, 3}:
        raise broken("it is a FOLD file, but vertices_coords: expected two or three numbers for each vertex")
    points = np.array([[*vertex, 0.0][:3] for vertex in coordinates])
    if np.ptp(points[:, 2]) > _FLAT * max(np.ptp(points[:, :2], axis=0).max(), 1.0):
        raise broken("it is a FOLD file whose first frame is folded: export its crease pattern")
    return points[:, :2]


def _curve(points: FloatArray, ends: Iterable[int]) -> DrawnCurve:
    return DrawnCurve.through(points[list(ends)])


def _straight(points: FloatArray, edges: Sequence[tuple[int, int]]) -> list[list[int]]:
    """Return creases joined where they go straight on, as vertices along each, in the order of the first of each."""
    at: dict[int, list[int]] = {}
    for number, edge in enumerate(edges):
        for vertex in edge:
            at.setdefault(vertex, []).append(number)
    used: set[int] = set()
    lines = []
    for number, (one, other) in enumerate(edges):
        if number not in used:
            used.add(number)
            line = [one, other]
            for _ in range(2):  # at one end, then at the other
                while (further := _further(points, edges, at, line, used)) is not None:
                    line.append(further)
                line.reverse()
            lines.append(line)
    return lines


def _further(
    points: FloatArray, edges: Sequence[tuple[int, int]], at: Mapping[int, list[int]], line: list[int], used: set[int]
) -> int | None:
    """Return the vertex to which a line goes straight on from its end, and note the crease as used."""
    before, end = line[-2:]
    along = points[end] - points[before]
    for number in at[end]:
        one, other = edges[number]
        vertex = other if one == end else one
        ahead = points[vertex] - points[end]
        turned = math.atan2(along[0] * ahead[1] - along[1] * ahead[0], float(along @ ahead))
        if number not in used and abs(turned) < _STRAIGHT_RAD:
            used.add(number)
            return vertex
    return None


def _smaller_left(points: FloatArray, ends: tuple[int, int]) -> tuple[int, int]:
    """Return the ends of a line so that most vertices lie to its right: the smaller part of the cloth is folded."""
    start, end = ends
    along, away = points[end] - points[start], points - points[start]
    left = along[0] * away[:, 1] - along[1] * away[:, 0]
    return (start, end) if left.max() <= -left.min() else (end, start)
