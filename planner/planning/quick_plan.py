"""Find a plan soon: adapt the plan for a similar garment as far as possible, and complete it with a greedy search."""

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


def quickly_planned(
    problem: Problem, like: Sequence[FoundPlan], is_over: Callable[[], bool], *, is_patient: bool = False
) -> FoundPlan | None:
    """Return a plan adapted from similar ones, completed greedily if need be; None if none was found.

    The first plan whose acts can all be repeated is used as it is. Otherwise the plan of which most folds can be
    repeated is the beginning, and a greedy search finds the rest.

    Args:
        problem: the problem to plan.
        like: plans for similar problems.
        is_over: polled repeatedly; true means that there is no time left.
        is_patient: whether the greedy search gives up later.
    """
    context, effort = problem.context, Effort()
    found = _acts(problem, like, effort, is_over, is_patient=is_patient) if problem.unrest is None else ()
    acts = in_turn(found, problem.maker)
    statistics = effort.statistics(context.reach, arm_time(context)(problem.start))
    context.forget()
    return FoundPlan.of(problem, "solved", acts, (), statistics, is_exhaustive=False) if acts else None


def _acts(
    problem: Problem, like: Sequence[FoundPlan], effort: Effort, is_over: Callable[[], bool], *, is_patient: bool
) -> tuple[Act, ...]:
    """Return all acts to the goal, or none where they were not found."""
    begun: tuple[Act, ...] = ()
    for plan in like:
        found = () if is_over() else adapted(plan, problem, effort)
        if problem.is_goal(_after(problem, found)):
            return found
        begun = max(begun, found, key=lambda acts: _after(problem, acts).done.bit_count())
    rest = greedy(problem, _after(problem, begun), effort, is_over, is_patient=is_patient)
    shift = sum(len(act.steps) for act in begun)
    return (*begun, *(replace(act, first=shift + act.first) for act in rest)) if rest else ()


def _after(problem: Problem, acts: Sequence[Act]) -> State:
    return acts[-1].steps[-1].after if acts else problem.start
