"""The scale of a picture as the user gives it: a sheet of paper, a marker, a length of the garment, a calibration."""

import re
from dataclasses import dataclass
from typing import Literal, TypeAlias

from app.files.sketch_size import UNITS_M
from app.rehearsal.camera.calibration import Calibration
from app.rehearsal.vision.vision_errors import PictureError

SHEETS_M = {"a4": (0.297, 0.210), "letter": (0.2794, 0.2159)}
"""Longer and shorter side of the sheets of paper that are looked for (m)."""

LENGTH_M = (0.02, 10.0)
"""Range of a garment's length (m)."""

MARKER_M = (0.01, 1.0)
"""Range of a marker's side (m)."""

Across: TypeAlias = Literal["longest", "width", "height"]


@dataclass(frozen=True, slots=True)
class SheetSaid:
    """A sheet of paper lies beside the garment; "a4" or "letter"."""

    name: str


@dataclass(frozen=True, slots=True)
class MarkerSaid:
    """An ArUco marker lies beside the garment, its black square so wide (m)."""

    side_m: float


@dataclass(frozen=True, slots=True)
class LengthSaid:
    """The garment's length (m): from end to end, or across the picture, or up it."""

    length_m: float
    across: Across


ScaleSaid: TypeAlias = SheetSaid | MarkerSaid | LengthSaid | Calibration
"""A calibrated camera tells the table's frame too."""

_LENGTH = re.compile(r"(\d{1,6}(?:\.\d{1,9})?|\.\d{1,9})\s*(mm|cm|m|in)(?::(longest|width|height))?", re.ASCII)
_MARKER = re.compile(r"marker:(\d{1,6}(?:\.\d{1,9})?|\.\d{1,9})\s*(mm|cm|m|in)", re.ASCII)


def read_scale(said: str) -> ScaleSaid:
    """Return what a text says: ``a4``, ``letter``, ``marker:50mm``, ``0.60m``, ``24in:width``, ``70cm:height``.

    Raises:
        PictureError: the field is ``scale``.
    """
    text = said.strip().lower()
    if text in SHEETS_M:
        return SheetSaid(text)
    if found := _MARKER.fullmatch(text):
        return MarkerSaid(_metres(found[1], found[2], MARKER_M, "the marker"))
    if found := _LENGTH.fullmatch(text):
        length_m = _metres(found[1], found[2], LENGTH_M, "the garment")
        across: Across = "width" if found[3] == "width" else "height" if found[3] == "height" else "longest"
        return LengthSaid(length_m, across)
    raise PictureError(
        "scale", f"expected one of a4, letter, marker:50mm, 0.60m:longest, :width or :height; got {said[:40]!r}"
    )


def _metres(number: str, unit: str, allowed_m: tuple[float, float], what: str) -> float:
    length_m = float(number) * UNITS_M[unit]
    if not allowed_m[0] <= length_m <= allowed_m[1]:
        raise PictureError("scale", f"{what} is {length_m:g} m, not between {allowed_m[0]:g} and {allowed_m[1]:g} m")
    return length_m
