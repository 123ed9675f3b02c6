"""Finds quick fixes: changes that remove the first problem of a drawing, each of them tried out.

Proposals come from code that need not know whether they help. Each changed drawing is solved, and only those without
the problem are kept. Changes that leave no problem at all come before those that uncover the next one.
"""

from collections.abc import Iterator
from dataclasses import replace

from app.drawing.draft import Draft
from app.drawing.fold_fixes import fold_fixes
from app.drawing.outline_fixes import outline_fixes
from app.drawing.problem import Problem
from app.drawing.quick_fix import QuickFix
from app.drawing.solution import Solution
from app.drawing.solve import solve
from planner.message import Message

QUICK_FIXES_MAX = 3
"""Largest number of quick fixes shown; people would not read more."""

_OUTLINE = ("outline_unfinished", "edge_too_short", "outline_crosses", "outline_too_small")
"""Codes of outline problems. Each hides those after it in this order, and every problem of a fold."""


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
        yield from fold_fixes(solution, problem)
    elif problem.code == "unknown_station":
        yield _other_start(solution)
    else:
        yield from outline_fixes(solution.drawing, problem)


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
