"""Remembers the plans that a document had lately, since they may fit its next drawing."""

from collections import OrderedDict
from typing import TypeAlias

from planner.planning.found_plan import FoundPlan
from planner.task.plan import Plan

_MOST = 4
"""Number of plans remembered."""

_Way: TypeAlias = tuple[tuple[object, ...], ...]


class KnownPlans:
    """The latest plan for each sequence of primitives and stations."""

    def __init__(self) -> None:
        """Start empty."""
        self._plans: OrderedDict[_Way, FoundPlan] = OrderedDict()

    def add(self, found: FoundPlan) -> None:
        """Remember a solved plan in place of the previous one with its sequence.

        Drop the sequence added least recently if there are too many.
        """
        if not found.plan.is_solved:
            return
        way = tuple((step.kind, step.fold, step.base.station) for step in found.plan.steps)
        self._plans[way] = found
        self._plans.move_to_end(way)
        while len(self._plans) > _MOST:
            self._plans.popitem(last=False)

    def of(self, plan: Plan | None) -> FoundPlan | None:
        """Return the found plan that holds a plan, if it is remembered."""
        return next((found for found in self._plans.values() if found.plan is plan), None)

    def by_cost(self) -> list[FoundPlan]:
        """Return the plans, the quickest first."""
        return sorted(self._plans.values(), key=lambda found: found.plan.cost_s or 0.0)
