"""A plan found soon: one for a garment that differs a little, adapted as far as it goes, and the rest at one go."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from planner.motion.act import Act, in_turn
from planner.planning.adapted import adapted
from planner.planning.effort import Effort
from planner.planning.found_plan import FoundPlan
from planner.planning.greedy import greedy
from planner.planning.heuristic import arm_time
from planner.planning.problem import Problem
from planner.primitives.state import State


def quickly_planned(problem: Problem, like: Sequence[FoundPlan], is_over: Callable[[], bool]) -> FoundPlan | None:
    """The first of some solved plans that still does, or the longest beginning of one and the rest found greedily.

    Args:
        problem: what is to be planned.
        like: plans for problems like it.
        is_over: asked again and again; true means that there is no time.
    """
    context, effort = problem.context, Effort()
    acts = _acts(problem, like, effort, is_over) if problem.unrest is None else ()
    statistics = effort.statistics(context.reach, arm_time(context)(problem.start))
    context.forget()
    return FoundPlan.of(problem, "solved", in_turn(acts), (), statistics, is_exhaustive=False) if acts else None


def _acts(problem: Problem, like: Sequence[FoundPlan], effort: Effort, is_over: Callable[[], bool]) -> tuple[Act, ...]:
    """All that is to be done; nothing where that was not found."""
    begun: tuple[Act, ...] = ()
    for plan in like:
        found = () if is_over() else adapted(plan, problem, effort)
        if problem.is_goal(_after(problem, found)):
            return found
        begun = max(begun, found, key=lambda acts: _after(problem, acts).done.bit_count())
    rest = greedy(problem, _after(problem, begun), effort, is_over)
    shift = sum(len(act.steps) for act in begun)
    return (*begun, *(replace(act, first=shift + act.first) for act in rest)) if rest else ()


def _after(problem: Problem, acts: Sequence[Act]) -> State:
    return acts[-1].steps[-1].after if acts else problem.start
