"""The search for a document's plan, as it goes on behind a drawing.

Mostly the plan that was shown last still does, with the new measures, or else some plan is found greedily. That takes
much less time than to find the quickest, so it is shown first, and replaced if the search comes to another.
"""

import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

from app.known_plans import KnownPlans
from planner import find_plan, quick_plan
from planner.planning.found_plan import FoundPlan
from planner.task.plan import Plan
from planner.task.task import TIME_LIMIT_S, Task

_REMEMBERED = 8


class Show(Protocol):
    """Shows a plan."""

    def __call__(self, plan: Plan, *, is_final: bool) -> None:
        """Show a plan; a quicker one may follow unless it is final."""


@dataclass(frozen=True, slots=True, eq=False)
class Begun:
    """A search that has begun.

    Attributes:
        task: what is to be planned.
        remembered: the answer, where it is known from before.
        known: some plan that does.
        like: plans for other drawings.
    """

    task: Task
    remembered: FoundPlan | None
    known: FoundPlan | None
    like: list[FoundPlan]


class LiveSearch:
    """Plans one document's drawings, and keeps what it found from plan to plan. May be used from any thread."""

    def __init__(self) -> None:
        """Begin with nothing known."""
        self._lock = threading.Lock()
        self._known = KnownPlans()
        self._remembered: OrderedDict[Task, FoundPlan] = OrderedDict()

    def find_soon(self, task: Task, shown: Plan | None, show: Show, should_stop: Callable[[], bool]) -> Begun:
        """Begin to plan a task, and show a plan made of those that are known if that goes quickly.

        Args:
            task: the task.
            shown: the plan that is shown for it already, if there is one.
            show: shows a plan.
            should_stop: asked again and again; true ends the search.
        """
        with self._lock:
            remembered, like, known = self._remembered.get(task), self._known.by_cost(), self._known.of(shown)
        if remembered is None and known is None and not should_stop():
            known = self._quick(task, like, show, should_stop)
        return Begun(task, remembered, known, like)

    def _quick(
        self, task: Task, like: list[FoundPlan], show: Show, should_stop: Callable[[], bool]
    ) -> FoundPlan | None:
        """Show a plan made of those that are known for as many folds; None if none was found soon.

        Where there are more folds than before, or fewer, a search tells mostly as soon what is the quickest.
        """
        same = [found for found in like if len(found.plan.garment.folds) == len(task.garment.folds)]
        found = quick_plan(task, like=same, should_stop=should_stop) if same else None
        if found is not None:
            self._tell(found, show, should_stop)
        return found

    def find_quickest(self, begun: Begun, work_limit_s: float, show: Show, should_stop: Callable[[], bool]) -> None:
        """Find and show the quickest plan for what was begun; nothing is shown once the search should stop.

        Args:
            begun: as `find_soon` gave it.
            work_limit_s: how much work may be done (s, see `Limits`).
            show: shows a plan.
            should_stop: asked again and again; true ends the search.
        """
        found = begun.remembered
        if found is None:
            limits = replace(begun.task.limits, time_limit_s=TIME_LIMIT_S[1], work_limit_s=work_limit_s)
            found = find_plan(
                replace(begun.task, limits=limits),
                known=begun.known,
                like=begun.like,
                on_found=lambda better: self._tell(better, show, should_stop),
                should_stop=should_stop,
            )
        if not should_stop():
            if not found.plan.statistics.is_cut_short:  # else with more work there may be a better one
                self._remember(begun.task, found)
            self._tell(found, show, should_stop, is_final=True)

    def _tell(self, found: FoundPlan, show: Show, should_stop: Callable[[], bool], *, is_final: bool = False) -> None:
        if not should_stop():
            with self._lock:
                self._known.add(found)
            show(found.plan, is_final=is_final)

    def _remember(self, task: Task, found: FoundPlan) -> None:
        with self._lock:
            self._remembered[task] = found
            while len(self._remembered) > _REMEMBERED:
                self._remembered.popitem(last=False)
