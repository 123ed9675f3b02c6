"""Where the fold lines of a drawing lie on the cloth.

A line in a file can be meant in two ways: on the cloth as the folds before it leave it, as garment files have it, or on
the flat cloth, as crease patterns have it. A line on the flat cloth is carried to where the layers that it is drawn on
lie when its turn comes.

Drawings are never exact. A line that runs over the outline is cut there, and one that nearly reaches the edge of the
cloth is drawn on to it. An end well inside the outline is left alone: there the line may be meant the other way.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import DrawnFold
from planner.errors import FoldError, GarmentError
from planner.folds.fold import snapped_line
from planner.folds.fold_cloth import Folded, flap_silhouette, fold_cloth
from planner.geometry.chord import nearest_chord
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M, SNAP_M
from planner.message import Message

Creases: TypeAlias = Literal["folded", "flat"]
"""On which cloth the lines are drawn: as the folds before leave it, or flat."""

NEAR_M = 0.02
"""An end this near to the edge of the cloth is meant to be on it (m): outlines and creases are drawn by hand."""


@dataclass(frozen=True, slots=True)
class ReadCreases:
    """The fold lines of a drawing, read in one way.

    Attributes:
        folds: all folds, article frame; those that are legal lie on the cloth, the others stay as drawn.
        legal: how many of them are legal, up to the first that is not.
        cut_m: by the index of a fold, how much of its line was cut off or added (m); not told where that is little.
        problem: what is wrong with the first fold that is not legal; None if all are.
    """

    folds: tuple[DrawnFold, ...]
    legal: int
    cut_m: dict[int, float]
    problem: Message | None


def read_creases(outline: Sequence[Point2], folds: Sequence[DrawnFold], creases: Creases) -> ReadCreases:
    """Put fold lines onto the cloth, each when its turn comes; ends at the first that fits nowhere.

    Args:
        outline: the corners of a good outline (m).
        folds: the lines as drawn, in the user's order.
        creases: on which cloth they are drawn.
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
    """A fold that is legal.

    Attributes:
        drawn: its line as the file has it, cut or carried where that was needed.
        line: the same with its ends on the boundary.
        folded: the fold done.
        cut_m: how much of the line in the file was cut off or added (m).
    """

    drawn: Segment
    line: Segment
    folded: Folded
    cut_m: float


def _placed(fold: DrawnFold, pattern: Region, cloth: ClothState, before: Segment | None, creases: Creases) -> _Placed:
    """A fold where it can be; `before` is the line of the one before it.

    Raises:
        FoldError: no way to read it gives a legal fold; tells what is wrong with the first.
    """
    silhouette = flap_silhouette(cloth, is_red=fold.is_red)
    drawn = Segment(fold.start, fold.end)
    first: FoldError | GarmentError | None = None
    ways = (
        _carried(drawn, pattern, cloth, is_red=fold.is_red) if creases == "flat" else _cut(drawn, pattern, silhouette)
    )
    for line, cut_m in ways:
        try:
            snapped = snapped_line(replace(fold, start=line.start, end=line.end), silhouette)
            folded = fold_cloth(cloth, snapped, is_red=fold.is_red, crease=before if fold.is_red else None)
            return _Placed(line, snapped, folded, cut_m)
        except (FoldError, GarmentError) as error:
            first = first or error
    raise first or FoldError("start", "no cloth lies under the line when its turn comes")


def _cut(line: Segment, pattern: Region, silhouette: Region) -> Iterator[tuple[Segment, float]]:
    """A line as drawn, and from edge to edge of the cloth where its ends overhang the outline or nearly reach it."""
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


def _carried(line: Segment, pattern: Region, cloth: ClothState, *, is_red: bool) -> Iterator[tuple[Segment, float]]:
    """The line on the flat cloth where the layers have carried it, that of the longest piece first."""
    silhouette = flap_silhouette(cloth, is_red=is_red)
    pieces = sorted(
        (
            _moved(Segment(*ends), layer.isometry)
            for layer in (cloth.flap if is_red else cloth.layers)
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
    """A piece of a line where its layer lies; turned round where the layer shows its back, so that the same moves."""
    start, end = (isometry.apply_point(point) for point in (piece.start, piece.end))
    return Segment(end, start) if isometry.is_mirrored else Segment(start, end)


def _gap(chord: Segment, pieces: Sequence[Segment]) -> float:
    """The longest stretch of a chord on which none of some segments lies (m)."""
    ends = [np.array([piece.start, piece.end]) for piece in pieces]
    on_it = [points for points in ends if np.abs(chord.left_distances(points)).max() <= SNAP_M]
    reached_m = longest_m = 0.0
    for low_m, high_m in sorted(tuple(np.sort(chord.positions(points)).tolist()) for points in on_it):
        longest_m = max(longest_m, low_m - reached_m)
        reached_m = max(reached_m, high_m)
    return max(longest_m, chord.length - reached_m)


def _overhang(line: Segment, pattern: Region) -> float:
    """How far the ends of a line are from what of it lies on the flat cloth (m), the larger of the two."""
    ends = [end for stretch in pattern.overlaps_with(line) for end in stretch]
    if not ends:
        return 0.0
    along = line.positions(np.array(ends))
    return max(float(along.min()), line.length - float(along.max()), 0.0)
