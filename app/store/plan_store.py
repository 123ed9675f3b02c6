"""The plans of this server's life, by id; the oldest go when there are more than a thousand."""

import threading
import uuid
from collections import OrderedDict
from dataclasses import dataclass
from typing import Any, Protocol

from planner.errors import FoldingError
from planner.plan.timeline import Timeline

CAPACITY = 1000


@dataclass
class UnknownPlanError(FoldingError):
    """No plan has this id, or it has been dropped."""

    plan_id: str

    def __str__(self) -> str:
        return f"there is no plan with the id {self.plan_id!r}"


class KeptPlan(Protocol):
    """What is asked of a plan that is kept: `Plan` has it, and `RecordedPlan`."""

    @property
    def status(self) -> str:
        """How the search ended."""

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as JSON."""

    def timeline(self) -> Timeline:
        """Return what robot and cloth do at every moment; raises `UnsolvedPlanError`."""


class PlanStore:
    """Keeps the newest plans; may be used from any thread."""

    def __init__(self, capacity: int = CAPACITY) -> None:
        """Empty at first."""
        self._capacity = capacity
        self._plans: OrderedDict[str, KeptPlan] = OrderedDict()
        self._lock = threading.Lock()

    def add(self, plan: KeptPlan) -> str:
        """Keep a plan; returns its id."""
        plan_id = uuid.uuid4().hex
        with self._lock:
            self._plans[plan_id] = plan
            while len(self._plans) > self._capacity:
                self._plans.popitem(last=False)
        return plan_id

    def plan(self, plan_id: str) -> KeptPlan:
        """The plan with this id; raises `UnknownPlanError`."""
        with self._lock:
            if plan_id not in self._plans:
                raise UnknownPlanError(plan_id)
            return self._plans[plan_id]

    def drop(self, plan_id: str) -> None:
        """Keep a plan no longer; one that is not there is no fault."""
        with self._lock:
            self._plans.pop(plan_id, None)
