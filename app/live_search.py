"""Plans a document in the background while it is being drawn.

Usually the plan shown last still works for the new drawing, or a greedy search finds one. Both take much less time than
finding the quickest plan, so the result is shown first, and replaced if the full search finds another.
"""

import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

from app.known_plans import KnownPlans
from app.store.packed_plan import PackedPlan
from planner import find_plan, quick_plan
from planner.planning.found_plan import FoundPlan
from planner.task.plan import Plan
from planner.task.task import TIME_LIMIT_S, Task

_REMEMBERED = 8
"""Number of tasks whose answers are remembered, packed: 0.1 MB each, as objects 0.3 to 0.7 MB (measured)."""


class Show(Protocol):
    """Shows a plan."""

    def __call__(self, plan: Plan, *, is_final: bool) -> None:
        """Show a plan; a quicker one may follow unless it is final."""


@dataclass(frozen=True, slots=True, eq=False)
class Begun:
    """A search in progress.

    Attributes:
        task: the task.
        remembered: the answer, if it is known already.
        known: a valid plan for the task, or None.
        like: plans for other drawings.
    """

    task: Task
    remembered: PackedPlan | None
    known: FoundPlan | None
    like: list[FoundPlan]


class LiveSearch:
    """Plans one document's drawings, and reuses results from plan to plan. Safe to use from any thread."""

    def __init__(self) -> None:
        """Start without known plans."""
        self._lock = threading.Lock()
        self._known = KnownPlans()
        self._remembered: OrderedDict[Task, PackedPlan] = OrderedDict()

    def find_soon(self, task: Task, shown: Plan | None, show: Show, should_stop: Callable[[], bool]) -> Begun:
        """Start planning a task, and show a plan derived from known ones if that is quick.

        Args:
            task: the task.
            shown: the plan on show for it, if any.
            show: shows a plan.
            should_stop: called often; true ends the search.
        """
        with self._lock:
            remembered, known = self._remembered.get(task), self._known.of(shown)
            like = [found for found in self._known.by_cost() if found.plan.task.robot == task.robot]
        if remembered is None and known is None and not should_stop():
            known = self._quick(task, like, show, should_stop)
        return Begun(task, remembered, known, like)

    def _quick(
        self, task: Task, like: list[FoundPlan], show: Show, should_stop: Callable[[], bool]
    ) -> FoundPlan | None:
        """Show a plan derived from known ones with the same number of folds; return None if there is none soon.

        With another number of folds, a full search usually finds the quickest plan just as soon.
        """
        same = [found for found in like if len(found.plan.garment.folds) == len(task.garment.folds)]
        found = quick_plan(task, like=same, should_stop=should_stop) if same else None
        if found is not None:
            self._tell(found, show, should_stop)
        return found

    def find_quickest(self, begun: Begun, work_limit_s: float, show: Show, should_stop: Callable[[], bool]) -> None:
        """Find and show the quickest plan; show nothing once the search should stop.

        Args:
            begun: the search that `find_soon` started.
            work_limit_s: the limit on the work (s, see `Limits`).
            show: shows a plan.
            should_stop: called often; true ends the search.
        """
        if begun.remembered is not None:
            if not should_stop():
                show(begun.remembered.plan(), is_final=True)
            return
        limits = replace(begun.task.limits, time_limit_s=TIME_LIMIT_S[1], work_limit_s=work_limit_s)
        found = find_plan(
            replace(begun.task, limits=limits),
            known=begun.known,
            like=begun.like,
            on_found=lambda better: self._tell(better, show, should_stop),
            should_stop=should_stop,
        )
        if not should_stop():
            if not found.plan.statistics.is_cut_short:  # more work may improve a plan that was cut short
                self._remember(begun.task, found.plan)
            self._tell(found, show, should_stop, is_final=True)

    def _tell(self, found: FoundPlan, show: Show, should_stop: Callable[[], bool], *, is_final: bool = False) -> None:
        if not should_stop():
            with self._lock:
                self._known.add(found)
            show(found.plan, is_final=is_final)

    def _remember(self, task: Task, plan: Plan) -> None:
        """Remember an answer as a plan alone: what it was found with may take a hundred times the memory."""
        packed = PackedPlan.of(plan)
        with self._lock:
            self._remembered[task] = packed
            while len(self._remembered) > _REMEMBERED:
                self._remembered.popitem(last=False)
