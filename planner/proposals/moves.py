"""The moves that people fold by: in half, in thirds, sides in, flaps in. A move is one fold or several.

All lines run along the axes of the article frame. The part that moves is the smaller one, so it lands on the other as
far as it can.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import DrawnFold
from planner.errors import FieldError
from planner.folds.fold import snapped_line
from planner.folds.fold_cloth import fold_cloth
from planner.geometry.chord import chords
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M, SNAP_M
from planner.proposals.target import TOLERANCE_M, Sides

_DECIMALS = 6
"""Decimals of a fold's ends (m): the grid on which cloth lies."""

_PARTS = (("left", "right"), ("bottom", "top"))
"""The parts of lower and of higher coordinates along x and y, by name."""

_EASY_SWING_M, _SWING_EFFORT_PER_M = 0.4, 2.0
"""How far from its line cloth may reach that is folded easily (m), and the effort of what reaches further."""

Bounds: TypeAlias = tuple[float, float, float, float]
"""The smallest and largest coordinates: x, y, x, y (m)."""

Noun: TypeAlias = Literal["half", "third", "side", "flap"]
"""The part of the cloth that moves."""


@dataclass(frozen=True, slots=True)
class Move:
    """Folds along lines across one axis.

    Attributes:
        kind: what is done; moves of a kind along an axis are alike.
        effort: how much less natural it is than others; 1 for what everybody does.
        noun: what each of its folds moves.
        axis: the coordinate that its lines have in common: 0 for x, 1 for y.
        lines: the coordinate of each line (m), and whether the part of lower coordinates moves.
    """

    kind: str
    effort: float
    noun: Noun
    axis: int
    lines: tuple[tuple[float, bool], ...]

    def size_after(self, bounds: Bounds) -> Sides:
        """Return the sides of a silhouette with these bounds after the move (m): at most, if no cloth is in its way."""
        low, high = bounds[self.axis], bounds[self.axis + 2]
        for place, is_low in self.lines:
            low, high = _folded(low, high, place, is_low)
        across = bounds[3 - self.axis] - bounds[1 - self.axis]
        return (high - low, across) if self.axis == 0 else (across, high - low)

    def effort_on(self, bounds: Bounds) -> float:
        """Return its effort on a silhouette with these bounds: wide swings take more, arms being short."""
        low, high = bounds[self.axis], bounds[self.axis + 2]
        effort = self.effort
        for place, is_low in self.lines:
            swing_m = place - low if is_low else high - place
            effort += _SWING_EFFORT_PER_M * max(0.0, swing_m - _EASY_SWING_M)
            low, high = _folded(low, high, place, is_low)
        return effort


def inward_moves(bounds: Bounds, sides_m: Iterable[float]) -> Iterator[Move]:
    """Yield the moves that bring a silhouette nearer to a target with such sides (m), from its bounds."""
    for axis in (0, 1):
        low, high = bounds[axis], bounds[axis + 2]
        extent, middle = high - low, (low + high) / 2
        sides = sorted({side for side in sides_m if extent > side + TOLERANCE_M})
        if not sides:
            continue
        third = extent / 3
        for is_low in (True, False):
            yield Move("half", 1.0, "half", axis, ((middle, is_low),))
        yield Move("thirds", 1.0, "third", axis, ((low + third, True), (high - third, False)))
        yield Move("roll", 1.1, "third", axis, ((low + third, True), (high - third, True)))
        yield Move("roll", 1.1, "third", axis, ((high - third, False), (low + third, False)))
        for side in filter(None, sides):
            if extent <= 3 * side + TOLERANCE_M:
                yield Move("sides", 1.05, "side", axis, ((middle - side / 2, True), (middle + side / 2, False)))
            cut = min(side, extent - side)
            if cut < extent / 2 - SNAP_M:
                yield Move("side", 1.5, "side", axis, ((low + cut, True),))
                yield Move("side", 1.5, "side", axis, ((high - cut, False),))


def flap_moves(silhouette: Region) -> Iterator[Move]:
    """Yield the moves that fold flaps in: along lines through corners that point inwards, as pairs where they are."""
    inward = np.concatenate([_inward_corners(ring) for ring in silhouette.shapes])
    for axis in (0, 1):
        low, high = silhouette.bounds[axis], silhouette.bounds[axis + 2]
        middle = (low + high) / 2
        places: list[float] = []
        for place in sorted(inward[:, axis].tolist()):
            is_new = not places or place - places[-1] > SNAP_M
            if is_new and min(place - low, high - place, abs(place - middle)) > SNAP_M:
                places.append(place)
        for place in places:
            other = [one for one in places if abs(place + one - 2 * middle) <= SNAP_M]
            if not other:
                yield Move("flap", 1.3, "flap", axis, ((place, place < middle),))
            elif place < middle:
                yield Move("flaps", 0.5, "flap", axis, ((place, True), (other[0], False)))


def _inward_corners(ring: FloatArray) -> FloatArray:
    """Return the corners of a counter-clockwise ring that point inwards, shape (n, 2), m."""
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    return np.asarray(ring[before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] < 0.0])


def carried_out(cloth: ClothState, move: Move, grip_radius_m: float) -> tuple[ClothState, tuple[DrawnFold, ...]] | None:
    """Return the stack after a move and the folds that it takes; None if one is not legal or hardly a line.

    Where a line crosses the silhouette several times, each stretch is a fold of its own.
    """
    folds: list[DrawnFold] = []
    for place, is_low in move.lines:
        name = f"{_PARTS[move.axis][not is_low]} {move.noun}"
        for chord in _stretches(cloth.silhouette, _line(move.axis, place, is_low)):
            try:
                fold = DrawnFold(name, "blue", _rounded(chord.start), _rounded(chord.end), grip_radius_m)
                cloth = fold_cloth(cloth, snapped_line(fold, cloth.silhouette), fold.kind, None).cloth
            except FieldError:
                return None
            folds.append(fold)
    return (cloth, tuple(folds)) if folds else None


def _stretches(silhouette: Region, line: Segment) -> list[Segment]:
    """Return the chords on a line, those as one that meet in a corner."""
    found: list[Segment] = []
    for chord in chords(silhouette, line):
        if found and math.dist(found[-1].end, chord.start) <= LENGTH_M:
            found[-1] = Segment(found[-1].start, chord.end)
        else:
            found.append(chord)
    return found


def turned_over(cloth: ClothState, grip_radius_m: float) -> tuple[ClothState, tuple[DrawnFold, ...]] | None:
    """Return the stack turned over its longest edge that serves, and the fold; None if none is long enough."""
    x0, y0, x1, y1 = cloth.silhouette.bounds
    corners = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
    edges = [Segment(corner, corners[(i + 1) % 4]) for i, corner in enumerate(corners)]
    for edge in sorted(edges, key=lambda edge: -round(edge.length, 3)):
        try:
            drawn = DrawnFold("turn over", "turn", edge.start, edge.end, grip_radius_m)
            line = snapped_line(drawn, cloth.silhouette)
            fold = DrawnFold("turn over", "turn", _rounded(line.start), _rounded(line.end), grip_radius_m)
            return fold_cloth(cloth, snapped_line(fold, cloth.silhouette), "turn", None).cloth, (fold,)
        except FieldError:
            continue
    return None


def _folded(low: float, high: float, place: float, is_low: bool) -> tuple[float, float]:
    """Return the ends of an interval after its lower or its higher part is folded over at a place (m)."""
    return (place, max(high, 2 * place - low)) if is_low else (min(low, 2 * place - high), place)


def _line(axis: int, place: float, is_low: bool) -> Segment:
    """Return the directed line of one coordinate that has the lower part, or the higher one, to its left."""
    if axis == 0:
        return Segment((place, 0.0), (place, 1.0 if is_low else -1.0))
    return Segment((0.0, place), (-1.0 if is_low else 1.0, place))


def _rounded(point: Point2) -> Point2:
    return (round(point[0], _DECIMALS), round(point[1], _DECIMALS))
