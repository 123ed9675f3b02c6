"""A plan as it was told, and how it is played: all that is kept of one that was made in another process."""

import pickle
from dataclasses import dataclass
from typing import Any

from planner.errors import UnsolvedPlanError
from planner.plan.plan import Plan
from planner.plan.timeline import Timeline


@dataclass(frozen=True, slots=True)
class RecordedPlan:
    """A plan without what it was found with.

    Attributes:
        status: the plan's.
        body: the plan as JSON.
        played: its timeline, pickled; empty unless it is solved. Some 100 kB.
    """

    status: str
    body: dict[str, Any]
    played: bytes

    @staticmethod
    def of(plan: Plan) -> "RecordedPlan":
        """Record a plan."""
        played = pickle.dumps(plan.timeline(), pickle.HIGHEST_PROTOCOL) if plan.is_solved else b""
        return RecordedPlan(plan.status, plan.to_dict(), played)

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as JSON."""
        return self.body

    def timeline(self) -> Timeline:
        """Return what robot and cloth do at every moment; raises `UnsolvedPlanError`."""
        if not self.played:
            raise UnsolvedPlanError(self.status)
        timeline: Timeline = pickle.loads(self.played)
        return timeline
