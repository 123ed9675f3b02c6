"""Suggest the smallest changes that give a plan where there is none, each proven by its plan.

Every kind of change is a search of its own (see `SuggestionTrial`). The searches take turns, one trial at a time: the
one that has done the least work comes next, so that none starves the others. Changes that a person can make come first,
and assumptions about the world after them. For a request that has a plan, only a better place on the table is
suggested.
"""

from collections.abc import Callable, Generator, Iterator, Sequence
from functools import partial
from typing import TypeAlias

from planner.deadline import ShouldStop
from planner.explain.change import SpentError
from planner.explain.suggestion import Search, Suggestion, SuggestionTrial, TrialBudget
from planner.explain.suggestion_assumption import comforts, frictions, grip_radii, together
from planner.explain.suggestion_drawing import flips, fold_lines, halvings, orders, sizes, splits
from planner.explain.suggestion_placement import placements
from planner.explain.suggestion_robot import robots, stations
from planner.planning.budget import Budget
from planner.planning.warm_up import compile_kernels
from planner.robots.load_robot import needs_maps
from planner.task.plan import Plan
from planner.task.reason import Code
from planner.task.task import Task

MADE_MAX = 3
"""Suggestions of one kind at most."""

ENOUGH_KINDS = 3
"""Kinds of help with which no other robot is looked for."""

Suggestions: TypeAlias = Generator[Suggestion, None, bool]
"""Suggestions as they are found; returns whether of all changes it is known by then if they give a plan."""

_FIRST_PLAN_SHARE = 0.5
"""Share of the work for planning the task itself."""

_CHANGES_SHARE = 0.6
"""Share of the work after which assumptions get their turns."""

_SIZES_SHARE = 0.7
"""Share of the work up to which, where no change has helped by then, smaller sizes are tried before assumptions."""

_OWN_SHARE = 0.75
"""Share of the work that is for the task's own robot, where others may be tried."""

_ROBOT_S = 8.0
"""Time that must be left for another robot to be tried (s): to load one takes seconds, and is no work that counts.

Maps that must be built take longer, and end with the time.
"""

_FOLDS_MAX = 3
"""Folds to blame that changes are tried for."""


def suggestions(
    task: Task,
    *,
    should_stop: ShouldStop | None = None,
    plan: Plan | None = None,
    on_trial: Callable[[SuggestionTrial], None] | None = None,
    other_robots: Sequence[str] = (),
) -> Suggestions:
    """Look for the smallest changes that give a plan, or one change that gives a quicker plan.

    The task is planned before this returns, so that bad input raises here and not while iterating.

    Args:
        task: the task; its limits of time and work are the budget of the whole search, its limit in states that of each
            plan.
        should_stop: polled while searching; true ends the suggestions.
        plan: the answer to the task, where it is known.
        on_trial: called with each change before it is planned.
        other_robots: the names of robots that may fold it, tried at last, and only where few kinds of change help;
            those that need no maps come first.

    Returns:
        The suggestions as they are found, at most `MADE_MAX` of a kind; the generator's return value says whether every
        possible change was tried before the budget was spent, and no trial was cut off before its answer was known.

    Raises:
        FoldError: a fold is not legal on the cloth as the folds before it leave it.
        RequestError: the folds do not allow the task's start, or the robot is unknown.
    """
    compile_kernels(task.robot)
    whole = Budget.of(task.limits.work_limit_s, task.limits.time_limit_s, should_stop)
    budget = TrialBudget(whole)
    known = plan or budget.plan(task, _FIRST_PLAN_SHARE * whole.work_limit_s, with_reasons=True)
    names = () if known.is_solved else sorted(other_robots, key=needs_maps)
    return _searched(task, known, budget, on_trial or (lambda _: None), names)


def _searched(
    task: Task, known: Plan, budget: TrialBudget, on_trial: Callable[[SuggestionTrial], None], names: Sequence[str]
) -> Suggestions:
    """Give every kind of change its turns, and in the end its last word."""
    folds = () if known.is_solved else _blocking(known)
    if known.is_solved:
        changes, assumptions = [_Lane(placements(task, known.cost_s))], []
    else:
        changes = _lanes(
            placements(task, None),
            fold_lines(task, folds),
            splits(task, folds),
            halvings(task, folds),
            flips(task, folds),
            orders(task),
            stations(task),
        )
        assumptions = _lanes(comforts(task), frictions(task, known.reasons), grip_radii(task, folds, known.reasons))
    turns = partial(_by_turns, budget, on_trial)
    own = _OWN_SHARE if names else 1.0
    yield from turns(changes, _CHANGES_SHARE if assumptions else own)
    if not known.is_solved and not any(lane.has_found for lane in changes):
        changes += _lanes(sizes(task))
        yield from turns(changes[-1:], _SIZES_SHARE)
    yield from turns(assumptions, own)
    if assumptions and not any(lane.has_found for lane in assumptions):
        assumptions += _lanes(together(task, folds))
        yield from turns(assumptions, own)
    yield from turns(changes, own)
    if sum(lane.has_found for lane in (*changes, *assumptions)) < ENOUGH_KINDS:
        changes += _lanes(robots(task, budget.while_left(names, _ROBOT_S), budget.require_time))
        yield from turns(changes[-1:], 1.0)
    yield from turns(assumptions, 1.0)
    yield from turns(changes, 1.0)
    lanes = (*changes, *assumptions)
    is_complete = all(lane.is_done for lane in lanes) and not budget.has_unknown
    for lane in () if budget.is_stopped else lanes:
        yield from lane.last_words()
    return is_complete


def _blocking(plan: Plan) -> tuple[int, ...]:
    """Return at most a few folds to blame; folds that only wait for others count only if all of them do."""
    about = [reason for reason in plan.reasons if reason.fold is not None]
    to_blame = [r for r in about if r.code is not Code.WAITS_FOR_FOLD] or about
    folds = {r.fold: None for r in to_blame if r.fold is not None} or range(len(plan.garment.folds))
    return tuple(folds)[:_FOLDS_MAX]


def _lanes(*searches: Search) -> list["_Lane"]:
    return [_Lane(search) for search in searches]


def _by_turns(
    budget: TrialBudget, on_trial: Callable[[SuggestionTrial], None], lanes: Sequence["_Lane"], share: float
) -> Iterator[Suggestion]:
    """Continue the lane that has done the least work, until this share of the budget is spent."""
    while not budget.has_spent(share):
        running = [lane for lane in lanes if not lane.is_done]
        if not running:
            return
        yield from min(running, key=lambda lane: lane.spent_s).go_on(budget, on_trial)


class _Lane:
    """The search of one kind of change, and its work.

    Attributes:
        spent_s: the work that it has done (s).
        is_done: whether it has nothing more to try.
    """

    def __init__(self, search: Search) -> None:
        self.spent_s = 0.0
        self.is_done = False
        self._search = search
        self._trial: SuggestionTrial | None = None
        self._made = 0

    @property
    def has_found(self) -> bool:
        """Whether it has made a suggestion."""
        return self._made > 0

    def go_on(self, budget: TrialBudget, on_trial: Callable[[SuggestionTrial], None]) -> Iterator[Suggestion]:
        """Plan the next trial, and yield each suggestion that results as soon as it is there.

        Between two trials the search may take long, as where the maps of another robot are built.
        """
        if self._trial is None:
            yield from self._resumed(partial(next, self._search))
        if self._trial is not None and not self.is_done:
            on_trial(self._trial)
            begun_s = budget.spent_s
            plan = budget.plan(self._trial.task, by_folds_alone=self._trial.by_folds_alone)
            self.spent_s += budget.spent_s - begun_s
            yield from self._resumed(partial(self._search.send, plan))

    def last_words(self) -> Iterator[Suggestion]:
        """Yield the remaining suggestions once no time is left for trials."""
        while self._trial is not None and not self.is_done:
            yield from self._resumed(partial(self._search.throw, SpentError()))

    def _resumed(self, resume: Callable[[], SuggestionTrial | Suggestion]) -> Iterator[Suggestion]:
        """Resume the search, and yield its suggestions until it asks for its next trial."""
        while not self.is_done:
            try:
                wish = resume()
            except (StopIteration, SpentError):
                self.is_done = True
                return
            if isinstance(wish, SuggestionTrial):
                self._trial = wish
                return
            yield wish
            resume = partial(next, self._search)
            self._made += 1
            self.is_done = self._made >= MADE_MAX
