"""Finds quick fixes: changes that remove the first problem of a drawing, each of them tried out.

Proposals come from code that need not know whether they help. Each changed drawing is solved, and only those without
the problem are kept. Changes that leave no problem at all come before those that uncover the next one.
"""

from collections.abc import Iterator
from dataclasses import replace

from app.drawing.draft import Draft
from app.drawing.fold_mends import fold_mends
from app.drawing.mend import Mend
from app.drawing.outline_mends import outline_mends
from app.drawing.problem import Problem
from app.drawing.solution import Solution
from app.drawing.solve import solve
from planner.message import Message

MENDS_MAX = 3
"""Largest number of quick fixes shown; people would not read more."""

_OUTLINE = ("outline_unfinished", "edge_too_short", "outline_crosses", "outline_too_small")
"""Codes of outline problems. Each hides those after it in this order, and every problem of a fold."""


def mends(draft: Draft) -> tuple[Mend, ...]:
    """Return the changes that remove the first problem of a drawing, best first; empty if there is no problem.

    If no other change helps, propose undoing the last step, provided that this removes the problem.
    """
    if not draft.solution.problems:
        return ()
    return _tried(draft.solution, _proposed(draft.solution)) or _tried(draft.solution, _last_step(draft))


def _tried(solution: Solution, proposed: Iterator[Mend]) -> tuple[Mend, ...]:
    """Return the proposals that help, one for each label."""
    problem = solution.problems[0]
    tried = [(mend, solve(mend.drawing)) for mend in proposed]
    good = [(mend, after) for mend, after in tried if _is_gone(problem, solution, after)]
    good.sort(key=lambda one: bool(one[1].problems))
    found: dict[str, Mend] = {}
    for mend, _ in good:
        found.setdefault(mend.label, mend)
    return tuple(found.values())[:MENDS_MAX]


def _proposed(solution: Solution) -> Iterator[Mend]:
    problem = solution.problems[0]
    if problem.fold is not None:
        yield from fold_mends(solution, problem)
    elif problem.code == "unknown_station":
        yield _other_start(solution)
    else:
        yield from outline_mends(solution.drawing, problem)


def _other_start(solution: Solution) -> Mend:
    station, _ = solution.drawing.scene.stations[0]
    says = Message("start_at", f"Start at {station.replace('_', ' ')}", {"station": station})
    return Mend(says, replace(solution.drawing, start_station=station))


def _last_step(draft: Draft) -> Iterator[Mend]:
    if draft.history.past:
        step = draft.history.past[-1]
        text = f"Take back \N{LEFT DOUBLE QUOTATION MARK}{step.label}\N{RIGHT DOUBLE QUOTATION MARK}"
        yield Mend(Message("take_back", text, {"step": step.label}), step.drawing)


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
