"""The plan of one version of a document, and what the 3D view shows of it."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from app.rehearsal.trace import RunTrace
from planner.motion.timeline import Timeline
from planner.task.plan import Plan
from planner.task.task import Task


@dataclass(frozen=True, eq=False)
class VersionPlan:
    """A plan of a document, with its task and the version that it belongs to.

    Attributes:
        version: the document's version that it belongs to.
        task: the task.
        plan: the plan.
        plan_id: the id under which the plan can be read.
        is_final: whether the search for a better plan has ended.
    """

    version: int
    task: Task
    plan: Plan
    plan_id: str
    is_final: bool = True

    @cached_property
    def body(self) -> dict[str, Any]:
        """The plan as JSON."""
        return self.plan.answer()


@dataclass(frozen=True, slots=True, eq=False)
class ShownPlan:
    """The plan on show, with the trajectory's timeline.

    Attributes:
        version: the document's version that it belongs to.
        plan: the plan.
        timeline: the samples of robot and cloth at every time.
    """

    version: int
    plan: Plan
    timeline: Timeline


@dataclass(frozen=True, slots=True, eq=False)
class Rehearsed:
    """A rehearsed run of a plan.

    Attributes:
        plan: the plan.
        trace: the run.
    """

    plan: Plan
    trace: RunTrace
