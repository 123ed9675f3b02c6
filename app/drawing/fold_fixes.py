"""Proposes quick fixes for an illegal fold: another colour, another line, or its removal. The caller tries them out."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from app.drawing.drawing import Crease, Drawing, End
from app.drawing.problem import Problem
from app.drawing.quick_fix import QuickFix
from app.drawing.solution import Solution
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from planner.message import Message


def fold_fixes(solution: Solution, problem: Problem) -> Iterator[QuickFix]:
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
