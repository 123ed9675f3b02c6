"""Where there is no plan: the smallest changes that give one, each planned to prove it.

Every kind of change is a search of its own (see `suggestion_trial`). They take turns, one trial at a time: the next
is whichever has done least work so far, so that none starves the others. What a person can change comes first, and
assumptions about the world after it. A request that has a plan is only told of a better place on the table.
"""

from collections.abc import Callable, Generator, Iterator, Sequence
from typing import TypeAlias

from planner.explain.suggestion import Suggestion
from planner.explain.suggestion_assumption import comforts, frictions, grip_radii
from planner.explain.suggestion_budget import TrialBudget
from planner.explain.suggestion_fold_line import fold_lines
from planner.explain.suggestion_order import orders
from planner.explain.suggestion_placement import placements
from planner.explain.suggestion_station import stations
from planner.explain.suggestion_trial import Search, Trial
from planner.planning.budget import Budget
from planner.planning.warm_up import compile_kernels
from planner.task.plan import Plan
from planner.task.reason import Code
from planner.task.task import Task

TOLD_MAX = 3
"""So many suggestions of one kind at most."""

Suggestions: TypeAlias = Generator[Suggestion, None, bool]
"""Suggestions as they are found, and whether all changes were tried before the budget was spent."""

_FIRST_PLAN_SHARE = 0.5
_CHANGES_SHARE = 0.6
_FOLDS_MAX = 3


def suggestions(task: Task, *, should_stop: Callable[[], bool] | None = None, plan: Plan | None = None) -> Suggestions:
    """Look for the smallest changes that give a plan, or one change that gives a quicker plan.

    The task is planned before this returns, so that bad input raises here and not while iterating.

    Args:
        task: what is to be planned; its limits of time and work are the budget of the whole search, its limit in
            states that of each plan.
        should_stop: asked while searching; true ends the suggestions.
        plan: the answer to the task, where it is known.

    Returns:
        The suggestions as they are found, at most `TOLD_MAX` of a kind; in the end whether every change that could
        have been tried was, before the budget was spent.

    Raises:
        FoldError: a fold is not legal on the cloth as it is then.
        RequestError: the task's start is none that its folds allow, or there is no such robot.
    """
    compile_kernels()
    whole = Budget.of(task.limits.work_limit_s, task.limits.time_limit_s, should_stop)
    budget = TrialBudget(whole)
    known = plan or budget.plan(task, _FIRST_PLAN_SHARE * whole.work_limit_s, with_reasons=True)
    return _searched(task, known, budget)


def _searched(task: Task, known: Plan, budget: TrialBudget) -> Suggestions:
    """Let every kind of change have its turns, and in the end its last word."""
    if known.is_solved:
        changes, assumptions = [_Lane(placements(task, known.cost_s))], []
    else:
        folds = _blocking(known)
        changes = _lanes(fold_lines(task, folds), placements(task, None), orders(task), stations(task))
        assumptions = _lanes(comforts(task), frictions(task, known.reasons), grip_radii(task, folds, known.reasons))
    yield from _by_turns(changes, budget, _CHANGES_SHARE if assumptions else 1.0)
    yield from _by_turns(assumptions, budget, 1.0)
    yield from _by_turns(changes, budget, 1.0)
    lanes = (*changes, *assumptions)
    is_complete = all(lane.is_done for lane in lanes)
    for lane in () if budget.is_stopped else lanes:
        yield from lane.last_words()
    return is_complete


def _blocking(plan: Plan) -> tuple[int, ...]:
    """The folds to blame, a few at most; those that merely wait for others only if there is nobody else."""
    about = [reason for reason in plan.reasons if reason.fold is not None]
    to_blame = [r for r in about if r.code is not Code.WAITS_FOR_FOLD] or about
    folds = {r.fold: None for r in to_blame if r.fold is not None} or range(len(plan.garment.folds))
    return tuple(folds)[:_FOLDS_MAX]


def _lanes(*searches: Search) -> list["_Lane"]:
    return [_Lane(search) for search in searches]


def _by_turns(lanes: Sequence["_Lane"], budget: TrialBudget, share: float) -> Iterator[Suggestion]:
    """Let the lane that has done least work go on, until this share of the budget is gone."""
    while not budget.has_spent(share):
        running = [lane for lane in lanes if not lane.is_done]
        if not running:
            return
        yield from min(running, key=lambda lane: lane.spent_s).go_on(budget)


class _Lane:
    """One kind's search, and what it has used.

    Attributes:
        spent_s: the work that it has done (s).
        is_done: whether it has nothing more to try.
    """

    def __init__(self, search: Search) -> None:
        self.spent_s = 0.0
        self.is_done = False
        self._search = search
        self._trial: Trial | None = None
        self._told = 0

    def go_on(self, budget: TrialBudget) -> Iterator[Suggestion]:
        """Have the next trial planned, and tell what it was good for."""
        begun_s = budget.spent_s
        found = [] if self._trial is not None else list(self._told_of(None))
        if self._trial is not None and not self.is_done:
            found += self._told_of(budget.plan(self._trial.task))
        self.spent_s += budget.spent_s - begun_s
        yield from found

    def last_words(self) -> Iterator[Suggestion]:
        """What it can still tell when there is no time for trials."""
        while self._trial is not None and not self.is_done:
            yield from self._told_of(None)

    def _told_of(self, plan: Plan | None) -> Iterator[Suggestion]:
        """Answer the search; what it tells before it wants its next trial."""
        while not self.is_done:
            try:
                wish = self._search.send(plan)
            except StopIteration:
                self.is_done = True
                return
            if isinstance(wish, Trial):
                self._trial = wish
                return
            yield wish
            plan = None
            self._told += 1
            self.is_done = self._told >= TOLD_MAX
