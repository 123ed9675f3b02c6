"""Try whether some folds of a problem can be done at all, not necessarily in the quickest way."""

from dataclasses import dataclass

from planner.cloth.g_state import needed_friction
from planner.planning.budget import Budget
from planner.planning.events import Obstacles
from planner.planning.greedy import WEIGHT, greedy
from planner.planning.heuristic import arm_time
from planner.planning.path_search import PathSearch
from planner.planning.problem import Problem
from planner.planning.search_counters import SearchCounters
from planner.primitives.context import Context
from planner.primitives.primitive import Step
from planner.primitives.state import State
from planner.search.a_star import Outcome

_EXPANDED_MAX, _GLANCE_WORK_S, _TRIAL_WORK_S = 200, 0.4, 1.0
"""States expanded in a trial, and its work: without joint paths, and with them (s, see `Budget`)."""


@dataclass(frozen=True, slots=True, eq=False)
class Trial:
    """The outcome of trying a planning problem.

    Attributes:
        context: the planning context, with the obstacles met.
        states: the states on the path found; None if there is none.
        has_collided: whether some ways are in reach, but the arms touch something on them.
        obstacles: what stood in the way, where no path was found.
    """

    context: Context
    states: tuple[State, ...] | None
    has_collided: bool
    obstacles: Obstacles

    @staticmethod
    def failed(obstacles: Obstacles) -> "Trial":
        """Return the trial of a problem for which no path was found."""
        return Trial(obstacles.problem.context, None, bool(obstacles.rejected), obstacles)

    @property
    def is_possible(self) -> bool:
        """Whether a path was found."""
        return self.states is not None

    @property
    def needed_friction(self) -> float:
        """The least friction coefficient with which the path found would still be possible."""
        context = self.context
        rests = {(state.done, state.place): state for state in self.states or ()}
        found = (
            needed_friction(context.sequence.cloth(s.done), context.table_in_garment(s.offset)) for s in rests.values()
        )
        return max(found, default=0.0)


def try_folds(problem: Problem, budget: Budget, folds: int, *, may_collide: bool) -> Trial:
    """Try whether some folds of a problem can be done, and all folds that they depend on.

    Args:
        problem: the problem to try.
        budget: the time for the trial, whose work is limited here and added to the budget's.
        folds: the folds, as a bit mask.
        may_collide: whether the arms may pass through anything: then it is enough that the places are in reach.
    """
    part = budget.part(0.0)
    search = PathSearch(problem, part, _EXPANDED_MAX, wanted=folds)
    begun_s = part.spent_s
    part.work_limit_s = begun_s + (_GLANCE_WORK_S if may_collide else _TRIAL_WORK_S)
    path = None if problem.stability_violation is not None else _path(search, folds, may_collide=may_collide)
    budget.beside_s += part.spent_s - begun_s
    if path is None:
        return Trial(problem.context, None, search.has_rejected, search.obstacles)
    states = (problem.start, *(step.after for step in path))
    return Trial(problem.context, states, search.has_rejected, Obstacles(problem, part))


def _path(search: PathSearch, folds: int, *, may_collide: bool) -> tuple[Step, ...] | None:
    """Return the steps of some path, validated unless the arms may collide; None if none is found."""
    problem = search.problem
    if may_collide:
        remaining = arm_time(problem.context, folds)
        for _ in search.propose(lambda state: WEIGHT * remaining(state), is_consistent=False):
            pass
    else:
        plan_segments = greedy(problem, problem.start, SearchCounters(), search.budget, folds)
        if plan_segments is not None:
            return tuple(step for plan_segment in plan_segments for step in plan_segment.steps)
        for _ in search.run():
            if search.found:
                break
    return search.path if search.result.outcome is Outcome.SOLVED else None
