"""A plan: the answer to a task, as data alone."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, Literal

from planner.cloth.garment import Garment
from planner.cloth.layer import Layer
from planner.errors import FieldError, RequestError
from planner.folds.fold_dag import FoldDag
from planner.folds.fold_sequence import FoldSequence, replayed
from planner.geometry.pose import Pose2
from planner.geometry.tolerance import TIME_S
from planner.json_form import STRICT, JsonForm
from planner.task.reason import Reason
from planner.task.scene import Scene
from planner.task.task import Task, require_version
from planner.task.trajectory import Trajectory
from planner.task.world_state import BaseStop, Grip, Holding, WorldState


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


@dataclass(frozen=True, slots=True)
class Statistics:
    """Figures of the search (paper, Table 1).

    Attributes:
        expanded: states expanded.
        explored: successors pushed.
        ik_queries: queries of the exact inverse kinematics, including those for comfort points.
        ik_time_s: time spent in them (s).
        search_time_s: time of the whole search (s), without joint paths.
        joint_time_s: time spent on joint paths (s).
        bound_s: a lower bound on the cost of any plan, whatever the joints can do (s); None when the search ended
            without a plan and had time left.
        ways: candidate steps that were examined; the work of the search, equal on every machine.
        is_cut_short: whether it ended for lack of work, time or states; if not, a longer search finds nothing else.
    """

    __pydantic_config__ = STRICT

    expanded: int
    explored: int
    ik_queries: int
    ik_time_s: float
    search_time_s: float
    joint_time_s: float
    bound_s: float | None
    ways: int = 0
    is_cut_short: bool = False

    def after(self, before: "Statistics") -> "Statistics":
        """Return the sum of these and another search's figures, from which this one went on, with this one's bound."""
        summed = ("expanded", "explored", "ik_queries", "ik_time_s", "search_time_s", "joint_time_s", "ways")
        return replace(self, **{name: getattr(before, name) + getattr(self, name) for name in summed})

    def to_dict(self) -> dict[str, Any]:
        """Return the statistics as JSON."""
        return {name: getattr(self, name) for name in self.__slots__}


VERSION = 1


@dataclass(frozen=True)
class Plan:
    """A plan, or the reasons why there is none.

    Attributes:
        task: the task.
        status: "solved", "infeasible" (a proof that these primitives cannot do it if `is_proven`) or "budget_exceeded".
        steps: the steps in order; empty unless solved.
        trajectory: the motion of robot and cloth; None unless solved.
        reasons: why there is no plan; empty unless infeasible.
        statistics: the figures of the search.
        is_exhaustive: whether nothing was rejected after some tries that more tries might have made possible.
    """

    task: Task
    status: Literal["solved", "infeasible", "budget_exceeded"]
    steps: tuple[PlanStep, ...]
    trajectory: Trajectory | None
    reasons: tuple[Reason, ...]
    statistics: Statistics
    is_exhaustive: bool

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields without the cached values computed from them."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def primitives(self) -> tuple[PlanStep, ...]:
        """The steps, under their name in REST."""
        return self.steps

    @property
    def cost_s(self) -> float | None:
        """The whole duration (s); None unless solved."""
        if not self.is_solved:
            return None
        return self.steps[-1].end_s if self.steps else 0.0

    @property
    def final_placement(self) -> Pose2 | None:
        """The garment frame in the table frame at the end; None unless solved."""
        return self.end.placement if self.is_solved else None

    @property
    def end(self) -> WorldState:
        """The world after the last step."""
        return self.steps[-1].after if self.steps else self.task.start

    @property
    def bound_s(self) -> float | None:
        """A lower bound on the cost of any plan (s); None when infeasible."""
        return self.statistics.bound_s

    @property
    def garment(self) -> Garment:
        """The garment."""
        return self.task.garment

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self.task.scene

    @cached_property
    def sequence(self) -> FoldSequence:
        """The garment's folds made legal, and the cloth after any of them."""
        return replayed(self.garment)

    @property
    def dag(self) -> FoldDag:
        """The Fold-DAG."""
        return self.sequence.dag

    @property
    def final_layers(self) -> tuple[Layer, ...]:
        """The cloth after all folds, bottom to top."""
        return self.sequence.final.layers

    @property
    def is_solved(self) -> bool:
        """Whether there is a plan."""
        return self.status == "solved"

    @property
    def is_proven(self) -> bool:
        """Whether it is proven that no plan is quicker, or that there is no plan at all."""
        if self.cost_s is None or self.bound_s is None:
            return self.status == "infeasible" and self.is_exhaustive
        return self.cost_s <= self.bound_s + TIME_S

    def state_after(self, step: int) -> WorldState:
        """Return the world after one of the steps, counted from 0; -1 is before the first.

        Raises:
            RequestError: the plan has no such step.
        """
        if not -1 <= step < len(self.steps):
            raise RequestError("after_step", f"{step} is not between -1 and {len(self.steps) - 1}")
        return self.task.start if step < 0 else self.steps[step].after

    def answer(self) -> dict[str, Any]:
        """Return the plan in its REST form: without its task and its trajectory."""
        return {
            "status": self.status,
            "cost_s": self.cost_s,
            "primitives": [step.to_dict() for step in self.steps],
            "dag": self.dag.to_dict(),
            "final_layers": [layer.to_dict() for layer in self.final_layers],
            "final_placement": None if self.final_placement is None else self.final_placement.to_dict(),
            "reasons": [reason.to_dict() for reason in self.reasons],
            "statistics": self.statistics.to_dict(),
        }

    def to_dict(self) -> dict[str, Any]:
        """Return the whole plan as JSON: the REST form, and what `from_dict` reads."""
        return {
            "pleat_plan": VERSION,
            "task": self.task.to_dict(),
            **self.answer(),
            "steps": _STEPS.write(self.steps),
            "trajectory": _TRAJECTORIES.write(self.trajectory),
            "is_exhaustive": self.is_exhaustive,
        }

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> "Plan":
        """Return the plan that JSON holds, equal to the one that was written.

        Raises:
            FieldError: names the field, and says what is wrong; also for a field, such as the cost, that follows from
                others and does not agree with them.
        """
        require_version(data, "pleat_plan", VERSION, _FIELDS)
        is_exhaustive = data["is_exhaustive"]
        if not isinstance(is_exhaustive, bool):
            raise RequestError("is_exhaustive", "is neither true nor false")
        plan = Plan(
            _at("task", Task.from_dict, data["task"]),
            _at("status", _STATUSES.read, data["status"]),
            _at("steps", _STEPS.read, data["steps"]),
            _at("trajectory", _TRAJECTORIES.read, data["trajectory"]),
            tuple(_at(f"reasons[{n}]", Reason.from_dict, reason) for n, reason in enumerate(_list(data, "reasons"))),
            _at("statistics", _STATISTICS.read, data["statistics"]),
            is_exhaustive,
        )
        plan.require_whole()
        for name, wanted in plan.answer().items():
            if name != "final_layers" and data[name] != wanted:  # last digits vary by geometry library
                raise RequestError(name, "is not what follows from task and steps")
        return plan

    def require_whole(self) -> None:
        """Raise `RequestError` unless the steps follow one another from the task's start, and there is a trajectory."""
        state, now = self.task.start, 0.0
        for number, step in enumerate(self.steps):
            if step.before != state:
                raise RequestError(f"steps[{number}].before", "differs from the previous step's `after`")
            if abs(step.start_s - now) > TIME_S:
                raise RequestError(f"steps[{number}].start_s", f"is {step.start_s}, the step before it ends at {now}")
            state, now = step.after, step.end_s
        if self.is_solved != (self.trajectory is not None):
            raise RequestError(
                "trajectory",
                "must not be null for a solved plan" if self.is_solved else "must be null unless the plan is solved",
            )


def _list(data: Mapping[str, Any], name: str) -> list[Any]:
    if not isinstance(data[name], list):
        raise RequestError(name, "is not a list")
    return list(data[name])


def _at(name: str, read: Any, data: object) -> Any:  # noqa: ANN401
    try:
        return read(data)
    except FieldError as error:
        raise error.within(name) from None


_STATUSES: JsonForm[Any] = JsonForm(Literal["solved", "infeasible", "budget_exceeded"])  # type: ignore[arg-type]
_STEPS: JsonForm[tuple[PlanStep, ...]] = JsonForm(tuple[PlanStep, ...])
_TRAJECTORIES: JsonForm[Trajectory | None] = JsonForm(Trajectory | None)  # type: ignore[arg-type]
_STATISTICS = JsonForm(Statistics)
_FIELDS = frozenset(
    {
        "task", "status", "cost_s", "primitives", "dag", "final_layers", "final_placement", "reasons", "statistics",
        "steps", "trajectory", "is_exhaustive",
    }
)  # fmt: skip
