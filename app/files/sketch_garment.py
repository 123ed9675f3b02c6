"""Turns a drawing into a garment: finds the outline, the folds and the scale."""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from app.files.crease_reading import Creases, ReadCreases, read_creases
from app.files.graded_sizes import Graded, graded_sketch
from app.files.halves import mirrored_line, whole_line
from app.files.import_errors import ImportedFileError, UnitsNeededError
from app.files.outline import TOLERANCE_M, FoundOutline, find_outline
from app.files.pieces import Pieces
from app.files.seam_allowance import Allowance, Line
from app.files.sketch import Sketch
from app.files.sketch_size import (
    SHEET_MAX_M,
    UNITS_M,
    UNITS_MIN_MAX_M,
    Sizes,
    extent_of,
    require_likely,
    require_size,
    sizes_by_unit,
)
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import FOLDS_MAX, TITLE_MAX, Garment
from planner.cloth.outline import EDGE_MIN_M
from planner.errors import GarmentError
from planner.geometry.pose import FloatArray
from planner.geometry.segment import Segment
from planner.geometry.tolerance import SNAP_M
from planner.message import Message
from planner.strict_model import LARGEST_M

ODD_SIZES_M = (0.05, 4.0)
"""Range of usual garment sizes (m); others give a warning."""

KEPT_FIELDS = ("name", "areal_density_kg_m2", "thickness_m", "grip_radius_m", "placement")
"""Fields of a garment file that an exported drawing keeps besides its lines."""

_MIRRORED = ", mirrored"
"""What is added to the name of a fold line for its mirror image on the other half of a piece."""

_NAME_MAX = 63
"""Longest garment name (characters)."""


@dataclass(frozen=True, slots=True)
class Imported:
    """A garment read from a file.

    Attributes:
        garment: the garment.
        notes: remarks on how it was read, in sentences.
        creases: the cloth on which its fold lines were read; None if it makes no difference.
        sizes: the size that a drawing would have in other units; None for a garment file or a picture.
        allowance: a drawing's seam allowance, and whether it was taken along; None for none.
        graded: a drawing's graded sizes, and which was taken; None for one size.
        pieces: a drawing's pieces, and which was taken; None for one piece.
        seen: how sure a garment in a picture is, as JSON; None for other files.
        format: "json", "fold", "svg", "dxf", "png" or "jpeg".
    """

    garment: Garment
    notes: tuple[Message, ...]
    creases: Creases | None = None
    sizes: Sizes | None = None
    allowance: Allowance | None = None
    graded: Graded | None = None
    pieces: Pieces | None = None
    seen: dict[str, Any] | None = None
    format: str = ""


def garment_of(
    sketch: Sketch,
    name: str,
    units: str | None,
    scale: float,
    creases: Creases | None = None,
    line: Line | None = None,
    size: str | None = None,
    piece: str | None = None,
) -> Imported:
    """Return the garment that a drawing shows.

    Args:
        sketch: the drawing.
        name: the garment's name if the drawing has no title.
        units: the drawing's unit, one of `UNITS_M`; None to take it from the file.
        scale: the factor by which to enlarge everything.
        creases: the cloth on which its fold lines are drawn; None for the reading that makes more of them legal.
        line: which line is the outline where the drawing has a cut line and a seam line; None for the seam line.
        size: the graded size to take; None for the drawing's sample size, or the middle one.
        piece: the piece to take, by name or number; None for the largest.

    Raises:
        UnitsNeededError: neither the file nor the caller gives the unit, or the one in the file is impossible.
        ImportedFileError: there is no outline, it is too large, or there is no such size or piece.
        GarmentError: the outline is not valid for a garment.
    """
    sketch, graded = graded_sketch(sketch, size)
    sketch = replace(sketch, piece=piece)
    unit_m = UNITS_M[units] if units is not None else sketch.unit_m
    if unit_m is None:
        raise UnitsNeededError(Message.plain(sketch.why_no_unit), sizes_by_unit(sketch, scale))
    unit_m *= scale
    if not UNITS_MIN_MAX_M[0] <= unit_m <= UNITS_MIN_MAX_M[1]:
        text = f"one unit of the drawing would be {unit_m:.3g} m; give another scale"
        raise ImportedFileError("scale", Message("unit_out_of_range", text, {"unit_m": unit_m}))
    if units is None and scale == 1.0:
        require_likely(sketch, unit_m)
    with np.errstate(all="ignore"):
        extent = extent_of(sketch) * unit_m
    require_size(extent, SHEET_MAX_M, "the drawing")
    found = find_outline(sketch, unit_m, line or "seam")
    require_size(found.points, LARGEST_M, "the outline")
    origin = found.points.min(axis=0) if sketch.kept is None else np.zeros(2)
    title = " ".join((sketch.title or name).split())[:TITLE_MAX] or name
    notes = [*_piece_notes(sketch, found, graded), *_outline_notes(found, units, unit_m)]
    notes += map(Message.plain, sketch.notes)
    if found.loose:
        what, are = ("1 open line is", "it is") if found.loose == 1 else (f"{found.loose} open lines are", "they are")
        notes.append(Message.plain(f"{what} neither blue nor red, so {are} no fold."))
    drawn = {
        "name": plain_name(title),
        "title": title,
        "outline": (found.points - origin).tolist(),
        "folds": list(_folds(sketch, found, unit_m, origin, notes)),
    }
    garment, read = _read(_garment(drawn, sketch.kept or {}, notes), creases, notes)
    wide, tall = (found.points.max(axis=0) - found.points.min(axis=0)).tolist()
    sizes = {name: (wide * each / unit_m * scale, tall * each / unit_m * scale) for name, each in UNITS_M.items()}
    pieces = Pieces(found.piece, found.pieces) if len(found.pieces) > 1 else None
    return Imported(garment, tuple(notes), read, sizes, found.allowance, graded, pieces)


def _read(garment: Garment, creases: Creases | None, notes: list[Message]) -> tuple[Garment, Creases | None]:
    """Return a garment with its fold lines on the cloth, and on which cloth they were read; append to the notes."""
    ways: dict[Creases, ReadCreases] = {
        "folded": read_creases(garment.outline, garment.folds, "folded"),
        "flat": read_creases(garment.outline, garment.folds, "flat"),
    }
    best: Creases = "flat" if ways["flat"].legal > ways["folded"].legal else "folded"
    is_alike = _is_alike(ways["folded"], ways["flat"])
    used = "folded" if is_alike else creases or best
    read = ways[used]
    if creases is None and used == "flat":
        text = (
            "The fold lines were read on the flat cloth: on the cloth as the folds before leave it "
            f"{ways['folded'].legal} of {len(garment.folds)} would fit."
        )
        notes.append(Message.plain(text))
    if read.cut_m:
        changed = (f"{garment.folds[index].name!r} by {1000 * by:.0f} mm" for index, by in read.cut_m.items())
        text = f"Fold lines were made to end at the edge of the cloth: {', '.join(changed)}."
        lines = [{"fold": index, "by_m": by_m} for index, by_m in read.cut_m.items()]
        notes.append(Message("lines_cut", text, {"lines": lines}))
    if read.problem:
        text = f"The line {garment.folds[read.legal].name!r} does not fit: {read.problem.text}."
        values = {"fold": read.legal, "message": read.problem.text, "says": read.problem.to_dict()}
        notes.append(Message("line_does_not_fit", text, values))
    return replace(garment, folds=read.folds), None if is_alike else used


def _is_alike(one: ReadCreases, other: ReadCreases) -> bool:
    """Return whether both readings give the same folds within tolerance."""
    return one.legal == other.legal and all(
        max(math.dist(a.start, b.start), math.dist(a.end, b.end)) <= SNAP_M
        for a, b in zip(one.folds, other.folds, strict=True)
    )


def _garment(drawn: Mapping[str, Any], kept: Mapping[str, Any], notes: list[Message]) -> Garment:
    """Return the drawn garment with the fields kept in an exported drawing, if they are valid."""
    beside = {name: kept[name] for name in KEPT_FIELDS if name in kept}
    try:
        return Garment.from_dict({**drawn, **beside})
    except GarmentError:
        if not beside:
            raise
    garment = Garment.from_dict(drawn)
    notes.append(Message.plain(f"What the drawing says of its {', '.join(beside)} could not be read and was left out."))
    return garment


def plain_name(title: str) -> str:
    """Return a title as a garment's name: small letters, digits and hyphens."""
    return re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-")[:_NAME_MAX].strip("-") or "imported"


def _folds(
    sketch: Sketch, found: FoundOutline, unit_m: float, origin: FloatArray, notes: list[Message]
) -> Iterator[dict[str, Any]]:
    """Yield the folds in the file's order, as in a garment file; append remarks on them to the notes."""
    near = [line for line in sketch.folds if found.is_about(line.curve.extent * unit_m, line.curve.block)]
    if len(near) < len(sketch.folds):
        notes.append(Message.plain(f"Fold lines away from the outline were left out: {len(sketch.folds) - len(near)}."))
    long = [line for line in near if math.dist(*(line.curve.extent[[0, -1]] * unit_m)) >= EDGE_MIN_M]
    if len(long) < len(near):
        count = len(near) - len(long)
        text = f"Fold lines shorter than {1000 * EDGE_MIN_M:g} mm were left out: {count}."
        notes.append(Message("short_lines", text, {"shorter_m": EDGE_MIN_M, "lines": count}))
    if len(long) > FOLDS_MAX:
        notes.append(Message.plain(f"There are {len(long)} fold lines; the first {FOLDS_MAX} were taken."))
    for number, line in enumerate(long[: FOLDS_MAX if found.fold is None else FOLDS_MAX // 2]):
        points = line.curve.flattened(TOLERANCE_M / unit_m) * unit_m
        name = (line.name or f"fold {number + 1}")[:TITLE_MAX]
        ends = points[[0, -1]]
        if Segment(*map(tuple, ends.tolist())).distances(points).max() > EDGE_MIN_M:
            text = f"The line {name!r} is not straight; the fold goes straight from its start to its end."
            notes.append(Message.plain(text))
        kind = line.kind
        if number == 0 and FOLD_KINDS[kind].is_red:
            kind = "blue"
            notes.append(Message.plain(f"The line {name!r} is red, but no fold comes before it, so it was made blue."))
        for half, (start, end) in enumerate(_on_both_halves(ends, found.fold)):
            called = name if not half else f"{name[: TITLE_MAX - len(_MIRRORED)]}{_MIRRORED}"
            written = {"name": called, "kind": kind, "start": (start - origin).tolist(), "end": (end - origin).tolist()}
            yield {**written, "grip_radius_m": line.grip_radius_m}


def _on_both_halves(ends: FloatArray, fold: Segment | None) -> list[FloatArray]:
    """Return a line's ends, and on a piece that was unfolded those of its other half, each shape (2, 2)."""
    if fold is None:
        return [ends]
    if (whole := whole_line(ends, fold)) is not None:
        return [whole]
    image = mirrored_line(ends, fold)
    return [ends] if image is None else [ends, image]


def _piece_notes(sketch: Sketch, found: FoundOutline, graded: Graded | None) -> Iterator[Message]:
    if graded is not None:
        listed = ", ".join(graded.sizes)
        text = f"The drawing has the sizes {listed}; size {graded.size} was taken."
        yield Message("graded_sizes", text, {"size": graded.size, "sizes": list(graded.sizes)})
    if found.fold is not None:
        yield Message("piece_unfolded", "The piece is cut on the fold; it was mirrored over its fold line.")
    elif found.is_joined:
        yield Message("halves_joined", "Two halves that mirror each other were joined.")
    elif sketch.says_fold and not found.has_unfolded:
        text = "The drawing says that a piece is cut on the fold, but not along which edge; it was taken as drawn."
        yield Message("fold_unknown", text)


def _outline_notes(found: FoundOutline, units: str | None, unit_m: float) -> Iterator[Message]:
    if len(found.pieces) > 1:
        text = f"The drawing has the pieces {', '.join(found.pieces)}; {found.piece} was taken."
        yield Message("pieces", text, {"piece": found.piece, "pieces": list(found.pieces)})
    if inner := len(found.others) - (len(found.pieces) - 1):
        lines = "another closed line" if inner == 1 else f"{inner} other closed lines"
        yield Message.plain(f"The largest closed line was taken as the outline; {lines} in the file left out.")
    if found.allowance is not None:
        taken, width_m = found.allowance.line, found.allowance.width_m
        text = f"A seam line runs {1000 * width_m:.1f} mm inside of the cut line; the {taken} line was taken."
        yield Message("seam_allowance", text, {"line": taken, "width_m": width_m})
    corners, off = len(found.points), f"at most {1000 * found.tolerance_m:g} mm off"
    values: dict[str, Any] = {"corners": corners, "off_m": found.tolerance_m}
    if found.is_bent:
        text = f"The outline has {corners} corners; curves were replaced by straight edges that are {off}."
        yield Message("curves_replaced", text, values)
    elif found.is_simplified:
        text = f"The outline has {corners} corners; others were left out, so that its edges are {off}."
        yield Message("corners_left_out", text, values)
    else:
        yield Message.plain(f"The outline has {corners} corners.")
    width, height = (found.points.max(axis=0) - found.points.min(axis=0)).tolist()
    said = "" if units is None else ", as you said"
    text = f"One unit of the drawing was taken as {1000 * unit_m:.6g} mm{said}: {width:.3f} m by {height:.3f} m."
    yield Message("unit_taken", text, {"unit_m": unit_m, "is_said": units is not None, "size": [width, height]})
    if max(width, height) < ODD_SIZES_M[0] or max(width, height) > ODD_SIZES_M[1]:
        yield Message.plain("That is an odd size for a garment; look whether the units are right.")
