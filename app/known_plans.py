"""The ways of folding that a document's plans have taken lately: what may do for the next drawing."""

from collections import OrderedDict
from typing import TypeAlias

from planner.planning.found_plan import FoundPlan
from planner.task.plan import Plan

_MOST = 4

_Way: TypeAlias = tuple[tuple[object, ...], ...]


class KnownPlans:
    """The latest plan of each way, a way being what is done from which station in which order."""

    def __init__(self) -> None:
        """Begin with none."""
        self._plans: OrderedDict[_Way, FoundPlan] = OrderedDict()

    def add(self, found: FoundPlan) -> None:
        """Remember a plan if it is solved, in place of the one before of its way; the way not met for longest goes."""
        if not found.plan.is_solved:
            return
        way = tuple((step.kind, step.fold, step.base.station) for step in found.plan.steps)
        self._plans[way] = found
        self._plans.move_to_end(way)
        while len(self._plans) > _MOST:
            self._plans.popitem(last=False)

    def of(self, plan: Plan | None) -> FoundPlan | None:
        """Return what a plan was found with, if it is remembered."""
        return next((found for found in self._plans.values() if found.plan is plan), None)

    def by_cost(self) -> list[FoundPlan]:
        """Return the plans, the quickest first."""
        return sorted(self._plans.values(), key=lambda found: found.plan.cost_s or 0.0)
