"""Finds the outline of a garment among the curves of a drawing: the largest closed one, or that of a named piece."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.files.curve import POINTS_MAX as CURVE_POINTS_MAX
from app.files.curve import Curve
from app.files.halves import fold_edge, joined, unfolded
from app.files.import_errors import broken
from app.files.pieces import in_pieces, joined_name, named_pieces, piece_wanted
from app.files.seam_allowance import Allowance, Line, seam_line
from app.files.sketch import MirrorLine, Sketch
from planner.cloth.outline import AREA_MIN_M2, EDGE_MIN_M, POINTS_MAX
from planner.geometry.arrangement import are_tangled, enclosing_rings, runs_along, signed_area, simplified
from planner.geometry.pose import FloatArray
from planner.geometry.segment import Segment

TOLERANCE_M = 0.5e-3
"""Largest deviation of the straight edges from the curve that they replace, unless they are too many (m)."""

_PAIRED_MAX = 8
"""Closed lines, the largest first, among which halves, and a cut line and its seam line, are looked for."""

_UNFOLDED_MAX = 64
"""Closed lines, the largest first, that are unfolded, and fold lines that are looked at."""

_GAP_M = 1.5e-3
"""Largest gap between lines that is closed (m): a millimetre in x and in y."""

_CROSSINGS_MAX = 20_000
"""Largest number of crossings of open lines."""


@dataclass(frozen=True, slots=True, eq=False)
class FoundOutline:
    """An outline found in a drawing.

    Attributes:
        points: its corners (m), shape (n, 2), the first not repeated.
        tolerance_m: their largest deviation from the curves (m).
        is_bent: whether any of the curves is more than straight segments.
        is_simplified: whether corners of the drawing are left out.
        others: the lowest and highest coordinates of each other closed curve (m), shape (n, 2, 2).
        allowance: what was noted about a cut line and a seam line; None where the drawing has no such two.
        fold: where the half piece that was drawn is folded (m); None for a piece that was drawn whole.
        is_joined: whether it was drawn as two halves beside each other.
        has_unfolded: whether any piece of the drawing was mirrored over a fold line.
        piece: the name of the piece that it is.
        pieces: the names of all pieces, the largest first.
        loose: the number of open lines that are no part of any closed line.
        block: the number of the block that it is drawn in, or None.
    """

    points: FloatArray
    tolerance_m: float
    is_bent: bool
    is_simplified: bool
    others: FloatArray
    allowance: Allowance | None = None
    fold: Segment | None = None
    is_joined: bool = False
    has_unfolded: bool = False
    piece: str = ""
    pieces: tuple[str, ...] = ()
    loose: int = 0
    block: int | None = None

    def is_about(self, line: FloatArray, block: int | None) -> bool:
        """Return whether a line, shape (n, 2), in a block may belong to this outline: not to another, nor far away."""
        if block != self.block and None not in (block, self.block):
            return False
        middle = (line[0] + line[-1]) / 2.0
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        if np.all((middle >= low) & (middle <= high)):
            return True
        is_others = np.all((middle >= self.others[:, 0]) & (middle <= self.others[:, 1]), axis=1).any()
        away = middle - np.clip(middle, low, high)
        return not is_others and float(np.hypot(*away)) <= float(np.hypot(*(high - low)))


@dataclass(frozen=True, slots=True, eq=False)
class _Line:
    """A flattened curve.

    Attributes:
        points: its points (m), shape (n, 2).
        is_bent: whether the curve is more than straight segments.
        piece: the name of the piece that it belongs to, or None.
        block: the number of the block that it is drawn in, or None.
    """

    points: FloatArray
    is_bent: bool
    piece: str | None
    block: int | None

    @property
    def is_closed(self) -> bool:
        """Whether the line ends where it begins, within the length of the shortest edge of an outline."""
        return float(np.hypot(*(self.points[0] - self.points[-1]))) <= EDGE_MIN_M


@dataclass(frozen=True, slots=True, eq=False)
class _Ring:
    """A closed line.

    Attributes:
        points: its points (m), shape (n, 2), the first not repeated.
        is_bent: whether any of the curves that it is made of is more than straight segments.
        fold: where it was folded (m); None if it was drawn whole.
        is_joined: whether it is two halves.
        piece: the name of the piece that it belongs to, or None.
        block: the number of the block that it is drawn in, or None.
    """

    points: FloatArray
    is_bent: bool
    piece: str | None
    block: int | None
    fold: Segment | None = None
    is_joined: bool = False

    @property
    def size_m2(self) -> float:
        """The area in it (m2)."""
        return abs(signed_area(self.points))


def find_outline(sketch: Sketch, unit_m: float, wanted: Line = "seam") -> FoundOutline:
    """Return the largest closed line of a drawing, or of the piece that is wanted, with at most 400 corners.

    Open lines are joined where they meet or nearly meet, half pieces unfolded, and halves that lie beside each other
    joined.

    Args:
        sketch: the drawing.
        unit_m: the length of its unit (m).
        wanted: which line to take where a seam line runs along inside the largest one.

    Raises:
        ImportedFileError: there is no closed line, or there are too many points or crossings; or there is no such
            piece, the field is ``piece`` then.
    """
    lines: list[_Line] = []
    rings: list[_Ring] = []
    for curves in (sketch.curves, *sketch.faint):
        lines.extend(_flattened(curves, unit_m))
        if rings := _rings(lines):
            break
    if not rings:
        raise broken("there is no closed line in it that could be the outline of a garment")
    loose = [line.points for line in lines[: len(sketch.curves)] if len(line.points) > 1 and not line.is_closed]
    used = runs_along(loose, [ring.points for ring in rings], _GAP_M) if loose else []
    every = _whole(rings, sketch.mirrors, unit_m)
    pieces = in_pieces([ring.points for ring in every], [ring.block for ring in every])
    names = named_pieces([every[piece[0]].piece for piece in pieces])
    number = piece_wanted(names, sketch.piece)
    rings = [every[within] for within in pieces[number]]
    seam = seam_line([_cornered(ring.points)[0] for ring in rings[:_PAIRED_MAX]])
    ring = rings[seam[0] if seam is not None and wanted == "seam" else 0]
    about = (rings[0], ring if seam is None else rings[seam[0]])
    others = [(one.points.min(axis=0), one.points.max(axis=0)) for one in every if one not in about]
    points, spacing_m, tolerance_m = _cornered(ring.points)
    return FoundOutline(
        points,
        TOLERANCE_M + spacing_m + tolerance_m,
        ring.is_bent,
        len(points) < len(ring.points),
        np.array(others).reshape(-1, 2, 2),
        None if seam is None else Allowance(wanted, seam[1]),
        ring.fold,
        ring.is_joined,
        any(one.fold is not None for one in every),
        names[number],
        names,
        used.count(False),
        ring.block,
    )


def _flattened(curves: Iterable[Curve], unit_m: float) -> list[_Line]:
    lines: list[_Line] = []
    count = 0
    for curve in curves:
        lines.append(_Line(curve.flattened(TOLERANCE_M / unit_m) * unit_m, curve.is_bent, curve.piece, curve.block))
        count += len(lines[-1].points)
        if count > 2 * CURVE_POINTS_MAX:
            raise broken(f"its curves need more than {2 * CURVE_POINTS_MAX} points")
    return lines


def _cornered(ring: FloatArray) -> tuple[FloatArray, float, float]:
    """Return a ring's corners, at most 400, and how much spacing and simplifying them may have moved it (m)."""
    whole = points = _spaced(ring)
    spacing_m = EDGE_MIN_M if len(whole) < len(ring) else 0.0
    tolerance_m = 0.0
    while len(points) > POINTS_MAX:
        tolerance_m = 2.0 * tolerance_m or TOLERANCE_M
        points = _spaced(simplified(whole, tolerance_m))
    return points, spacing_m, tolerance_m


def _rings(lines: Sequence[_Line]) -> list[_Ring]:
    """Return the closed lines that are large enough to be cloth, the largest first."""
    closed = [
        _Ring(line.points[:-1], line.is_bent, line.piece, line.block)
        for line in lines
        if len(line.points) > 3 and line.is_closed
    ]
    loose: dict[int | None, list[_Line]] = {}
    for line in lines:
        if len(line.points) > 1 and not line.is_closed:
            loose.setdefault(line.block, []).append(line)
    return _sorted([*closed, *(ring for block in loose.values() for ring in _enclosing(block))])


def _enclosing(lines: Sequence[_Line]) -> list[_Ring]:
    """Return the closed lines that open lines of one block make together."""
    points = [line.points for line in lines]
    if not points:
        return []
    if are_tangled(points, _CROSSINGS_MAX):
        raise broken(f"its open lines cross each other more than {_CROSSINGS_MAX} times")
    found = []
    for ring in enclosing_rings(points, _GAP_M):
        near = [line for line in lines if (line.is_bent or line.piece) and _overlap(ring, line.points)]
        piece = next((line.piece for line in near if line.piece), None)
        found.append(_Ring(ring, any(line.is_bent for line in near), piece, lines[0].block))
    return found


def _overlap(one: FloatArray, other: FloatArray) -> bool:
    """Return whether the boxes about two lines overlap."""
    return bool(np.all(one.min(axis=0) <= other.max(axis=0)) and np.all(other.min(axis=0) <= one.max(axis=0)))


def _whole(rings: list[_Ring], mirrors: Sequence[MirrorLine], unit_m: float) -> list[_Ring]:
    """Return the rings, the largest first, with half pieces made whole."""
    found = list(rings[_UNFOLDED_MAX:])
    for ring in rings[:_UNFOLDED_MAX]:
        own = [mirror for mirror in mirrors if mirror.curve.block in (None, ring.block)]
        folds = (fold_edge(ring.points, mirror, unit_m) for mirror in own[:_UNFOLDED_MAX])
        fold = next((line for line in folds if line is not None), None)
        points = None if fold is None else unfolded(ring.points, fold)
        found.append(ring if points is None else replace(ring, points=points, fold=fold))
    found = _sorted(found)
    while True:
        large = found[:_PAIRED_MAX]
        pair = joined([_cornered(ring.points)[0] for ring in large], [ring.block for ring in large])
        if pair is None:
            return found
        one, other, points = pair
        piece = joined_name(found[one].piece, found[other].piece)
        both = _Ring(points, found[one].is_bent or found[other].is_bent, piece, found[one].block, is_joined=True)
        found = _sorted([both, *(ring for number, ring in enumerate(found) if number not in (one, other))])


def _sorted(rings: Iterable[_Ring]) -> list[_Ring]:
    return sorted((ring for ring in rings if ring.size_m2 >= AREA_MIN_M2), key=lambda ring: -ring.size_m2)


def _spaced(line: FloatArray) -> FloatArray:
    """Return a closed line without its repeated end, and without points that make edges too short for an outline."""
    kept = [line[0]]
    for point in line[1:]:
        if np.hypot(*(point - kept[-1])) >= EDGE_MIN_M:
            kept.append(point)
    while len(kept) > 1 and np.hypot(*(kept[-1] - kept[0])) < EDGE_MIN_M:
        kept.pop()
    return np.array(kept)
