"""The size of a drawing: the units that it may have, and the sizes that a garment may have."""

import math
from collections.abc import Mapping
from typing import TypeAlias

import numpy as np

from app.files.import_errors import ImportedFileError, UnitsNeededError
from app.files.outline import find_outline
from app.files.sketch import Sketch
from planner.geometry.pose import FloatArray
from planner.message import Message
from planner.strict_model import LARGEST_M

UNITS_M: Mapping[str, float] = {
    "mm": 1e-3,
    "cm": 1e-2,
    "m": 1.0,
    "in": 0.0254,
    "pt": 0.0254 / 72.0,
    "px": 0.0254 / 96.0,
}
"""Units that a drawing may have, by name (m)."""

UNITS_MIN_MAX_M = (1e-9, 1e3)
"""Range of the length of a unit (m); other drawings are refused."""

LIKELY_M = (0.01, LARGEST_M)
"""Range of possible garment sizes (m); others mean that the file's unit is wrong."""

_SPAN_M = 0.4
"""Size of a drawing of which the unit is not known (m): gaps of a millimetre are closed in a small garment, too."""

SHEET_MAX_M = 100.0
"""Largest width and height of a whole drawing (m)."""


Sizes: TypeAlias = dict[str, tuple[float, float]]
"""The width and height that the garment would have, for each unit that the drawing may have (m)."""


def require_likely(sketch: Sketch, unit_m: float) -> None:
    """Raise `UnitsNeededError` if the file's unit gives a garment of an impossible size.

    Drawing programs write a unit into every file, even if nobody chose it.
    """
    sizes = sizes_by_unit(sketch, 1.0, unit_m)
    longest_m = max(sizes["m"]) * unit_m
    if not LIKELY_M[0] <= longest_m <= LIKELY_M[1]:
        said = f"the unit that it names, {1000 * unit_m:.6g} mm, would make the garment {longest_m:.3g} m long"
        values = {"unit_m": unit_m, "longest_m": longest_m}
        raise UnitsNeededError(Message("unit_unlikely", said, values), sizes)


def sizes_by_unit(sketch: Sketch, scale: float, unit_m: float = 0.0) -> Sizes:
    """Return the garment's size in each unit (m).

    Gaps are closed as in a drawing of a given unit (m), or as in one of `_SPAN_M` if it is not likely.
    """
    extent = extent_of(sketch)
    with np.errstate(all="ignore"):
        span = float((extent.max(axis=0) - extent.min(axis=0)).max()) or 1.0
    if not math.isfinite(span):
        raise ImportedFileError("file", "its numbers are too large")
    assumed_m = unit_m if LIKELY_M[0] <= span * unit_m <= LIKELY_M[1] else _SPAN_M / span
    outlined = find_outline(sketch, assumed_m).points / assumed_m
    width, height = (outlined.max(axis=0) - outlined.min(axis=0)) * scale
    return {unit: (float(width) * each_m, float(height) * each_m) for unit, each_m in UNITS_M.items()}


def require_size(points: FloatArray, most_m: float, what: str) -> None:
    """Raise `ImportedFileError` if points, shape (n, 2), m, extend too far."""
    with np.errstate(all="ignore"):
        width, height = points.max(axis=0) - points.min(axis=0)
    if not max(width, height) <= most_m:
        text = (
            f"{what} is {width:.3g} m wide and {height:.3g} m high, more than {most_m:g} m; say what its units are, or "
            "give a scale"
        )
        values = {"what": what, "size": [float(width), float(height)], "most_m": most_m}
        raise ImportedFileError("scale", Message("drawing_too_large", text, values))


def extent_of(sketch: Sketch) -> FloatArray:
    """Return points that span the drawing, shape (n, 2), in its own unit; raises `ImportedFileError` if it is empty."""
    curves = (*sketch.curves, *(c for more in sketch.faint for c in more), *(fold.curve for fold in sketch.folds))
    if not curves:
        raise ImportedFileError("file", "there is nothing drawn in it")
    return np.concatenate([curve.extent for curve in curves])
