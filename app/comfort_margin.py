"""The comfort margin of a task: the largest comfort radius for which there still is a plan, found by planning again."""

from collections.abc import Callable

from planner.task.plan import Plan
from planner.task.task import COMFORT_MAX_M, Task

STEPS = 4
"""Halvings, each a plan: to some millimetres."""


def comfort_margin_m(task: Task, make_plan: Callable[[Task], Plan]) -> float:
    """Return the largest comfort radius, at least the task's, for which there is a plan (m), rounded down.

    Args:
        task: a task that has a plan.
        make_plan: plans a task.
    """
    had, lacking = task.limits.comfort_radius_m, COMFORT_MAX_M
    for _ in range(STEPS):
        middle = 0.5 * (had + lacking)
        had, lacking = (middle, lacking) if make_plan(task.within(middle)).is_solved else (had, middle)
    return had
