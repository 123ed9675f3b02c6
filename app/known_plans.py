"""The ways of folding that a document's plans have taken lately: what may do for the next drawing."""

from collections import OrderedDict
from typing import TypeAlias

from planner import Plan

_MOST = 4

_Way: TypeAlias = tuple[tuple[object, ...], ...]


class KnownPlans:
    """The latest plan of each way, a way being what is done from which station in which order."""

    def __init__(self) -> None:
        """None yet."""
        self._plans: OrderedDict[_Way, Plan] = OrderedDict()

    def add(self, plan: Plan) -> None:
        """Remember a plan if it is solved, in place of the one before of its way; the way not met for longest goes."""
        if not plan.is_solved:
            return
        way = tuple((one.kind, one.step.details.get("fold"), one.base.station) for one in plan.primitives)
        self._plans[way] = plan
        self._plans.move_to_end(way)
        while len(self._plans) > _MOST:
            self._plans.popitem(last=False)

    def by_cost(self) -> list[Plan]:
        """The plans, the quickest first."""
        return sorted(self._plans.values(), key=lambda plan: plan.cost_s or 0.0)
