"""Find a plan soon: adapt the plan for a similar garment as far as possible, and complete it with a greedy search."""

from collections.abc import Sequence
from dataclasses import replace

from planner.motion.plan_segment import PlanSegment, linked
from planner.planning.adapted import adapted
from planner.planning.budget import Budget
from planner.planning.effort import Effort
from planner.planning.found_plan import FoundPlan
from planner.planning.greedy import greedy
from planner.planning.heuristic import arm_time
from planner.planning.problem import Problem
from planner.primitives.state import State


def quickly_planned(
    problem: Problem, like: Sequence[FoundPlan], budget: Budget, *, is_patient: bool = False
) -> FoundPlan | None:
    """Return a plan adapted from similar ones, completed greedily if need be; None if none was found.

    The first plan whose segments can all be repeated is used as it is. Otherwise the plan of which most folds can be
    repeated is the beginning, and a greedy search finds the rest.

    Args:
        problem: the problem to plan.
        like: plans for similar problems.
        budget: ends the search once it is over.
        is_patient: whether the greedy search gives up later.
    """
    context, effort = problem.context, Effort()
    found = _acts(problem, like, effort, budget, is_patient=is_patient) if problem.unrest is None else ()
    plan_segments = linked(found, problem.maker)
    statistics = effort.statistics(context.reach.memory, arm_time(context)(problem.start))
    context.forget()
    return (
        FoundPlan.of(problem, "solved", plan_segments, (), statistics, is_exhaustive=False) if plan_segments else None
    )


def _acts(
    problem: Problem, like: Sequence[FoundPlan], effort: Effort, budget: Budget, *, is_patient: bool
) -> tuple[PlanSegment, ...]:
    """Return all segments to the goal, or none where they were not found."""
    begun: tuple[PlanSegment, ...] = ()
    for plan in like:
        found = () if budget.is_over else adapted(plan, problem, effort)
        if problem.is_goal(_after(problem, found)):
            return found
        begun = max(begun, found, key=lambda plan_segments: _after(problem, plan_segments).done.bit_count())
    rest = greedy(problem, _after(problem, begun), effort, budget, is_patient=is_patient)
    shift = sum(len(plan_segment.steps) for plan_segment in begun)
    return (*begun, *(replace(plan_segment, first=shift + plan_segment.first) for plan_segment in rest)) if rest else ()


def _after(problem: Problem, plan_segments: Sequence[PlanSegment]) -> State:
    return plan_segments[-1].steps[-1].after if plan_segments else problem.start
