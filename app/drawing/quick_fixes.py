"""Finds quick fixes: changes that remove the first problem of a drawing, each of them tried out.

Changes are proposed without knowing whether they help. Each changed drawing is solved, and only those without the
problem are kept. Changes that leave no problem at all come before those that uncover the next one.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from app.drawing.draft import Draft
from app.drawing.drawing import Corner, CornerTie, Crease, Drawing, EdgeTie, End, Tie
from app.drawing.drawing_json import drawing_to_dict
from app.drawing.problem import Problem
from app.drawing.ring import reordered, ring_of
from app.drawing.solution import Solution
from app.drawing.solve import solve
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.outline import EDGE_MIN_M, crossings
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from planner.message import Message

QUICK_FIXES_MAX = 3
"""Largest number of quick fixes shown; people would not read more."""

EXCHANGES_MAX = 30
"""Largest number of exchanges of corners; a more entangled outline is left alone."""

_OUTLINE = ("outline_unfinished", "edge_too_short", "outline_crosses", "outline_too_small")
"""Codes of outline problems. Each hides those after it in this order, and every problem of a fold."""


@dataclass(frozen=True, slots=True)
class QuickFix:
    """A quick fix for a drawing that cannot be planned.

    Attributes:
        says: the change as a message.
        drawing: the drawing after the change, ready to commit.
    """

    says: Message
    drawing: Drawing

    @property
    def label(self) -> str:
        """The change, in words."""
        return self.says.text

    def to_dict(self) -> dict[str, Any]:
        """Return the quick fix as JSON."""
        return {"label": self.label, "says": self.says.to_dict(), "drawing": drawing_to_dict(self.drawing)}


def quick_fixes(draft: Draft) -> tuple[QuickFix, ...]:
    """Return the changes that remove the first problem of a drawing, best first; empty if there is no problem.

    If no other change helps, propose undoing the last step, provided that this removes the problem.
    """
    if not draft.solution.problems:
        return ()
    return _tried(draft.solution, _proposed(draft.solution)) or _tried(draft.solution, _last_step(draft))


def _tried(solution: Solution, proposed: Iterator[QuickFix]) -> tuple[QuickFix, ...]:
    """Return the proposals that help, one for each label."""
    problem = solution.problems[0]
    tried = [(quick_fix, solve(quick_fix.drawing)) for quick_fix in proposed]
    good = [(quick_fix, after) for quick_fix, after in tried if _is_gone(problem, solution, after)]
    good.sort(key=lambda one: bool(one[1].problems))
    found: dict[str, QuickFix] = {}
    for quick_fix, _ in good:
        found.setdefault(quick_fix.label, quick_fix)
    return tuple(found.values())[:QUICK_FIXES_MAX]


def _proposed(solution: Solution) -> Iterator[QuickFix]:
    problem = solution.problems[0]
    if problem.fold is not None:
        yield from _fold_fixes(solution, problem)
    elif problem.code == "unknown_station":
        yield _other_start(solution)
    else:
        yield from _outline_fixes(solution.drawing, problem)


def _other_start(solution: Solution) -> QuickFix:
    station, _ = solution.drawing.scene.stations[0]
    says = Message("start_at", f"Start at {station.replace('_', ' ')}", {"station": station})
    return QuickFix(says, replace(solution.drawing, start_station=station))


def _last_step(draft: Draft) -> Iterator[QuickFix]:
    if draft.history.past:
        step = draft.history.past[-1]
        text = f"Take back \N{LEFT DOUBLE QUOTATION MARK}{step.label}\N{RIGHT DOUBLE QUOTATION MARK}"
        yield QuickFix(Message("take_back", text, {"step": step.label}), step.drawing)


def _is_gone(problem: Problem, before: Solution, after: Solution) -> bool:
    """Return whether a problem has gone, and no problem that would hide it has appeared."""
    if problem.code == "unknown_station":
        return all(other.code != problem.code for other in after.problems)
    if problem.code in _OUTLINE:
        worst = after.problems[0].code if after.problems else ""
        return worst not in _OUTLINE or _OUTLINE.index(worst) > _OUTLINE.index(problem.code)
    if problem.fold is None or after.replay is None or len(after.folded) < len(before.folded):
        return False
    fold = before.drawing.folds[problem.fold].id
    return all(other.fold is None or after.drawing.folds[other.fold].id != fold for other in after.problems)


def _fold_fixes(solution: Solution, problem: Problem) -> Iterator[QuickFix]:
    """Yield changes to the fold that a problem is about, the least intrusive first."""
    assert problem.fold is not None
    drawing, index = solution.drawing, problem.fold
    fold = drawing.folds[index]
    called = f"fold {index} '{fold.name}'"
    blue = Message("make_blue", f"Make {called} blue", {"fold": index})
    colours = [QuickFix(blue, _with(drawing, index, replace(fold, kind="blue")))] if fold.is_red else []
    what = "flap" if fold.is_red else "cloth"
    onto = Message(f"put_onto_{what}", f"Put {called} onto the {what}", {"fold": index})
    moved = [QuickFix(onto, _with(drawing, index, _along(fold, line))) for line in _lines(solution, problem, fold)]
    is_off = problem.code == "fold_off_boundary"
    yield from (*moved, *colours) if is_off else (*colours, *moved)
    yield QuickFix(Message("delete_fold", f"Delete {called}", {"fold": index}), _without(drawing, index))


def _lines(solution: Solution, problem: Problem, fold: Crease) -> Iterator[Segment]:
    """Yield lines near the fold's own that end on the boundary: along it, and between the nearest boundary points."""
    if not problem.lines or (fold.is_red and not solution.folded):
        return
    line = problem.lines[0]
    silhouette = FOLD_KINDS[fold.kind].silhouette(solution.cloths[-1])
    nearest = FOLD_KINDS[fold.kind].nearest(silhouette, line)
    if nearest is not None:
        yield nearest
    (sx, sy), (ex, ey) = silhouette.nearest_boundary_points(np.array([line.start, line.end])).tolist()
    if math.dist((sx, sy), (ex, ey)) > LENGTH_M:
        yield Segment((sx, sy), (ex, ey))


def _along(fold: Crease, line: Segment) -> Crease:
    return replace(fold, start=End(line.start), end=End(line.end))


def _with(drawing: Drawing, index: int, fold: Crease) -> Drawing:
    return replace(drawing, folds=(*drawing.folds[:index], fold, *drawing.folds[index + 1 :]))


def _without(drawing: Drawing, index: int) -> Drawing:
    gone = drawing.folds[index].id
    left = (*drawing.folds[:index], *drawing.folds[index + 1 :])
    return replace(drawing, folds=tuple(replace(fold, twin=None) if fold.twin == gone else fold for fold in left))


def _outline_fixes(drawing: Drawing, problem: Problem) -> Iterator[QuickFix]:
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

    Edges are uncrossed as by 2-opt for the travelling salesman problem: the corners between the two are visited in
    reverse. Every exchange shortens the outline, so the exchanges end with no crossing left.

    Folds are tied to corners and to the edges between them. So there are several results: the corners keep their
    positions and change their order, or keep their order and swap positions, along the shorter or the longer stretch
    of the outline.
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
