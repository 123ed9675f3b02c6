"""What could mend an outline: corners merged, exchanged or left out. None is tried out here.

Two edges that cross are uncrossed as in a tour of cities: the corners from one to the other are walked the other way
round. Every such exchange makes the outline shorter, so they come to an end, and then nothing crosses.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from app.drawing.drawing import Corner, CornerTie, Drawing, EdgeTie, End, Tie
from app.drawing.mend import Mend
from app.drawing.problem import Problem
from planner.cloth.outline import EDGE_MIN_M, crossings
from planner.message import Message

EXCHANGES_MAX = 30
"""An outline that is more entangled than this is not what anybody meant."""


def outline_mends(drawing: Drawing, problem: Problem) -> Iterator[Mend]:
    """Changes to an outline that is none, what keeps most of it first."""
    if problem.code == "edge_too_short":
        yield _merged(drawing)
    elif problem.code == "outline_crosses":
        yield from _uncrossed(drawing)
        yield from _without_one(drawing)


def _merged(drawing: Drawing) -> Mend:
    """Each corner that is too near to the one before it becomes that one, and what was tied to it stays tied."""
    kept, merged = [drawing.outline[0]], drawing
    for corner in drawing.outline[1:]:
        if _is_near(corner, kept[-1]):
            merged = _tied_over(merged, corner.id, kept[-1].id)
        else:
            kept.append(corner)
    while len(kept) > 1 and _is_near(kept[-1], kept[0]):
        merged = _tied_over(merged, kept.pop().id, kept[0].id)
    is_one = len(kept) == len(drawing.outline) - 1
    near = Message("merge_near", f"Merge corners nearer than {EDGE_MIN_M * 1000:g} mm", {"nearer_m": EDGE_MIN_M})
    says = Message("merge_two", "Merge the two corners") if is_one else near
    return Mend(says, replace(merged, outline=tuple(kept)))


def _is_near(one: Corner, other: Corner) -> bool:
    return math.dist(one.point, other.point) < EDGE_MIN_M


def _tied_over(drawing: Drawing, gone: str, kept: str) -> Drawing:
    """The drawing with all that was tied to one corner tied to another."""

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


def _uncrossed(drawing: Drawing) -> Iterator[Mend]:
    """Corners exchanged until no edges cross; nothing where that does not come to an end.

    Folds hang on corners and on the edges between them. So either the corners stay where they are and come in another
    order, or they keep their order and change places, in the one stretch of the outline or in the other.
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
        two, many = Message("exchange_two", "Exchange the two corners"), Message("uncross", "Uncross the edges")
        says = two if turned == [2] else many
        yield Mend(says, replace(drawing, outline=outline))


def _first_crossing(outline: Sequence[Corner]) -> tuple[int, int] | None:
    points = [corner.point for corner in outline]
    if any(math.dist(point, points[i - 1]) < EDGE_MIN_M for i, point in enumerate(points)):
        return None
    return next(((i, j) for i, j, _ in crossings(points) if 1 < j - i < len(points) - 1), None)


def _exchanged(outline: tuple[Corner, ...], i: int, j: int, *, are_many: bool) -> tuple[tuple[Corner, ...], int]:
    """The outline with the corners from one edge to another walked the other way round, and how many they are.

    Either the stretch between them that has fewer corners or the one that has more.
    """
    count = len(outline)
    first, turned = i + 1, j - i
    if (2 * turned > count) != are_many:
        first, turned = j + 1, count - turned
    walk = [outline[(first + step) % count] for step in range(count)]
    walk = [*reversed(walk[:turned]), *walk[turned:]]
    return tuple(walk[(step - first) % count] for step in range(count)), turned


def _without_one(drawing: Drawing) -> Iterator[Mend]:
    """Each corner at a crossing left out, first the one without which the outline is shortest."""
    outline = drawing.outline
    at = {(edge + step) % len(outline) for i, j, _ in crossings(drawing.points) for edge in (i, j) for step in (0, 1)}
    left = [tuple(corner for corner in outline if corner is not outline[index]) for index in sorted(at)]
    for fewer in sorted(left, key=_length):
        yield Mend(Message("delete_corner", "Delete one corner"), replace(drawing, outline=fewer))


def _length(outline: Sequence[Corner]) -> float:
    return sum(math.dist(corner.point, outline[i - 1].point) for i, corner in enumerate(outline))
