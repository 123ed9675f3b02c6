"""Limit the work of a search for suggestions, and of each of its trials."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import TypeVar

from planner.explain.change import SpentError
from planner.explain.reasons import reasons_met
from planner.planning.budget import Budget
from planner.planning.events import Blocked
from planner.planning.plan_search import Hints, quickest
from planner.planning.problem import Problem
from planner.task.plan import Plan
from planner.task.reason import Reason
from planner.task.task import Task

T = TypeVar("T")

SHORTEST_TRIAL_S = 1.0
"""Least work of a trial (s, see `Budget`); less would cut off most plans just before they are found."""

_TRIALS_LEFT = 6
"""Trials among which the work left is shared out by default."""

_SETTING_UP_S = 0.01
"""Work counted for preparing a request, which replays the folds (s); the planner counts none of it."""


class TrialBudget:
    """Work and time for a series of trials.

    Attributes:
        spent_s: the work done so far (s).
        has_unknown: whether a trial was cut off before its answer was known.
    """

    def __init__(self, whole: Budget) -> None:
        self._whole = whole
        self.spent_s = 0.0
        self.has_unknown = False

    @property
    def is_late(self) -> bool:
        """Whether the time is up, whatever work is left, or the search was told to stop."""
        return self._whole.deadline.is_over

    @property
    def is_stopped(self) -> bool:
        """Whether the search was told to stop."""
        return self._whole.deadline.is_stopped

    def while_left(self, things: Iterable[T], needed_s: float) -> Iterator[T]:
        """Yield things as long as there is time for one more (s); what is left then counts as unknown."""
        for thing in things:
            if self._whole.left_s < needed_s:
                self.has_unknown = True
                return
            yield thing

    def require_time(self, _share: float = 0.0) -> None:
        """Raise `SpentError` once the time is up; what was begun then counts as unknown.

        Progress can be told to it (see `planner.robots.reach_maps`): so the building of maps ends in between.
        """
        if self.is_late:
            self.has_unknown = True
            raise SpentError

    def has_spent(self, share: float) -> bool:
        """Return whether this share of the work has been done, or the time is up."""
        return self.spent_s >= share * self._whole.work_limit_s or self.is_late

    def plan(
        self, task: Task, work_s: float | None = None, *, with_reasons: bool = False, by_folds_alone: bool = False
    ) -> Plan:
        """Plan a task with limited work (s), by default a fraction of what is left, and never more than is left.

        Only where reasons are wanted are more ways tried before the answer is that there is no plan. By folds alone,
        drags by the arms are not looked for. A plan holds firmly if there is such a plan, as that of `make_plan` does:
        this is asked second, since most trials have no plan at all.
        """
        self.spent_s += _SETTING_UP_S
        problem = (
            Problem.of(task, self._whole.deadline).without_arm_drags()
            if by_folds_alone
            else Problem.of(task, self._whole.deadline)
        )
        plan = self._searched(problem, work_s, with_reasons=with_reasons, is_patient=with_reasons)
        if not plan.is_solved:
            return plan
        firm = self._searched(problem.firm(), work_s, with_reasons=False, is_patient=True)
        return firm if firm.is_solved else plan

    def _searched(self, problem: Problem, work_s: float | None, *, with_reasons: bool, is_patient: bool) -> Plan:
        left_s = max(self._whole.work_limit_s - self.spent_s, 0.0)
        wanted_s = max(left_s / _TRIALS_LEFT, SHORTEST_TRIAL_S) if work_s is None else work_s
        part = self._whole.part(min(wanted_s, left_s))
        reasons: tuple[Reason, ...] = ()
        for event in quickest(problem, part, Hints(), is_patient=is_patient):
            plan = event.found.plan
            if with_reasons and isinstance(event, Blocked):
                reasons = reasons_met(event.obstacles)
        self.spent_s += part.spent_s
        self.has_unknown |= plan.status == "budget_exceeded"
        return replace(plan, reasons=reasons)
