"""Search for the quickest plan of one problem: an exact search, and the strategies tried meanwhile and after it."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Literal, TypeAlias

from planner.motion.edge_hands import EdgeHands
from planner.motion.plan_segment import PlanSegment, duration_s
from planner.motion.transfer_candidate import MORE_TRANSFERS, THOROUGH
from planner.planning.budget import Budget
from planner.planning.events import Blocked, Done, Event, Improved
from planner.planning.found_plan import FoundPlan
from planner.planning.path_search import PathSearch, Pause
from planner.planning.problem import Problem
from planner.planning.quick_plan import quickly_planned
from planner.planning.restricted_tasks import with_arms_apart, with_more_comfort, with_narrower_cones
from planner.search.a_star import Outcome

GREEDY_AFTER_S, PATIENT_GREEDY_AFTER_S = 1.0, 3.0
"""Work without a plan after which some plan to fall back on is looked for, and again, patiently (s, see `Budget`)."""

LESS_ROOM_AFTER_S = 1.0
"""Work after which a search that found only plans slower than assumed looks at restricted tasks (s, see `Budget`)."""

# A comfort radius below its default is rare, and a larger one then usually pays; a cone that could be narrower is in
# every request.
MORE_COMFORT_SHARE, NARROWER_SHARE = 2.0, 0.5
"""Work on each task with a larger comfort radius, and on all with narrower cones, as a share of earlier work."""

WORTH_SHOWING_S = 0.1
"""Least time by which a plan found meanwhile is quicker than the one shown before (s)."""

APART_SHARE, APART_LEAST_S = 2.0, 0.5
"""Work on the task whose arms stay apart, as a share of earlier work, and the least of it (s)."""

WORTH_THOROUGH = 0.01
"""Share of its cost by which a plan must be above its lower bound so that more tries are made for a quicker one."""

THOROUGH_SHARE = 0.5
"""Work on more tries for each restricted task, as a share of earlier work."""

_Status: TypeAlias = Literal["solved", "infeasible", "budget_exceeded"]


@dataclass(frozen=True, slots=True)
class Hints:
    """What a search may start from.

    Attributes:
        known: a plan for the task; it is the answer unless a quicker one is found.
        like: plans for similar tasks, to fall back on.
        below_s: the cost that a plan has to beat (s); where none does, that is no proof that there is none.
    """

    known: FoundPlan | None = None
    like: Sequence[FoundPlan] = ()
    below_s: float = math.inf

    @property
    def are_bounding(self) -> bool:
        """Whether not every plan is an answer."""
        return self.below_s < math.inf


def quickest(problem: Problem, budget: Budget, hints: Hints, *, is_patient: bool = True) -> Iterator[Event]:
    """Search the quickest plan for a problem.

    Args:
        problem: the problem to plan.
        budget: the work and the time for the search.
        hints: what to start from.
        is_patient: whether to try more ways for each step where the first few gave no plan.

    Yields:
        Plans found meanwhile; where there is no plan, what stood in the way; at last the answer, without reasons.
    """
    search = _PlanSearch(problem, budget, hints, is_patient=is_patient)
    try:
        yield from search.events()
    finally:
        search.forget()


class _PlanSearch:
    """The exact search for one problem, the plan known meanwhile, and the strategies not tried yet."""

    def __init__(self, problem: Problem, budget: Budget, hints: Hints, *, is_patient: bool) -> None:
        self.budget = budget
        self.problem, self._restricted = problem, list[PathSearch]()
        self._known, self._like = hints.known, hints.like
        self._is_patient = is_patient
        self._hands = EdgeHands(problem.context, problem.robot, problem.maker)
        self.exact = PathSearch(problem, budget, problem.task.limits.max_expanded, hands=self._hands)
        self._waiting = [*STRATEGIES]
        self._is_bounded = hints.are_bounding
        known_s = math.inf if self._known is None else self._known.plan.cost_s or 0.0
        self._shown_s = self.exact.known_s = min(known_s, hints.below_s)

    def forget(self) -> None:
        """Drop what the problems' contexts have cached: a plan's steps keep them."""
        for problem in (self.problem, *(search.problem for search in self._restricted)):
            problem.context.forget()

    def events(self) -> Iterator[Event]:
        """Search, and yield what is found meanwhile, and the answer."""
        exact = self.exact
        status: _Status = "budget_exceeded" if self._is_bounded else "infeasible"
        is_cut_short = False
        if self.problem.stability_violation is None:
            yield from self.run(exact.run())
            if exact.result.outcome is Outcome.BUDGET_EXCEEDED and not exact.blocking:
                status, is_cut_short = "budget_exceeded", True
            elif not exact.blocking and self._is_in_doubt and (self._is_patient or exact.found is not None):
                yield from self._tried(Pause.END)
                is_cut_short = self.budget.is_over
        plan_segments = self._known.plan_segments if exact.found is None and self._known else exact.found
        if plan_segments is not None:
            yield Done(self._answer("solved", plan_segments, is_cut_short=is_cut_short, is_last=True))
            return
        if status == "infeasible":
            yield Blocked(self._answer(status, (), is_cut_short=is_cut_short), exact.obstacles)
        # It is made anew, since it counts the queries made meanwhile to find out why.
        yield Done(self._answer(status, (), is_cut_short=is_cut_short or self._is_bounded))

    def run(self, pauses: Iterable[Pause]) -> Iterator[Event]:
        """Run a search; at each pause, try the strategies that are due."""
        for pause in pauses:
            yield from self._tried(pause)

    def _tried(self, pause: Pause) -> Iterator[Event]:
        """Try each strategy that is due and was not tried before, and show what is found."""
        for strategy in tuple(self._waiting):
            events = strategy(self, pause)
            if events is not None:
                self._waiting.remove(strategy)
                yield from events
        if pause is Pause.ROUND:
            yield from self.shown(self.exact.found or ())

    def shown(self, plan_segments: tuple[PlanSegment, ...]) -> Iterator[Event]:
        """Show segments, if any, while the search for quicker ones continues, unless a plan as quick was shown."""
        if plan_segments and duration_s(plan_segments) <= self._shown_s - WORTH_SHOWING_S:
            self._shown_s = duration_s(plan_segments)
            yield Improved(self._answer("solved", plan_segments, is_cut_short=True))

    def fall_back(self, *, is_patient: bool) -> Iterator[Event]:
        """Adapt a known plan, or look for one greedily; the search goes on with it as the known plan."""
        problem = self.budget.watch(self.problem.anew())
        known = quickly_planned(problem, self._like, self.budget, is_patient=is_patient)
        if known is not None:
            self._known, took = known, known.plan.statistics
            self._shown_s = self.exact.known_s = known.plan.cost_s or 0.0
            self.exact.counters.leave_out(took.search_time_s + took.joint_time_s)
            yield Improved(known)

    def restrict(self, problem: Problem, work_s: float) -> float:
        """Look for a quicker plan in a restricted task with limited work (s); return the work done (s).

        The search is left out where no quicker plan can exist, or none is wanted any more.
        """
        is_enough = self.budget.is_strict and self.budget.is_over
        if work_s <= 0.0 or is_enough or not self._is_in_doubt:
            return 0.0
        hands = EdgeHands(problem.context, problem.robot, problem.maker)
        search = PathSearch(problem, self.budget.part(0.0), problem.task.limits.max_expanded, hands=hands)
        self._restricted.append(search)
        return self._quicker(search, search.run(), work_s)

    def _quicker(self, search: PathSearch, pauses: Iterable[Pause], work_s: float) -> float:
        """Run the search of a restricted task with limited work (s); return the work done (s)."""
        search.known_s, search.found = self.exact.known_s, self.exact.found
        begun_s = search.budget.spent_s
        search.budget.work_limit_s = begun_s + work_s
        for _ in pauses:
            pass
        self.exact.found = search.found
        return search.budget.spent_s - begun_s

    def restricted(self) -> Iterator[Event]:
        """Look for a quicker plan with larger comfort radii, and with narrower cones; yield nothing meanwhile."""
        spent_s = self.budget.spent_s
        for problem in with_more_comfort(self.problem):
            self.restrict(problem, MORE_COMFORT_SHARE * spent_s)
        left_s = NARROWER_SHARE * spent_s
        for problem in with_narrower_cones(self.problem):
            left_s -= self.restrict(problem, left_s)
        yield from ()

    def thorough(self) -> Iterator[Event]:
        """Search again with more tries, this task and the restricted ones, as long as that is worth it."""
        for problem in (self.problem, *(search.problem for search in self._restricted)):
            problem.maker.sample_more()
        yield from self.run(self.exact.run_again(THOROUGH, MORE_TRANSFERS))
        for search in self._restricted:
            if self.is_worth_thorough:
                self._quicker(search, search.run_again(THOROUGH, MORE_TRANSFERS), THOROUGH_SHARE * self.budget.spent_s)

    @property
    def _is_in_doubt(self) -> bool:
        """Whether something quicker than the known plan may be among the rejected steps and is worth more tries."""
        return self.exact.has_doubts and self.exact.limit_s > (self.exact.bound_s or 0.0)

    @property
    def is_worth_thorough(self) -> bool:
        """Whether there is no plan, or a quicker one may save so much that more tries are worth their work."""
        least_s = (1.0 - WORTH_THOROUGH) * self.exact.limit_s if self.exact.has_plan else math.inf
        return self.exact.has_doubts and least_s > (self.exact.bound_s or 0.0)

    def _answer(
        self, status: _Status, plan_segments: tuple[PlanSegment, ...], *, is_cut_short: bool, is_last: bool = False
    ) -> FoundPlan:
        """Return an answer; only the last one takes the work to have hands hold edges, which is not counted."""
        exact, known = self.exact, self._known
        bound_s = None if status == "infeasible" else exact.bound_s
        statistics = exact.counters.statistics(self.problem.context.reach.memory, bound_s)
        statistics = replace(statistics, ways=self.budget.ways, is_cut_short=is_cut_short)
        if known is not None:
            statistics = statistics.after(known.plan.statistics)
        is_exhaustive = not is_cut_short and (bool(exact.blocking) or not exact.has_doubts)
        if is_last:
            plan_segments = self._hands.held(plan_segments, self.budget.deadline)
        if known is not None and plan_segments == known.plan_segments:
            return known.with_statistics(self.problem.task, statistics, is_exhaustive=is_exhaustive)
        return FoundPlan.of(self.problem, status, plan_segments, (), statistics, is_exhaustive=is_exhaustive)


Strategy: TypeAlias = Callable[[_PlanSearch, Pause], Iterator[Event] | None]
"""A way to a plan, or to a quicker one, tried once: its events, or None while it is not due.

It is called at each pause of the exact search until it is due.
"""


def _fall_back(search: _PlanSearch, pause: Pause) -> Iterator[Event] | None:
    return search.fall_back(is_patient=False) if _lacks_plan(search, pause, GREEDY_AFTER_S) else None


def _fall_back_patiently(search: _PlanSearch, pause: Pause) -> Iterator[Event] | None:
    return search.fall_back(is_patient=True) if _lacks_plan(search, pause, PATIENT_GREEDY_AFTER_S) else None


def _lacks_plan(search: _PlanSearch, pause: Pause, after_s: float) -> bool:
    """Return whether a search looks on without a plan after some work (s)."""
    return pause is Pause.LOOK and not search.exact.is_settled and search.budget.spent_s >= after_s


def _keep_arms_apart(search: _PlanSearch, pause: Pause) -> Iterator[Event] | None:
    """Allow hands only where the other arm at home leaves room, with limited work, if that is worth it.

    Where a way was rejected, mostly the arms were in each other's way.
    """
    if pause is not Pause.END or not search.exact.has_rejected or not search.is_worth_thorough:
        return None
    for problem in with_arms_apart(search.problem):
        search.restrict(problem, max(APART_LEAST_S, APART_SHARE * search.budget.spent_s))
    return iter(())


def _restrict(search: _PlanSearch, pause: Pause) -> Iterator[Event] | None:
    """Search restricted tasks: with more room, the first few ways tried may all be worse.

    A plan for a restricted task is also a plan for this one.
    """
    is_due = pause is Pause.ROUND and bool(search.exact.found) and search.budget.spent_s > LESS_ROOM_AFTER_S
    if not is_due and pause is not Pause.END:
        return None
    return chain(search.shown(search.exact.found or ()), search.restricted())


def _try_thoroughly(search: _PlanSearch, pause: Pause) -> Iterator[Event] | None:
    """Search again with more tries, if that is worth it.

    A few failures rule a step out, so that a plan that drives round the table is found soon. Ways that were left
    untried may still do without.
    """
    if pause is not Pause.END or not search.is_worth_thorough:
        return None
    return search.thorough()


STRATEGIES: tuple[Strategy, ...] = (
    _fall_back,
    _fall_back_patiently,
    _keep_arms_apart,
    _restrict,
    _try_thoroughly,
)
"""The strategies, in the order in which they are called."""
