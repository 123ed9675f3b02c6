"""Imports a file as a garment; the ending of its name decides its format."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import PurePath

from app.files.crease_reading import Creases
from app.files.dxf_sketch import read_dxf
from app.files.garment_json import read_garment_json
from app.files.import_errors import ImportedFileError
from app.files.sketch import Sketch
from app.files.sketch_garment import garment_of
from app.files.sketch_size import UNITS_M, Sizes
from app.files.svg_sketch import read_svg
from planner.cloth.garment import Garment
from planner.message import Message
from planner.task.plan_files import ENDING

LARGEST_FILE = 2 << 20
"""Largest size of a drawing or garment file (bytes)."""

LARGEST_PLAN_FILE = 8 << 20
"""Largest size of a plan file (bytes). A typical one has 400 kB; one with as many folds as allowed, a few MB."""

SCALES = (1e-3, 1e3)
"""Range of the scale."""

_SKETCHES: dict[str, Callable[[bytes], Sketch]] = {"svg": read_svg, "dxf": read_dxf}
_JSON = "json"


@dataclass(frozen=True, slots=True)
class Imported:
    """The content of an imported file.

    Attributes:
        format: "json", "svg" or "dxf".
        garment: the garment.
        notes: remarks on the import, in sentences.
        creases: the cloth on which the fold lines were read; None if it makes no difference.
        sizes: the size that a drawing would have in other units; None for a garment file.
    """

    format: str
    garment: Garment
    notes: tuple[Message, ...]
    creases: Creases | None = None
    sizes: Sizes | None = None


def largest(filename: str) -> int:
    """Return the largest size of a file with this name (bytes)."""
    return LARGEST_PLAN_FILE if filename.lower().endswith(ENDING) else LARGEST_FILE


def import_file(
    filename: str, data: bytes, units: str | None = None, scale: float = 1.0, creases: Creases | None = None
) -> Imported:
    """Return the garment in a file.

    Args:
        filename: the file's name.
        data: its content.
        units: the drawing's unit, one of `UNITS_M`; None to take it from the file.
        scale: the factor by which to enlarge everything.
        creases: the cloth on which the drawing's fold lines are; None for the reading that makes more of them legal.

    Raises:
        ImportedFileError: the file is not a garment; the field is ``file``, ``filename``, ``units`` or ``scale``.
        UnitsNeededError: the drawing's unit is unknown, or the one in the file is impossible.
        GarmentError: the garment is invalid; the field is that of a garment file.
        RequestError: the file claims to be a plan but is invalid; the field is that of a plan file.
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
