"""Imports a file as a garment; the ending of its name decides its format."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import PurePath

from pydantic_core import from_json

from app.distribution import missing
from app.files.crease_pattern import read_fold
from app.files.crease_reading import Creases
from app.files.import_errors import ImportedFileError, broken
from app.files.pattern_panels import read_panels
from app.files.seam_allowance import Line
from app.files.sketch import Sketch
from app.files.sketch_garment import Imported, garment_of
from app.files.sketch_size import UNITS_M
from app.files.svg_sketch import read_svg
from app.rehearsal.vision.vision_errors import LARGEST_PICTURE, NothingToldError, PictureError, ScaleNeededError
from app.templates.catalogue import find_template
from planner.cloth.garment import Garment
from planner.cloth.garment_files import other_kind
from planner.message import Message
from planner.task.plan import Plan
from planner.task.plan_files import ENDING

LARGEST_FILE = 2 << 20
"""Largest size of a drawing or garment file (bytes)."""

LARGEST_PLAN_FILE = 8 << 20
"""Largest size of a plan file (bytes). A typical one has 400 kB; one with as many folds as allowed, a few MB."""

SCALES = (1e-3, 1e3)
"""Range of the scale."""


def _read_dxf(data: bytes) -> Sketch:
    """Return the drawing in a DXF file."""
    from app.files.dxf_sketch import read_dxf  # here, because this import takes a third of a second

    return read_dxf(data)


_SKETCHES: dict[str, Callable[[bytes], Sketch]] = {"svg": read_svg, "dxf": _read_dxf}
_JSON, _FOLD = "json", "fold"
_NEEDS = {"dxf": "ezdxf", "png": "cv2", "jpg": "cv2", "jpeg": "cv2"}
"""The modules of the optional libraries that read files, by the ending of their names."""

_PICTURES = {"png": "png", "jpg": "jpeg", "jpeg": "jpeg"}

ENDINGS = (_JSON, _FOLD, *_SKETCHES, *_PICTURES)
"""The endings of the names of files that can be imported, in lower case."""


def largest(filename: str) -> int:
    """Return the largest size of a file with this name (bytes)."""
    if _ending(filename) in _PICTURES:
        return LARGEST_PICTURE
    return LARGEST_PLAN_FILE if filename.lower().endswith(ENDING) else LARGEST_FILE


def import_file(
    filename: str,
    data: bytes,
    units: str | None = None,
    scale: float = 1.0,
    creases: Creases | None = None,
    measured: str | None = None,
    like: str | Garment | None = None,
    line: Line | None = None,
    size: str | None = None,
    piece: str | None = None,
) -> Imported:
    """Return the garment in a file.

    Args:
        filename: the file's name.
        data: its content.
        units: the drawing's unit, one of `UNITS_M`; None to take it from the file.
        scale: the factor by which to enlarge everything.
        creases: the cloth on which the drawing's fold lines are; None for the reading that makes more of them legal.
        measured: what gives the scale of a picture, as `scale_said` reads it; None to look for a sheet.
        like: the template, by name, or the garment whose measures are fitted to a picture and whose folds come along;
            None to take the outline as it is seen.
        line: which line of a drawing that has a cut line and a seam line is the outline; None for the seam line.
        size: the size to take of a drawing in graded sizes; None for its sample size, or the middle one.
        piece: the piece to take of a drawing with several, by name or number; None for the largest.

    Raises:
        ImportedFileError: the file is not a garment; the field is ``file``, ``filename``, ``units``, ``scale``,
            ``measured``, ``like``, ``size`` or ``piece``.
        UnitsNeededError: the drawing's unit is unknown, or the one in the file is impossible.
        GarmentError: the garment is invalid; the field is that of a garment file.
        RequestError: the file claims to be a plan but is invalid; the field is that of a plan file.
    """
    path = PurePath(filename.replace("\\", "/"))
    ending = _ending(filename)
    if units is not None and units not in UNITS_M:
        raise ImportedFileError("units", f"expected one of {', '.join(UNITS_M)}; got {units[:40]!r}")
    if not SCALES[0] <= scale <= SCALES[1]:
        raise ImportedFileError("scale", f"{scale} is not between {SCALES[0]:g} and {SCALES[1]:g}")
    if ending in _NEEDS and (lacking := missing(_NEEDS[ending])) is not None:
        raise ImportedFileError("filename", lacking)
    drawn = read_json(data) if ending in (_JSON, _FOLD) else None
    if isinstance(drawn, tuple):
        return Imported(*drawn, format=ending)
    if ending in _PICTURES:
        return _picture(_PICTURES[ending], path.stem, data, measured, like)
    if drawn is None and ending not in _SKETCHES:
        endings = ", ".join(f".{known}" for known in ENDINGS)
        raise ImportedFileError("filename", f"{path.name[:80]!r} ends in none of {endings}")
    sketch = drawn or _SKETCHES[ending](data)
    return replace(garment_of(sketch, path.stem, units, scale, creases, line, size, piece), format=ending)


def _ending(filename: str) -> str:
    return PurePath(filename.replace("\\", "/")).suffix[1:].lower()


def _picture(kind: str, name: str, data: bytes, measured: str | None, like: str | Garment | None) -> Imported:
    """Return the garment in a picture."""
    from app.rehearsal.vision.seen_garment import see  # here, because only pictures need OpenCV

    known = find_template(like) if isinstance(like, str) else like
    if like is not None and known is None:
        raise ImportedFileError("like", f"there is no template {like!r}")
    try:
        found = see(data, name, measured, known)
    except PictureError as error:
        field = "measured" if error.field == "scale" else error.field
        raise ImportedFileError(field, error.says or error.message) from None
    except ScaleNeededError as error:
        raise ImportedFileError("measured", Message("scale_needed", str(error))) from None
    except NothingToldError as error:
        raise ImportedFileError("file", error.says) from None
    doubt = () if found.sure.unknown is None else (found.sure.unknown,)
    seen = {key: value for key, value in found.to_dict().items() if key not in ("garment", "notes")}
    return Imported(found.garment, (*doubt, *found.notes), seen=seen, format=kind)


def read_json(data: bytes) -> tuple[Garment, tuple[Message, ...]] | Sketch:
    """Return the garment in a garment file or a plan file, and remarks on it; of a pattern the drawing.

    Raises:
        ImportedFileError: the file is not a JSON object, one of another kind, or a pattern that is not valid.
        GarmentError: the garment is invalid; the error names the field.
        RequestError: the plan is invalid; the error names the field.
    """
    try:
        values = from_json(data.removeprefix(b"\xef\xbb\xbf"), allow_inf_nan=False)
    except ValueError as error:
        raise broken(f"it is not JSON: {error}") from None
    if not isinstance(values, dict):
        raise broken("it is not a JSON object")
    match other_kind(values):
        case "pattern":
            return read_panels(values)
        case "crease pattern":
            return read_fold(values)
        case "robot":
            text = "it is the card of a robot: import it as a zip with its URDF and its meshes"
            raise ImportedFileError("file", Message("robot_card_file", text))
        case "plan":
            return _garment_of(Plan.from_dict(values))
        case None:
            return Garment.from_dict(values), ()


def _garment_of(plan: Plan) -> tuple[Garment, tuple[Message, ...]]:
    """Return the garment of a plan, placed as at the plan's start, and a note that says so."""
    done = len(plan.task.start.folds_done)
    from_middle = f" after {done} of its folds" if done else ""
    text = (
        f"the file is a plan{from_middle}: its garment was taken, where it lies at the plan's start, "
        "and is planned anew with this document's table, stations and costs"
    )
    note = Message("garment_of_plan", text, {"folds_done": done})
    return replace(plan.task.garment, placement=plan.task.start.placement), (note,)
