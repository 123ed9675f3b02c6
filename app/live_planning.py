"""Plans the versions of a document; runs in a worker, which keeps what was found for the next version.

Usually the plan shown last still works for the new drawing, or a greedy search finds one. Both take much less time than
finding the quickest plan, so the result is shown first, and another if the full search finds one.
"""

import uuid
from collections import OrderedDict
from dataclasses import dataclass, replace
from typing import TypeAlias

from app.store.packed_plan import PackedPlan
from app.worker.process import Caller
from planner import quick_plan
from planner.planning.events import Done
from planner.planning.found_plan import FoundPlan
from planner.planning.plan_search import Hints
from planner.planning.warm_up import compile_kernels
from planner.plans import plan
from planner.robots.load_robot import prepare_robot
from planner.task.plan import Plan
from planner.task.task import TIME_LIMIT_S, Task

_PLANS_MAX = 4
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
        while len(self._plans) > _PLANS_MAX:
            self._plans.popitem(last=False)

    def named(self, name: str) -> FoundPlan | None:
        """Return the plan of a name, if it is remembered."""
        return next((found for known, found in self._plans.values() if known == name), None)

    def by_cost(self) -> list[FoundPlan]:
        """Return the plans, the quickest first."""
        return sorted((found for _, found in self._plans.values()), key=lambda found: found.plan.cost_s or 0.0)


_DOCUMENTS_MAX = 16
"""Number of documents whose plans a worker knows, with what they were found with: 0.3 to 5 MB each (measured)."""


@dataclass(frozen=True, slots=True)
class Compiled:
    """News: the planner is compiled for a robot."""


@dataclass(frozen=True, slots=True)
class Mapped:
    """News: how far the robot's arms are mapped (0 to 1)."""

    share: float


@dataclass(frozen=True, slots=True)
class Found:
    """News: a plan.

    Attributes:
        plan: the plan.
        name: its name in the worker that found it.
        is_final: whether the search has ended.
        packed: the plan, packed, if more search cannot improve it.
    """

    plan: Plan
    name: str
    is_final: bool = False
    packed: PackedPlan | None = None


@dataclass(frozen=True, slots=True)
class Lasting:
    """News: the quick answers have been sent, and the search continues."""


_known: OrderedDict[str, KnownPlans] = OrderedDict()
"""The plans that this process knows, by document."""


def prepare_live(caller: Caller, robot: str) -> None:
    """Compile the kernels and map the robot's arms if nobody has yet, and tell that, and how far it is."""
    compile_kernels(robot)
    caller.tell(Compiled())
    prepare_robot(robot, lambda share: caller.tell(Mapped(share)))


def compile_for(_: Caller, robot: str) -> None:
    """Compile the kernels for a robot into the cache."""
    compile_kernels(robot)


def plan_live(caller: Caller, document: str, task: Task, shown: str | None, work_limit_s: float) -> None:
    """Tell plans for a task, each better than the one before, the quickest at last.

    Args:
        caller: who gets the plans.
        document: the key of the document.
        task: the task.
        shown: the name of the plan on show for it, if any.
        work_limit_s: the limit on the work (s, see `Limits`).
    """
    plans = _plans_of(document)
    known = None if shown is None else plans.named(shown)
    like = [found for found in plans.by_cost() if found.plan.task.robot == task.robot]

    if known is None:
        known = _soon(caller, task, like)
        if known is not None and not caller.should_stop():
            caller.tell(Found(known.plan, _remembered(plans, known)))
    caller.tell(Lasting())
    limits = replace(task.limits, time_limit_s=TIME_LIMIT_S[1], work_limit_s=work_limit_s)
    for event in plan(replace(task, limits=limits), Hints(known, like), should_stop=caller.should_stop):
        if caller.should_stop():
            return
        found, is_final = event.found, isinstance(event, Done)
        is_kept = is_final and not found.plan.statistics.is_cut_short
        packed = PackedPlan.of(found.plan) if is_kept else None
        caller.tell(Found(found.plan, _remembered(plans, found), is_final=is_final, packed=packed))


def _soon(caller: Caller, task: Task, like: list[FoundPlan]) -> FoundPlan | None:
    """Return a plan adapted from known ones with as many folds; None if that does not succeed quickly.

    With another number of folds, a full search usually finds the quickest plan just as soon.
    """
    same = [found for found in like if len(found.plan.garment.folds) == len(task.garment.folds)]
    return quick_plan(task, like=same, should_stop=caller.should_stop) if same else None


def _plans_of(document: str) -> KnownPlans:
    plans = _known.setdefault(document, KnownPlans())
    _known.move_to_end(document)
    while len(_known) > _DOCUMENTS_MAX:
        _known.popitem(last=False)
    return plans


def _remembered(plans: KnownPlans, found: FoundPlan) -> str:
    """Remember a plan, and return the name under which it is known in this process, and in no other."""
    name = uuid.uuid4().hex
    plans.add(name, found)
    return name
