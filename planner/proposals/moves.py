"""The moves that people fold by: in half, in thirds, sides in, flaps in. A move is one fold or several.

Lines run along the axes of the garment frame, or, for flaps and edges that are slanted, through corners and along the
bisector of two edges. The part that moves is the smaller one, so it lands on the other as far as it can.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations
from typing import TypeAlias

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.fold_kinds import FOLD_KINDS, FoldName
from planner.cloth.garment import DrawnFold
from planner.errors import FieldError
from planner.folds.fold import snapped_line
from planner.folds.fold_cloth import fold_cloth
from planner.geometry.chord import chords
from planner.geometry.isometry import Isometry
from planner.geometry.pose import BoolArray, FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.split import split_along
from planner.geometry.tolerance import ANGLE_RAD, AREA_M2, LENGTH_M, SNAP_M
from planner.proposals.target import TOLERANCE_M, Sides

_DECIMALS = 6
"""Decimals of a fold's ends (m): the grid on which cloth lies."""

PARTS = (("left", "right"), ("bottom", "top"))
"""The parts of lower and of higher coordinates along x and y, by name."""

_EASY_SWING_M, _SWING_EFFORT_PER_M = 0.4, 2.0
"""How far from its line cloth may reach that is folded easily (m), and the effort of what reaches further."""

_EDGE_MIN_M, _EDGES_MAX = 0.08, 6
"""The shortest edge that is folded onto another (m), and the most edges that are, the longest ones."""

_ROLL_MIN_M = 0.05
"""The narrowest turns of a roll (m)."""

SLANTED = 2
"""The axis of moves whose lines are not along the axes."""

Bounds: TypeAlias = tuple[float, float, float, float]
"""The smallest and largest coordinates: x, y, x, y (m)."""

Place: TypeAlias = tuple[float, bool]
"""The coordinate of a line across an axis (m), and whether the part of lower coordinates moves."""


@dataclass(frozen=True, slots=True)
class Crease:
    """A line of a move.

    Attributes:
        name: names its folds.
        line: the directed line, of which the left moves.
        kind: the kind of its folds: "blue", or "red" for a part of what the crease before it has moved.
        is_chord: whether cloth is folded between the line's ends only; otherwise wherever the line crosses it.
    """

    name: str
    line: Segment
    kind: FoldName = "blue"
    is_chord: bool = False


@dataclass(frozen=True, slots=True)
class Move:
    """Folds that people make in one go.

    Attributes:
        kind: what is done; moves of a kind along an axis are alike.
        axis: the coordinate that its lines have in common: 0 for x, 1 for y; `SLANTED`.
        effort: how much less natural it is than others, 1 for what everybody does; wide swings take more, arms being
            short.
        size_m: the sides of the silhouette afterwards (m): at most, if no cloth is in its way.
        creases: its lines, in order.
    """

    kind: str
    axis: int
    effort: float
    size_m: Sides
    creases: tuple[Crease, ...]


def inward_moves(bounds: Bounds, sides_m: Iterable[float]) -> Iterator[Move]:
    """Yield the moves that bring a silhouette nearer to a target with such sides (m), from its bounds."""
    for axis in (0, 1):
        low, high = bounds[axis], bounds[axis + 2]
        extent, middle = high - low, (low + high) / 2
        sides = sorted({side for side in sides_m if extent > side + TOLERANCE_M})
        if not sides:
            continue
        move, third = partial(_across, bounds, axis), extent / 3
        for is_low in (True, False):
            yield move("half", 1.0, "half", (middle, is_low))
            if extent > 2 * _EASY_SWING_M:  # a quarter first, and on with it: no arm swings so wide as for the half
                quarter = low + extent / 4 if is_low else high - extent / 4
                yield move("quarters", 1.0, "side", (quarter, is_low), (middle, is_low))
        yield move("thirds", 1.0, "third", (low + third, True), (high - third, False))
        yield move("roll", 1.1, "third", (low + third, True), (high - third, True))
        yield move("roll", 1.1, "third", (high - third, False), (low + third, False))
        for side in filter(None, sides):
            left, right = middle - side / 2, middle + side / 2
            if extent <= 3 * side + TOLERANCE_M:
                yield move("sides", 1.05, "side", (left, True), (right, False))
            elif extent <= 5 * side:
                yield move("sides", 1.9, "side", (left, True), (right, False), tucks=(right, left))
            cut = min(side, extent - side)
            if cut < extent / 2 - SNAP_M:
                yield move("side", 1.5, "side", (low + cut, True))
                yield move("side", 1.5, "side", (high - cut, False))


def roll_moves(bounds: Bounds) -> Iterator[tuple[float, Move]]:
    """Yield how wide a roll is (m) and the move that rolls up a silhouette, from its bounds: turns of one width."""
    for axis in (0, 1):
        low, extent = bounds[axis], bounds[axis + 2] - bounds[axis]
        for parts in range(3, int(extent / _ROLL_MIN_M) + 1):
            width = extent / parts
            turns = [low + width * number for number in range(1, parts)]
            for places in ([(turn, True) for turn in turns], [(turn, False) for turn in reversed(turns)]):
                yield width, _across(bounds, axis, f"roll of {parts}", 1.0, "roll", *places)


def flap_moves(silhouette: Region) -> Iterator[Move]:
    """Yield the moves that fold flaps in: along lines through corners that point inwards, as pairs where they are."""
    inward = np.concatenate([ring[is_inward(ring)] for ring in silhouette.shapes])
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
                yield _across(silhouette.bounds, axis, "flap", 1.3, "flap", (place, place < middle))
            elif place < middle:
                yield _across(silhouette.bounds, axis, "flaps", 0.5, "flap", (place, True), (other[0], False))


def slanted_moves(silhouette: Region) -> Iterator[Move]:
    """Yield the moves along slanted lines that make a silhouette smaller.

    They fold in a flap, along a line from a corner that points inwards to another corner, or two flaps that mirror each
    other, or an edge onto another one.
    """
    flaps = [Crease("flap", line, is_chord=True) for line in _slanted_chords(silhouette)]
    x0, y0, x1, y1 = silhouette.bounds
    for number, flap in enumerate(flaps):
        yield from _slanted(silhouette, "flap", 1.3, flap)
        for axis, sum_m in ((0, x0 + x1), (1, y0 + y1)):
            mirrored = _mirrored(flap.line, axis, sum_m)
            for other in flaps[number + 1 :]:
                if _is_same(other.line, mirrored) and flap.line.meeting_point(other.line) is None:
                    yield from _slanted(silhouette, "flaps", 0.5, flap, other)
    for line in _bisectors(silhouette):
        yield from _slanted(silhouette, "edges", 1.2, Crease("edge", line))


def carried_out(cloth: ClothState, move: Move, grip_radius_m: float) -> tuple[ClothState, tuple[DrawnFold, ...]] | None:
    """Return the stack after a move and the folds that it takes; None if one is not legal or hardly a line.

    Where a line crosses the silhouette several times, each stretch is a fold of its own.
    """
    folds: list[DrawnFold] = []
    line: Segment | None = None
    for crease in move.creases:
        kind = FOLD_KINDS[crease.kind]
        stretches = [crease.line] if crease.is_chord else _stretches(kind.silhouette(cloth), crease.line)
        if kind.is_red and len(stretches) > 1:  # the second would take what the first has moved
            return None
        for chord in stretches:
            try:
                fold = DrawnFold(crease.name, kind.name, rounded(chord.start), rounded(chord.end), grip_radius_m)
                before, line = line, snapped_line(fold, kind.silhouette(cloth))
                cloth = fold_cloth(cloth, line, kind.name, before if kind.is_red else None).cloth
            except FieldError:
                return None
            folds.append(fold)
    return (cloth, tuple(folds)) if folds else None


def turned_over(cloth: ClothState, grip_radius_m: float) -> Iterator[tuple[ClothState, DrawnFold]]:
    """Yield the stack turned over each of its sides that is long enough, and the fold, the longest side first."""
    x0, y0, x1, y1 = cloth.silhouette.bounds
    corners = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
    edges = [Segment(corner, corners[(i + 1) % 4]) for i, corner in enumerate(corners)]
    for edge in sorted(edges, key=lambda edge: -round(edge.length, 3)):
        try:
            drawn = DrawnFold("turn over", "turn", edge.start, edge.end, grip_radius_m)
            line = snapped_line(drawn, cloth.silhouette)
            fold = DrawnFold("turn over", "turn", rounded(line.start), rounded(line.end), grip_radius_m)
            yield fold_cloth(cloth, snapped_line(fold, cloth.silhouette), "turn", None).cloth, fold
        except FieldError:
            continue


def _across(
    bounds: Bounds, axis: int, kind: str, effort: float, noun: str, *places: Place, tucks: Sequence[float] = ()
) -> Move:
    """Return a move along lines across an axis.

    Args:
        bounds: the silhouette's bounds.
        axis: the axis.
        kind: what is done.
        effort: its effort without wide swings.
        noun: the part that each fold moves.
        places: the lines.
        tucks: for each line the coordinate beyond which what it moved is folded back (m); none if empty.
    """
    low, high = bounds[axis], bounds[axis + 2]
    creases: list[Crease] = []
    for number, (place, is_low) in enumerate(places):
        part = PARTS[axis][not is_low]
        effort += _swing_effort(place - low if is_low else high - place)
        creases.append(Crease(f"{part} {noun}", line_across(axis, place, is_low)))
        before, (low, high) = (low, high), _folded(low, high, place, is_low)
        if tucks:
            creases.append(Crease(f"{part} {noun} back", line_across(axis, tucks[number], not is_low), "red"))
            low, high = (low, max(tucks[number], before[1])) if is_low else (min(tucks[number], before[0]), high)
    across = bounds[3 - axis] - bounds[1 - axis]
    return Move(kind, axis, effort, (high - low, across) if axis == 0 else (across, high - low), tuple(creases))


def _slanted(silhouette: Region, kind: str, effort: float, *creases: Crease) -> Iterator[Move]:
    """Yield a move along slanted lines if it makes the silhouette smaller."""
    stays, landed = silhouette, list[Region]()
    for crease in creases:
        parts = split_along(stays, crease.line) if crease.is_chord else stays.parted_by(crease.line)
        if parts is None:
            return
        moves, stays = parts
        landed.append(moves.moved(Isometry.reflection(crease.line)))
        effort += _swing_effort(float(crease.line.left_distances(moves.coordinates).max(initial=0.0)))
    before_m, size_m = _size(silhouette), _size(Region.union([stays, *landed]))
    if size_m[0] * size_m[1] < (before_m[0] - TOLERANCE_M) * before_m[1]:
        yield Move(kind, SLANTED, effort, size_m, creases)


def _slanted_chords(silhouette: Region) -> Iterator[Segment]:
    """Yield the slanted lines from a corner that points inwards to another corner, the smaller part to their left."""
    for ring in silhouette.shapes:
        inward = {(x, y) for x, y in ring[is_inward(ring)].tolist()}
        corners = [(x, y) for x, y in ring.tolist()]
        for i, j in combinations(range(len(corners)), 2):
            start, end = corners[i], corners[j]
            if not inward & {start, end} or min(j - i, len(corners) - j + i) < 2 or _is_along_axis(start, end):
                continue
            line = Segment(start, end)
            if silhouette.contains_segment(line) and (parts := split_along(silhouette, line)) is not None:
                yield line if parts[0].area <= parts[1].area else line.reversed


def _bisectors(silhouette: Region) -> Iterator[Segment]:
    """Yield the slanted lines over which an edge of the hull lands along another; the smaller part is to their left."""
    hull = [(x, y) for x, y in silhouette.hull.tolist()]
    edges = [Segment(*ends) for ends in zip(hull, [*hull[1:], hull[0]], strict=True)]
    longest = sorted((edge for edge in edges if edge.length >= _EDGE_MIN_M), key=lambda edge: -edge.length)[:_EDGES_MAX]
    for one, other in combinations(longest, 2):
        line = _bisector(one, other)
        if line is None or _is_along_axis(line.start, line.end):
            continue
        areas = [part.area for part in silhouette.parted_by(line)]
        if min(areas) > AREA_M2:
            yield line if areas[0] <= areas[1] else line.reversed


def _bisector(one: Segment, other: Segment) -> Segment | None:
    """Return the line whose points are as far inside one edge of a hull as inside another; None if they make one line.

    A point p is that where n1 . (p - a1) = n2 . (p - a2), with the normals n and a point a of each edge.
    """
    first, second = np.array(one.left), np.array(other.left)
    normal = first - second
    length = float(np.hypot(*normal))
    if length <= ANGLE_RAD:
        return None
    offset = float(first @ np.array(one.start) - second @ np.array(other.start))
    x, y = (offset / length**2 * normal).tolist()
    ux, uy = (normal / length).tolist()
    return Segment((x, y), (x - uy, y + ux))


def _mirrored(line: Segment, axis: int, sum_m: float) -> Segment:
    """Return a line mirrored at half a coordinate (m), with the mirror image of its left to its left."""
    start, end = ((sum_m - x, y) if axis == 0 else (x, sum_m - y) for x, y in (line.end, line.start))
    return Segment(start, end)


def _is_same(one: Segment, other: Segment) -> bool:
    return math.dist(one.start, other.start) <= SNAP_M and math.dist(one.end, other.end) <= SNAP_M


def _is_along_axis(start: Point2, end: Point2) -> bool:
    """Return whether a line runs along an axis, to the distance at which ends are snapped."""
    return min(abs(start[0] - end[0]), abs(start[1] - end[1])) <= SNAP_M


def is_inward(ring: FloatArray) -> BoolArray:
    """Return which corners of a counter-clockwise ring point inwards, shape (n,)."""
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    return np.asarray(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] < 0.0)


def _stretches(silhouette: Region, line: Segment) -> list[Segment]:
    """Return the chords on a line, those as one that meet in a corner."""
    found: list[Segment] = []
    for chord in chords(silhouette, line):
        if found and math.dist(found[-1].end, chord.start) <= LENGTH_M:
            found[-1] = Segment(found[-1].start, chord.end)
        else:
            found.append(chord)
    return found


def _swing_effort(swing_m: float) -> float:
    """Return the effort of cloth that reaches so far from its line (m)."""
    return _SWING_EFFORT_PER_M * max(0.0, swing_m - _EASY_SWING_M)


def _size(region: Region) -> Sides:
    x0, y0, x1, y1 = region.bounds
    return (x1 - x0, y1 - y0)


def _folded(low: float, high: float, place: float, is_low: bool) -> tuple[float, float]:
    """Return the ends of an interval after its lower or its higher part is folded over at a place (m)."""
    return (place, max(high, 2 * place - low)) if is_low else (min(low, 2 * place - high), place)


def line_across(axis: int, place: float, is_low: bool = True) -> Segment:
    """Return the directed line of one coordinate that has the lower part, or the higher one, to its left."""
    if axis == 0:
        return Segment((place, 0.0), (place, 1.0 if is_low else -1.0))
    return Segment((0.0, place), (-1.0 if is_low else 1.0, place))


def rounded(point: Point2) -> Point2:
    """Return a fold's end on the grid on which cloth lies (m)."""
    return (round(point[0], _DECIMALS), round(point[1], _DECIMALS))
