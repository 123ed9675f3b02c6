"""Imports a file as a garment: the kind of file is told by the ending of its name."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import PurePath

from app.files.crease_reading import Creases
from app.files.dxf_sketch import read_dxf
from app.files.garment_json import read_garment_json
from app.files.import_errors import ImportedFileError
from app.files.sketch import Sketch
from app.files.sketch_garment import UNITS_M, Sizes, garment_of
from app.files.svg_sketch import read_svg
from planner.cloth.garment import Garment
from planner.message import Message
from planner.task.plan_files import ENDING

LARGEST_FILE = 2 << 20
"""No drawing and no garment may have more bytes."""

LARGEST_PLAN_FILE = 8 << 20
"""A plan file has some 400 kB; with all folds that a garment may have, a few MB."""

SCALES = (1e-3, 1e3)

_SKETCHES: dict[str, Callable[[bytes], Sketch]] = {"svg": read_svg, "dxf": read_dxf}
_JSON = "json"


@dataclass(frozen=True, slots=True)
class Imported:
    """What came out of a file.

    Attributes:
        format: "json", "svg" or "dxf".
        garment: the garment.
        notes: what is to be said about it, in sentences.
        creases: on which cloth the fold lines of a drawing were read; None where that makes no difference.
        sizes: how large a drawing would be in other units; None for a garment file.
    """

    format: str
    garment: Garment
    notes: tuple[Message, ...]
    creases: Creases | None = None
    sizes: Sizes | None = None


def largest(filename: str) -> int:
    """Return how many bytes a file of a name may have at most."""
    return LARGEST_PLAN_FILE if filename.lower().endswith(ENDING) else LARGEST_FILE


def import_file(
    filename: str, data: bytes, units: str | None = None, scale: float = 1.0, creases: Creases | None = None
) -> Imported:
    """The garment in a file.

    Args:
        filename: what the file is called.
        data: what is in it.
        units: what a unit of a drawing is, one of `UNITS_M`; None: what the file says.
        scale: everything is so many times as large.
        creases: on which cloth the fold lines of a drawing are; None: that on which more of them are legal.

    Raises:
        ImportedFileError: the file is no garment; the field is ``file``, ``filename``, ``units`` or ``scale``.
        UnitsNeededError: nobody says how long a unit of the drawing is, or what the file says cannot be.
        GarmentError: what is in it is no garment; the field is that of a garment file.
        RequestError: what is in it is no plan, though it says so; the field is that of a plan file.
    """
    path = PurePath(filename.replace("\\", "/"))
    ending = path.suffix[1:].lower()
    if units is not None and units not in UNITS_M:
        raise ImportedFileError("units", f"{units[:40]!r} is none of {', '.join(UNITS_M)}")
    if not SCALES[0] <= scale <= SCALES[1]:
        raise ImportedFileError("scale", f"{scale} is not between {SCALES[0]:g} and {SCALES[1]:g}")
    if ending == _JSON:
        return Imported(_JSON, *read_garment_json(data))
    if ending not in _SKETCHES:
        endings = ", ".join(f".{known}" for known in (_JSON, *_SKETCHES))
        raise ImportedFileError("filename", f"{path.name[:80]!r} ends in none of {endings}")
    found = garment_of(_SKETCHES[ending](data), path.stem, units, scale, creases)
    return Imported(ending, found.garment, found.notes, found.creases, found.sizes)
