"""What would mend a drawing: changes that take away what is wrong with it first, each tried out.

Whoever proposes a change need not know whether it helps. The changed drawing is solved, and told of is only what took
the problem away; what leaves nothing wrong at all comes before what merely uncovers the next problem.
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
"""More would not be read."""

_OUTLINE = ("outline_unfinished", "edge_too_short", "outline_crosses", "outline_too_small")
"""What is wrong with an outline hides what comes after it in this order, and every fold."""


def mends(draft: Draft) -> tuple[Mend, ...]:
    """What would take the first problem of a drawing away, the best first; empty where nothing is wrong.

    Where nothing else helps, the last step can be taken back, if that led to it.
    """
    if not draft.solution.problems:
        return ()
    return _tried(draft.solution, _proposed(draft.solution)) or _tried(draft.solution, _last_step(draft))


def _tried(solution: Solution, proposed: Iterator[Mend]) -> tuple[Mend, ...]:
    """Those that help, one of each label."""
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
    """Whether a problem is no longer there, and none has come that it would have been hidden by."""
    if problem.code == "unknown_station":
        return all(other.code != problem.code for other in after.problems)
    if problem.code in _OUTLINE:
        worst = after.problems[0].code if after.problems else ""
        return worst not in _OUTLINE or _OUTLINE.index(worst) > _OUTLINE.index(problem.code)
    if problem.fold is None or after.replay is None or len(after.folded) < len(before.folded):
        return False
    fold = before.drawing.folds[problem.fold].id
    return all(other.fold is None or after.drawing.folds[other.fold].id != fold for other in after.problems)
