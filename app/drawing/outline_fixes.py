"""Proposes quick fixes for an outline: corners merged, exchanged or deleted. The caller tries them out.

Crossing edges are uncrossed as by 2-opt for the travelling salesman problem: the corners between the two edges are
visited in reverse. Every exchange shortens the outline, so the exchanges end with no crossing left.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from app.drawing.drawing import Corner, CornerTie, Drawing, EdgeTie, End, Tie
from app.drawing.problem import Problem
from app.drawing.quick_fix import QuickFix
from app.drawing.ring import reordered, ring_of
from planner.cloth.outline import EDGE_MIN_M, crossings
from planner.message import Message

EXCHANGES_MAX = 30
"""Largest number of exchanges; a more entangled outline is left alone."""


def outline_fixes(drawing: Drawing, problem: Problem) -> Iterator[QuickFix]:
    """Yield changes to an invalid outline, the least intrusive first."""
    if problem.code == "edge_too_short":
        yield _merged(drawing)
    elif problem.code == "outline_crosses":
        yield from _straightened(drawing)
        yield from _uncrossed(drawing)
        yield from _without_one(drawing)


def _merged(drawing: Drawing) -> QuickFix:
    """Merge each corner that is too near to its predecessor into it, and move its ties there."""
    kept, merged = [drawing.outline[0]], drawing
    for corner in drawing.outline[1:]:
        if _is_near(corner, kept[-1]):
            merged = _tied_over(merged, corner.id, kept[-1].id)
            kept[-1] = replace(kept[-1], curve=corner.curve)
        else:
            kept.append(corner)
    while len(kept) > 1 and _is_near(kept[-1], kept[0]):
        merged = _tied_over(merged, kept.pop().id, kept[0].id)
    is_one = len(kept) == len(drawing.outline) - 1
    near = Message("merge_near", f"Merge corners nearer than {EDGE_MIN_M * 1000:g} mm", {"nearer_m": EDGE_MIN_M})
    says = Message("merge_two", "Merge the two corners") if is_one else near
    return QuickFix(says, replace(merged, outline=tuple(kept)))


def _is_near(one: Corner, other: Corner) -> bool:
    return math.dist(one.point, other.point) < EDGE_MIN_M


def _tied_over(drawing: Drawing, gone: str, kept: str) -> Drawing:
    """Return the drawing with every tie to one corner moved to another."""

    def tie(old: Tie | None) -> Tie | None:
        match old:
            case CornerTie(corner) if corner == gone:
                return CornerTie(kept)
            case EdgeTie(start, end, fraction) if gone in (start, end):
                start, end = (kept if corner == gone else corner for corner in (start, end))
                return CornerTie(kept) if start == end else EdgeTie(start, end, fraction)
        return old

    def over(end: End) -> End:
        return replace(end, tie=tie(end.tie))

    folds = tuple(replace(fold, start=over(fold.start), end=over(fold.end)) for fold in drawing.folds)
    return replace(drawing, folds=folds)


def _uncrossed(drawing: Drawing) -> Iterator[QuickFix]:
    """Yield outlines with corners exchanged until no edges cross; stop after `EXCHANGES_MAX`.

    Folds are tied to corners and to the edges between them. So there are several results: the corners keep their
    positions
    and change their order, or keep their order and swap positions, along the shorter or the longer stretch of the
    outline.
    """
    for are_many, is_order_kept in ((False, False), (False, True), (True, True)):
        outline = drawing.outline
        turned: list[int] = []
        while len(turned) < EXCHANGES_MAX and (pair := _first_crossing(outline)):
            outline, count = _exchanged(outline, *pair, are_many=are_many)
            turned.append(min(count, len(outline) - count))
        if is_order_kept:
            places = zip(drawing.outline, outline, strict=True)
            outline = tuple(replace(corner, point=there.point) for corner, there in places)
        else:
            outline = reordered(outline, drawing.outline)
        two, many = Message("exchange_two", "Exchange the two corners"), Message("uncross", "Uncross the edges")
        says = two if turned == [2] else many
        yield QuickFix(says, replace(drawing, outline=outline))


def _first_crossing(outline: Sequence[Corner]) -> tuple[int, int] | None:
    points = [corner.point for corner in outline]
    if any(math.dist(point, points[i - 1]) < EDGE_MIN_M for i, point in enumerate(points)):
        return None
    return next(((i, j) for i, j, _ in crossings(points) if 1 < j - i < len(points) - 1), None)


def _exchanged(outline: tuple[Corner, ...], i: int, j: int, *, are_many: bool) -> tuple[tuple[Corner, ...], int]:
    """Return the outline with the corners between two edges in reverse order, and their number.

    Reverse the stretch with fewer corners, or the one with more if `are_many`.
    """
    count = len(outline)
    first, turned = i + 1, j - i
    if (2 * turned > count) != are_many:
        first, turned = j + 1, count - turned
    walk = [outline[(first + step) % count] for step in range(count)]
    walk = [*reversed(walk[:turned]), *walk[turned:]]
    return tuple(walk[(step - first) % count] for step in range(count)), turned


def _straightened(drawing: Drawing) -> Iterator[QuickFix]:
    """Yield the outline with its crossing edges straight, if any of them is curved."""
    edges = _crossing_edges(drawing)
    outline = tuple(replace(corner, curve=None) if i in edges else corner for i, corner in enumerate(drawing.outline))
    if outline != drawing.outline:
        yield QuickFix(Message("straighten", "Straighten the curve"), replace(drawing, outline=outline))


def _crossing_edges(drawing: Drawing) -> set[int]:
    """Return the edges of the outline that cross, by the corner at which they begin."""
    ring = ring_of(drawing.outline)
    return {ring.corner(piece) for i, j, _ in crossings(ring.points) for piece in (i, j)}


def _without_one(drawing: Drawing) -> Iterator[QuickFix]:
    """Yield outlines without one of the corners at a crossing, the shortest outline first."""
    outline = drawing.outline
    at = {(edge + step) % len(outline) for edge in _crossing_edges(drawing) for step in (0, 1)}
    parts = (tuple(corner for corner in outline if corner is not outline[index]) for index in sorted(at))
    left = [reordered(part, outline) for part in parts]
    for fewer in sorted(left, key=_length):
        yield QuickFix(Message("delete_corner", "Delete one corner"), replace(drawing, outline=fewer))


def _length(outline: Sequence[Corner]) -> float:
    return sum(math.dist(corner.point, outline[i - 1].point) for i, corner in enumerate(outline))
