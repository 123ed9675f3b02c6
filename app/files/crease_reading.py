"""Places the fold lines of an imported drawing on the cloth.

A line in a file can have two meanings: a line on the cloth as the previous folds leave it, as in garment files, or a
line on the flat cloth, as in crease patterns. A line on the flat cloth moves with the layers that it is drawn on, to
where they lie when its fold is done.

Drawings are inexact. A line that crosses the outline is cut there, and a line that nearly reaches the edge of the cloth
is extended to it. An end well inside the outline stays, since the line may have the other meaning.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import DrawnFold
from planner.errors import FoldError, GarmentError
from planner.folds.fold import snapped_line
from planner.folds.fold_cloth import Folded, fold_cloth
from planner.geometry.chord import nearest_chord
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M, SNAP_M
from planner.message import Message

Creases: TypeAlias = Literal["folded", "flat"]
"""The cloth on which lines are drawn: as the previous folds leave it, or flat."""

NEAR_M = 0.02
"""Distance from the edge of the cloth within which an end is taken as on it (m): people draw by hand."""


@dataclass(frozen=True, slots=True)
class ReadCreases:
    """The fold lines of a drawing, read with one of the two meanings.

    Attributes:
        folds: all folds, garment frame; the legal ones lie on the cloth, the others stay as drawn.
        legal: the number of legal folds, up to the first illegal one.
        cut_m: by fold index, the length cut off or added to the line (m), if it is more than a little.
        problem: the problem of the first illegal fold; None if all are legal.
    """

    folds: tuple[DrawnFold, ...]
    legal: int
    cut_m: dict[int, float]
    problem: Message | None


def read_creases(outline: Sequence[Point2], folds: Sequence[DrawnFold], creases: Creases) -> ReadCreases:
    """Return the fold lines placed on the cloth one after the other, up to the first that does not fit.

    Args:
        outline: the corners of a valid outline (m).
        folds: the lines as drawn, in the user's order.
        creases: the cloth on which they are drawn.
    """
    pattern = Region.polygon(outline)
    cloth = ClothState.spread_out(pattern)
    found: list[DrawnFold] = []
    cut_m: dict[int, float] = {}
    before: Segment | None = None
    for index, fold in enumerate(folds):
        try:
            placed = _placed(fold, pattern, cloth, before, creases)
        except (FoldError, GarmentError) as error:
            return ReadCreases((*found, *folds[index:]), index, cut_m, error.says or Message.plain(error.message))
        if placed.cut_m > SNAP_M:
            cut_m[index] = placed.cut_m
        found.append(replace(fold, start=placed.drawn.start, end=placed.drawn.end))
        cloth, before = placed.folded.cloth, placed.line
    return ReadCreases(tuple(found), len(found), cut_m, None)


@dataclass(frozen=True, slots=True)
class _Placed:
    """A legal fold.

    Attributes:
        drawn: its line as in the file, cut or moved if necessary.
        line: that line with its ends on the boundary.
        folded: the result of folding.
        cut_m: the length cut off or added to the line in the file (m).
    """

    drawn: Segment
    line: Segment
    folded: Folded
    cut_m: float


def _placed(fold: DrawnFold, pattern: Region, cloth: ClothState, before: Segment | None, creases: Creases) -> _Placed:
    """Return a fold placed on the cloth; `before` is the line of the previous fold.

    Raises:
        FoldError: no reading gives a legal fold; the error is that of the first reading.
    """
    silhouette = FOLD_KINDS[fold.kind].silhouette(cloth)
    drawn = Segment(fold.start, fold.end)
    first: FoldError | GarmentError | None = None
    ways = _carried(drawn, pattern, cloth, fold.kind) if creases == "flat" else _cut(drawn, pattern, silhouette)
    for line, cut_m in ways:
        try:
            snapped = snapped_line(replace(fold, start=line.start, end=line.end), silhouette)
            folded = fold_cloth(cloth, snapped, fold.kind, before if fold.is_red else None)
            return _Placed(line, snapped, folded, cut_m)
        except (FoldError, GarmentError) as error:
            first = first or error
    raise first or FoldError("start", "no cloth lies under the line when its turn comes")


def _cut(line: Segment, pattern: Region, silhouette: Region) -> Iterator[tuple[Segment, float]]:
    """Yield a line as drawn, then from edge to edge of the cloth if its ends overhang or nearly reach the edge."""
    yield line, 0.0
    chord = nearest_chord(silhouette, line)
    if chord is None:
        return
    ends = ((line.start, chord.start), (line.end, chord.end))
    if all(_may_slide(end, to, pattern) for end, to in ends):
        yield chord, max(math.dist(*pair) for pair in ends)


def _may_slide(end: Point2, to: Point2, pattern: Region) -> bool:
    is_overhang = not pattern.contains(end) and pattern.boundary_distance(to) <= NEAR_M
    return is_overhang or math.dist(end, to) <= NEAR_M


def _carried(line: Segment, pattern: Region, cloth: ClothState, kind: str) -> Iterator[tuple[Segment, float]]:
    """Yield the line on the flat cloth as its layers have moved it, for the longest piece first."""
    silhouette = FOLD_KINDS[kind].silhouette(cloth)
    pieces = sorted(
        (
            _moved(Segment(*ends), layer.isometry)
            for layer in FOLD_KINDS[kind].layers(cloth)
            for ends in layer.pattern_piece.overlaps_with(line)
            if math.dist(*ends) > LENGTH_M
        ),
        key=lambda piece: -piece.length,
    )
    overhang_m = _overhang(line, pattern)
    for piece in pieces:
        chord = nearest_chord(silhouette, piece)
        gap_m = 0.0 if chord is None else _gap(chord, pieces)
        if chord is not None and gap_m <= NEAR_M:
            yield chord, max(overhang_m, gap_m)


def _moved(piece: Segment, isometry: Isometry) -> Segment:
    """Return a piece of a line moved with its layer; reversed on a turned layer, to keep the moving side."""
    start, end = (isometry.apply_point(point) for point in (piece.start, piece.end))
    return Segment(end, start) if isometry.is_mirrored else Segment(start, end)


def _gap(chord: Segment, pieces: Sequence[Segment]) -> float:
    """Return the longest stretch of a chord that no piece covers (m)."""
    ends = [np.array([piece.start, piece.end]) for piece in pieces]
    on_it = [points for points in ends if np.abs(chord.left_distances(points)).max() <= SNAP_M]
    reached_m = longest_m = 0.0
    for low_m, high_m in sorted(tuple(np.sort(chord.positions(points)).tolist()) for points in on_it):
        longest_m = max(longest_m, low_m - reached_m)
        reached_m = max(reached_m, high_m)
    return max(longest_m, chord.length - reached_m)


def _overhang(line: Segment, pattern: Region) -> float:
    """Return the distance by which a line's ends extend past the flat cloth (m), the larger of the two."""
    ends = [end for stretch in pattern.overlaps_with(line) for end in stretch]
    if not ends:
        return 0.0
    along = line.positions(np.array(ends))
    return max(float(along.min()), line.length - float(along.max()), 0.0)
