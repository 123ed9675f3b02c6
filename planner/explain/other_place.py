"""Find another place on the table at which a garment can be folded."""

from planner.explain.suggestion import Suggestion
from planner.explain.suggestion_budget import TrialBudget
from planner.explain.suggestion_placement import placements
from planner.explain.suggestion_trial import SuggestionTrial
from planner.planning.budget import Budget
from planner.planning.warm_up import compile_kernels
from planner.task.task import Task

_TRIAL_S = 4.0
"""The most work of the plan at one place (s, see `Budget`)."""


def other_place(task: Task, budget: Budget) -> Suggestion | None:
    """Return the first place found, the nearest first, at which there is a plan; None if there is none in the budget.

    Args:
        task: a task that has no plan where its garment lies.
        budget: the work and the time for all places together.

    Raises:
        FoldError: a fold is not legal on the cloth as the folds before it leave it.
        RequestError: the folds do not allow the task's start, or the robot is unknown.
    """
    compile_kernels(task.robot)
    trials = TrialBudget(budget)
    search = placements(task, None)
    wish = next(search, None)
    while isinstance(wish, SuggestionTrial) and not trials.has_spent(1.0):
        plan = trials.plan(wish.task, _TRIAL_S, by_folds_alone=wish.by_folds_alone)
        try:
            wish = search.send(plan)
        except StopIteration:
            return None
    return wish if isinstance(wish, Suggestion) else None
