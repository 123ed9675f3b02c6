"""Reads DXF, sewing patterns and others: closed lines are candidates for the outline; coloured open lines are folds."""

import io
import logging
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np
from ezdxf import recover
from ezdxf.colors import BYBLOCK, BYLAYER, aci2rgb, int2rgb
from ezdxf.document import Drawing
from ezdxf.entities.dxfentity import DXFEntity
from ezdxf.entities.dxfgfx import DXFGraphic
from ezdxf.entities.insert import Insert
from ezdxf.entities.mtext import MText
from ezdxf.entities.spline import Spline
from ezdxf.entities.text import Text
from ezdxf.lldxf.const import DXFError
from ezdxf.math import Vec3
from ezdxf.path import Path, make_path

from app.files.colour_spaces import Rgb
from app.files.curve import POINTS_MAX, DrawnCurve, finite
from app.files.dxf_layers import (
    BOUNDARY,
    INSUNITS_M,
    MIRROR_LINE,
    kind_by_name,
    may_carry_folds,
    piece_by_text,
    sample_by_text,
    size_by_text,
    unit_by_text,
)
from app.files.fold_colour import kind_of
from app.files.import_errors import broken
from app.files.piece_labels import names_fold, piece_in, says_on_fold, size_in
from app.files.sketch import DrawnLine, FoldLine, MirrorLine, Role, Sketch
from planner.geometry.pose import FloatArray

ENTITIES_MAX, INSERTS_MAX = 20_000, 1_000
"""Largest numbers of entities and of inserted blocks; blocks can multiply entities."""

SPLINE_POINTS_MAX = 1_000
"""Largest number of points of a spline; interpolating more takes too long."""

_BLOCKS_DEEP = 8
"""Largest nesting depth of blocks."""

_LINES = frozenset({"LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE"})
_BAD = (DXFError, ArithmeticError, AssertionError, AttributeError, LookupError, RecursionError, TypeError, ValueError)
"""Exceptions that ezdxf raises on files that are not DXF or hold nonsensical numbers."""

# It would log every number that it repairs in a user's file to the server's log.
logging.getLogger("ezdxf").setLevel(logging.CRITICAL)


@dataclass(frozen=True, slots=True, eq=False)
class _Line:
    """A connected line with its layer, fold kind, graded size and the number of its block."""

    curve: DrawnCurve
    layer: str
    kind: str | None
    is_closed: bool
    size: str | None
    block: int | None


@dataclass(frozen=True, slots=True)
class _Inherited:
    """What entities in a block inherit from its insertion: layer, colour (ACI), size, name and number of the piece."""

    layer: str = "0"
    colour: int = 7
    size: str | None = None
    piece: str | None = None
    block: int | None = None


def read_dxf(data: bytes) -> Sketch:
    """Return the drawing in a DXF file.

    Raises:
        ImportedFileError: the file is not DXF, or has too many entities.
    """
    try:
        drawing, _ = recover.read(io.BytesIO(data))
        entities = list(_all(drawing))
        lines = [line for entity, inherited in entities for line in _lines(drawing, entity, inherited)]
        texts = _texts(entity for entity, _ in entities)
    except _BAD as error:
        raise broken(f"it is not DXF that can be read: {str(error)[:200]}") from None
    is_pattern = any(line.layer == BOUNDARY for line in lines)
    if is_pattern:
        lines = [replace(line, curve=replace(line.curve, block=line.block)) for line in lines]
    roles = [_role(line, is_pattern=is_pattern) for line in lines]
    others = roles.count(None)
    notes = ["It is a sewing pattern: layer 1 is the boundary of its pieces."] if is_pattern else []
    if others:
        notes.append(f"{others} line{'s' if others > 1 else ''} on its other layers left out.")
    sketch = Sketch(
        (),
        (),
        _unit_m(drawing, texts),
        "it has no $INSUNITS",
        notes=tuple(notes),
        says_fold=any(map(says_on_fold, texts)) or ("fold" not in roles and any(map(names_fold, texts))),
        sample=sample_by_text(texts),
    )
    return sketch.with_lines(_drawn(line, role) for line, role in zip(lines, roles, strict=True) if role is not None)


def _role(line: _Line, *, is_pattern: bool) -> Role | None:
    """Return what a line may be; None for one on a layer that is for something else."""
    is_mirror = (is_pattern and line.layer == MIRROR_LINE) or says_on_fold(line.layer)
    if not line.is_closed and (is_mirror or (line.kind is None and names_fold(line.layer))):
        return "mirror"
    may_be_fold = not line.is_closed and (may_carry_folds(line.layer) if is_pattern else True)
    if line.kind is not None and may_be_fold:
        return "fold"
    return "outline" if line.layer == BOUNDARY or not is_pattern else None


def _drawn(line: _Line, role: Role) -> DrawnLine:
    if role == "fold":
        return DrawnLine(role, FoldLine(line.kind or "blue", line.curve), line.size)
    return DrawnLine(role, MirrorLine(line.curve) if role == "mirror" else line.curve, line.size)


def _texts(entities: Iterable[DXFEntity]) -> list[str]:
    """Return the texts among entities, without the codes that format them."""
    return [str(entity.plain_text()) for entity in entities if isinstance(entity, Text | MText)]


def _unit_m(drawing: Drawing, texts: list[str]) -> float | None:
    by_text = unit_by_text(texts)
    units = drawing.header.get("$INSUNITS", 0)
    return INSUNITS_M.get(units) if by_text is None else by_text


def _all(drawing: Drawing) -> Iterator[tuple[DXFEntity, _Inherited]]:
    """Yield all entities of the model space, with inserted blocks expanded; if it is empty, those of the blocks."""
    space = drawing.modelspace()
    blocks = (block for block in drawing.blocks if not block.is_any_layout)
    counts = {"entities": 0, "blocks inserted": 0}
    if len(space):
        yield from _within(space, _Inherited(), 0, counts)
        return
    for number, block in enumerate(blocks):
        named = _Inherited(size=_size_of(block, block.name), piece=_piece_of(block, block.name), block=number)
        yield from _within(block, named, 0, counts)


def _size_of(entities: Iterable[DXFEntity], name: str) -> str | None:
    """Return the size of the piece in a block, by a text in it or else by its name."""
    return size_by_text(_texts(entities)) or size_in(name)


def _piece_of(entities: Iterable[DXFEntity], name: str) -> str | None:
    """Return the name of the piece in a block, by a text in it or else the block's."""
    return piece_by_text(_texts(entities)) or piece_in(name)


def _within(
    entities: Iterable[DXFEntity], around: _Inherited, deep: int, counts: dict[str, int]
) -> Iterator[tuple[DXFEntity, _Inherited]]:
    for entity in entities:
        if not isinstance(entity, Insert):
            _count(counts, "entities", ENTITIES_MAX)
            yield entity, around
        elif deep < _BLOCKS_DEEP:
            _count(counts, "blocks inserted", INSERTS_MAX)
            block = entity.block()
            size, piece = (None, None) if block is None else (read(block, block.name) for read in (_size_of, _piece_of))
            inner = _Inherited(
                _layer(entity, around),
                _colour(entity, around),
                size or around.size,
                piece or around.piece,
                counts["blocks inserted"] if around.block is None else around.block,
            )
            yield from _within(entity.virtual_entities(), inner, deep + 1, counts)


def _count(counts: dict[str, int], what: str, most: int) -> None:
    counts[what] += 1
    if counts[what] > most:
        raise broken(f"there are more than {most} {what} in it")


def _lines(drawing: Drawing, entity: DXFEntity, around: _Inherited) -> Iterator[_Line]:
    if entity.dxftype() not in _LINES or not isinstance(entity, DXFGraphic) or entity.dxf.get("invisible", 0):
        return
    if isinstance(entity, Spline) and max(entity.fit_point_count(), entity.control_point_count()) > SPLINE_POINTS_MAX:
        raise broken(f"a spline in it has more than {SPLINE_POINTS_MAX} points")
    try:
        path = make_path(entity)
    except TypeError:  # a POLYLINE may be a mesh
        return
    layer = _layer(entity, around)
    if drawing.layers.has_entry(layer) and not drawing.layers.get(layer).is_on():
        return
    kind = kind_by_name(layer) or kind_of(_rgb(drawing, entity, layer, around))
    for part in path.sub_paths():
        if len(part):
            yield _Line(
                _curve(part, around.piece), layer, kind, part.is_closed, around.size or size_in(layer), around.block
            )


def _curve(path: Path, piece: str | None) -> DrawnCurve:
    def cut(tolerance: float) -> FloatArray:
        points = list(islice(path.flattening(tolerance, segments=4), POINTS_MAX + 1))
        if len(points) > POINTS_MAX:
            raise broken(f"a curve in it needs more than {POINTS_MAX} points")
        return _plane(points)

    return DrawnCurve(finite(_plane(path.control_vertices())), cut, path.has_curves, piece)


def _plane(points: Iterable[Vec3]) -> FloatArray:
    return np.array([(point.x, point.y) for point in points], dtype=np.float64).reshape(-1, 2)


def _layer(entity: DXFEntity, around: _Inherited) -> str:
    """Return an entity's layer; layer 0 in a block stands for the layer of the insertion."""
    layer = str(entity.dxf.get("layer", "0"))
    return around.layer if layer == "0" else layer


def _colour(entity: DXFEntity, around: _Inherited) -> int:
    colour = int(entity.dxf.get("color", BYLAYER))
    return around.colour if colour == BYBLOCK else colour


def _rgb(drawing: Drawing, entity: DXFEntity, layer: str, around: _Inherited) -> Rgb | None:
    """Return an entity's own colour, or else its layer's."""
    true_colour = entity.dxf.get("true_color")
    if true_colour is not None:
        return _shares(int2rgb(true_colour))
    colour = _colour(entity, around)
    if colour == BYLAYER:
        colour = abs(drawing.layers.get(layer).color) if drawing.layers.has_entry(layer) else 7
    return _shares(aci2rgb(colour)) if 0 < colour < BYLAYER else None


def _shares(rgb: tuple[int, int, int]) -> Rgb:
    red, green, blue = rgb
    return (red / 255.0, green / 255.0, blue / 255.0)
