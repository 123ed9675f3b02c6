"""Comparison of robots: one garment planned for several of them, each at its own table."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from planner.cloth.garment import Garment
from planner.explain.suggestion import Suggestion
from planner.explain.suggestions import suggestions
from planner.planning.robot_task import task_for
from planner.plans import make_plan
from planner.task.plan import Plan
from planner.task.reason import Code
from planner.task.task import COMFORT_MAX_M, Limits, Task

STEPS = 4
"""Halvings, each a plan: to some millimetres."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """A robot's result for a garment.

    Attributes:
        robot: the robot's name.
        plan: its plan, or why there is none.
        margin_m: the tightest margin: the largest comfort radius for which there still is a plan, rounded down (m);
            None without a plan.
        help: the first change found that would give a plan; None where there is one, or none was found.
    """

    robot: str
    plan: Plan
    margin_m: float | None
    help: Suggestion | None

    @property
    def is_cut_short(self) -> bool:
        """Whether the limits ended the search, or the trials of why there is no plan, before all was tried."""
        plan = self.plan
        has_cause = any(reason.is_tried and reason.code is not Code.WAITS_FOR_FOLD for reason in plan.reasons)
        return plan.statistics.is_cut_short or not (plan.is_solved or has_cause)

    def to_dict(self) -> dict[str, Any]:
        """Return the comparison as JSON, without the plan's steps."""
        plan = self.plan
        return {
            "robot": self.robot,
            "status": plan.status,
            "is_cut_short": self.is_cut_short,
            "cost_s": plan.cost_s,
            "bound_s": plan.statistics.bound_s,
            "margin_m": self.margin_m,
            "reasons": [reason.to_dict() for reason in plan.reasons],
            "help": None if self.help is None else self.help.to_dict(),
        }


def compared(garment: Garment, robots: Sequence[str], limits: Limits) -> Iterator[Comparison]:
    """Plan a garment for each robot, at the table and the place that suit it.

    Args:
        garment: the garment.
        robots: the robots, by name or by the path of a card.
        limits: the limits of each plan; as much time again may go into the margin, or into a change that helps.

    Raises:
        FoldError: a fold is not legal.
        RequestError: there is no such robot.
    """
    tasks = [replace(task_for(garment, robot=robot), limits=limits) for robot in robots]
    for robot, task in zip(robots, tasks, strict=True):
        plan = make_plan(task)
        margin_m = _margin_m(task) if plan.is_solved else None
        change = None if plan.is_solved else next(suggestions(task, plan=plan), None)
        yield Comparison(robot, plan, margin_m, change)


def _margin_m(task: Task) -> float:
    share = replace(task.limits, time_limit_s=max(task.limits.time_limit_s / STEPS, 0.01))
    return comfort_margin_m(replace(task, limits=share), make_plan)


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
