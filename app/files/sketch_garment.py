"""From a drawing to a garment: which curve is the outline, where the folds are, how large it all is."""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from app.files.import_errors import ImportedFileError, UnitsNeededError
from app.files.outline import TOLERANCE_M, FoundOutline, find_outline
from app.files.sketch import Sketch
from planner.cloth.garment import FOLDS_MAX, TITLE_MAX, Garment
from planner.cloth.outline import EDGE_MIN_M
from planner.errors import GarmentError
from planner.geometry.pose import FloatArray
from planner.geometry.segment import Segment
from planner.strict_model import LARGEST_M

UNITS_M: Mapping[str, float] = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}
"""What a unit of a drawing may be said to be (m)."""

UNITS_MIN_MAX_M = (1e-9, 1e3)
"""Drawings whose unit is shorter or longer are refused (m)."""

ODD_SIZES_M = (0.05, 4.0)
"""A garment narrower or wider than this is doubted (m)."""

KEPT_FIELDS = ("name", "areal_density_kg_m2", "grip_radius_m", "placement")
"""What an exported drawing keeps beside its lines: fields of a garment file."""

_NAME_MAX = 63
_SHEET_MAX_M = 100.0


@dataclass(frozen=True, slots=True)
class SketchedGarment:
    """A garment, and what is to be said about how it came about, in sentences."""

    garment: Garment
    notes: tuple[str, ...]


def garment_of(sketch: Sketch, name: str, units: str | None, scale: float) -> SketchedGarment:
    """The garment that a drawing shows.

    Args:
        sketch: the drawing.
        name: what to call it if the drawing has no title.
        units: what one of its units is, one of `UNITS_M`; None: what the file says.
        scale: everything is so many times as large.

    Raises:
        UnitsNeededError: neither the file nor the caller says how long a unit is.
        ImportedFileError: there is no outline in it, or it is too large.
        GarmentError: the outline is none of a garment.
    """
    unit_m = UNITS_M[units] if units is not None else sketch.unit_m
    if unit_m is None:
        raise UnitsNeededError(sketch.why_no_unit, _sizes(sketch, scale))
    unit_m *= scale
    if not UNITS_MIN_MAX_M[0] <= unit_m <= UNITS_MIN_MAX_M[1]:
        raise ImportedFileError("scale", f"one unit of the drawing would be {unit_m:.3g} m; give another scale")
    with np.errstate(all="ignore"):
        extent = _extent(sketch) * unit_m
    _require_size(extent, _SHEET_MAX_M, "the drawing")
    found = find_outline(sketch.curves, unit_m)
    _require_size(found.points, LARGEST_M, "the outline")
    origin = found.points.min(axis=0) if sketch.kept is None else np.zeros(2)
    title = " ".join((sketch.title or name).split())[:TITLE_MAX] or name
    notes = [*_outline_notes(found, units, unit_m), *sketch.notes]
    drawn = {
        "name": plain_name(title),
        "title": title,
        "outline": (found.points - origin).tolist(),
        "folds": list(_folds(sketch, found, unit_m, origin, notes)),
    }
    return SketchedGarment(_garment(drawn, sketch.kept or {}, notes), tuple(notes))


def _garment(drawn: Mapping[str, Any], kept: Mapping[str, Any], notes: list[str]) -> Garment:
    """The garment that is drawn, with what an exported drawing keeps beside its lines if that is any good."""
    beside = {name: kept[name] for name in KEPT_FIELDS if name in kept}
    try:
        return Garment.from_dict({**drawn, **beside})
    except GarmentError:
        if not beside:
            raise
    garment = Garment.from_dict(drawn)
    notes.append(f"What the drawing says of its {', '.join(beside)} could not be read and was left out.")
    return garment


def plain_name(title: str) -> str:
    """A title as the name of a garment: small letters, digits and hyphens."""
    return re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-")[:_NAME_MAX].strip("-") or "imported"


def _sizes(sketch: Sketch, scale: float) -> dict[str, tuple[float, float]]:
    """How large the garment would be in each unit (m)."""
    extent = _extent(sketch)
    with np.errstate(all="ignore"):
        span = float((extent.max(axis=0) - extent.min(axis=0)).max()) or 1.0
    if not math.isfinite(span):
        raise ImportedFileError("file", "its numbers are too large")
    outlined = find_outline(sketch.curves, 1.0 / span).points * span
    width, height = (outlined.max(axis=0) - outlined.min(axis=0)) * scale
    return {unit: (float(width) * unit_m, float(height) * unit_m) for unit, unit_m in UNITS_M.items()}


def _require_size(points: FloatArray, most_m: float, what: str) -> None:
    """Refuse what is too large, points of shape (n, 2), m."""
    with np.errstate(all="ignore"):
        width, height = points.max(axis=0) - points.min(axis=0)
    if not max(width, height) <= most_m:
        message = f"{what} is {width:.3g} m wide and {height:.3g} m high, more than {most_m:g} m"
        raise ImportedFileError("scale", f"{message}; say what its units are, or give a scale")


def _extent(sketch: Sketch) -> FloatArray:
    curves = (*sketch.curves, *(fold.curve for fold in sketch.folds))
    if not curves:
        raise ImportedFileError("file", "there is nothing drawn in it")
    return np.concatenate([curve.extent for curve in curves])


def _folds(
    sketch: Sketch, found: FoundOutline, unit_m: float, origin: FloatArray, notes: list[str]
) -> Iterator[dict[str, Any]]:
    """The folds in the file's order, as in a garment file; adds to the notes what is to be said about them."""
    near = [line for line in sketch.folds if found.is_about(line.curve.extent * unit_m)]
    if len(near) < len(sketch.folds):
        notes.append(f"Fold lines away from the outline were left out: {len(sketch.folds) - len(near)}.")
    long = [line for line in near if math.dist(*(line.curve.extent[[0, -1]] * unit_m)) >= EDGE_MIN_M]
    if len(long) < len(near):
        notes.append(f"Fold lines shorter than {1000 * EDGE_MIN_M:g} mm were left out: {len(near) - len(long)}.")
    if len(long) > FOLDS_MAX:
        notes.append(f"There are {len(long)} fold lines; the first {FOLDS_MAX} were taken.")
    for number, line in enumerate(long[:FOLDS_MAX]):
        points = line.curve.flattened(TOLERANCE_M / unit_m) * unit_m - origin
        name = (line.name or f"fold {number + 1}")[:TITLE_MAX]
        start, end = points[0].tolist(), points[-1].tolist()
        if Segment(tuple(start), tuple(end)).distances(points).max() > EDGE_MIN_M:
            notes.append(f"The line {name!r} is not straight; the fold goes straight from its start to its end.")
        kind = line.kind
        if kind == "red" and number == 0:
            kind = "blue"
            notes.append(f"The line {name!r} is red, but no fold comes before it, so it was made blue.")
        yield {"name": name, "kind": kind, "start": start, "end": end, "grip_radius_m": line.grip_radius_m}


def _outline_notes(found: FoundOutline, units: str | None, unit_m: float) -> Iterator[str]:
    if len(found.others):
        lines = "another closed line" if len(found.others) == 1 else f"{len(found.others)} other closed lines"
        yield f"The largest closed line was taken as the outline; {lines} in the file left out."
    yield (
        f"The outline has {len(found.points)} corners; any curves were replaced by straight edges that are at most "
        f"{1000 * found.tolerance_m:g} mm off."
    )
    width, height = found.points.max(axis=0) - found.points.min(axis=0)
    said = "" if units is None else ", as you said"
    yield f"One unit of the drawing was taken as {1000 * unit_m:.6g} mm{said}: {width:.3f} m by {height:.3f} m."
    if max(width, height) < ODD_SIZES_M[0] or max(width, height) > ODD_SIZES_M[1]:
        yield "That is an odd size for a garment; look whether the units are right."
