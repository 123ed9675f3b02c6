"""Find out why there is no plan: what a search met, and what of it proves to be the cause."""

from collections.abc import Iterator

from planner.explain.reasons import reasons_met
from planner.explain.relaxation_sets import confirmed_reasons
from planner.explain.relaxation_trials import RelaxedProblem
from planner.planning.events import Obstacles
from planner.planning.problem import Problem
from planner.planning.trial import Trial, try_folds
from planner.task.reason import Reason

REASONS_WORK_S = 4.0
"""Work of all trials of the causes for one plan (s, see `Budget`)."""


def explained(obstacles: Obstacles) -> Iterator[tuple[Reason, ...]]:
    """Yield the reasons that a search met, and then those that proved true when tried, since trying takes long.

    A reason proves true if removing the cause gives a plan, or at least allows its fold.
    """
    met = reasons_met(obstacles)
    yield met
    budget, tried = obstacles.budget.part(REASONS_WORK_S), list[Problem]()

    def ask(relaxed: RelaxedProblem, folds: int) -> Trial:
        tried.append(relaxed.searched)
        return try_folds(tried[-1], budget, folds, may_collide=relaxed.may_collide)

    try:
        base = RelaxedProblem.of(obstacles.problem)
        yield confirmed_reasons(base, Trial.failed(obstacles), met, ask, lambda: budget.is_over)
    finally:
        for problem in tried:
            problem.context.forget()
