"""Remembers the plans that a document had lately, since they may fit its next drawing."""

from collections import OrderedDict
from typing import TypeAlias

from planner.planning.found_plan import FoundPlan

_MOST = 4
"""Number of plans remembered."""

_Way: TypeAlias = tuple[tuple[object, ...], ...]


class KnownPlans:
    """The latest plan for each sequence of primitives and stations."""

    def __init__(self) -> None:
        """Start empty."""
        self._plans: OrderedDict[_Way, tuple[str, FoundPlan]] = OrderedDict()

    def add(self, name: str, found: FoundPlan) -> None:
        """Remember a solved plan by a name, in place of the previous one with its sequence.

        Drop the sequence added least recently if there are too many.
        """
        if not found.plan.is_solved:
            return
        way = tuple((step.kind, step.fold, step.base.station) for step in found.plan.steps)
        self._plans[way] = name, found
        self._plans.move_to_end(way)
        while len(self._plans) > _MOST:
            self._plans.popitem(last=False)

    def named(self, name: str) -> FoundPlan | None:
        """Return the plan of a name, if it is remembered."""
        return next((found for known, found in self._plans.values() if known == name), None)

    def by_cost(self) -> list[FoundPlan]:
        """Return the plans, the quickest first."""
        return sorted((found for _, found in self._plans.values()), key=lambda found: found.plan.cost_s or 0.0)
