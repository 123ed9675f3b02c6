"""A step of a plan: one primitive, with the world before and after it."""

from dataclasses import dataclass
from typing import Any

from planner.json_form import STRICT
from planner.task.grip import BaseStop, Grip, Holding
from planner.task.world_state import WorldState


@dataclass(frozen=True, slots=True)
class PlanStep:
    """A step of a plan: a primitive with its states.

    Attributes:
        kind: the primitive's name, as "fold" or "move".
        start_s: the time of its start (s).
        duration_s: its duration (s): the cost model's, or longer if the joints are slower.
        details: the fields of its kind alone, as JSON: the fold, the distance, the stations.
        base: where it leaves the base.
        grips: the paths of the tools, from the leftmost arm to the rightmost.
        before: the world at its start.
        after: the world at its end.
        holdings: the grip of each arm, and the vertices it holds.
    """

    __pydantic_config__ = STRICT

    kind: str
    start_s: float
    duration_s: float
    details: dict[str, Any]
    base: BaseStop
    grips: tuple[Grip, ...]
    before: WorldState
    after: WorldState
    holdings: tuple[Holding, ...] = ()

    @property
    def end_s(self) -> float:
        """The time of its end (s)."""
        return self.start_s + self.duration_s

    @property
    def fold(self) -> int | None:
        """The index of the fold that it makes, if it makes one."""
        return self.details.get("fold")

    def to_dict(self) -> dict[str, Any]:
        """Return the step in its REST form."""
        return {
            "kind": self.kind,
            "start_s": self.start_s,
            "duration_s": self.duration_s,
            **self.details,
            "base": self.base.to_dict(),
            "grips": [grip.to_dict() for grip in self.grips],
        }
