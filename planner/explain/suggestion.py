"""A suggestion: a change to the request, and the plan that the change makes possible."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from planner.message import Message
from planner.task.plan import Plan

ASSUMPTIONS = frozenset({"friction", "grip_radius", "comfort_radius", "together"})
"""Kinds of suggestions that nobody can carry out: they hold only if the world is kinder than assumed."""


@dataclass(frozen=True, slots=True)
class Suggestion:
    """A change that gives a plan, or a quicker one.

    Attributes:
        kind: "placement", "fold_line", "split", "halve", "flip", "order", "station", "robot", "size",
            "friction", "grip_radius", "comfort_radius" or "together", several of the last three.
        says: what to do, with the numbers; directions as seen by the robot at the near edge of the table.
        change: fields that replace those of the plan request.
        size: the size of the change, for comparing within its kind: m, a count, or a coefficient.
        plan: the plan that proves it.
        cost_s: the cost of that plan (s).
    """

    kind: str
    says: Message
    change: Mapping[str, Any]
    size: float
    plan: Plan
    cost_s: float

    @property
    def message(self) -> str:
        """The change in words, with the cost of its plan."""
        return f"{self.says.text}: {self.cost_s:.1f} s"

    @property
    def is_assumption(self) -> bool:
        """Whether it assumes something about the world instead of changing it."""
        return self.kind in ASSUMPTIONS

    def to_dict(self) -> dict[str, Any]:
        """Return the suggestion as JSON, without its plan."""
        return {
            "kind": self.kind,
            "is_assumption": self.is_assumption,
            "message": self.message,
            "says": self.says.to_dict(),
            "change": dict(self.change),
            "size": self.size,
            "cost_s": self.cost_s,
        }
