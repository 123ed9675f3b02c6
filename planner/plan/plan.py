"""The answer to a planning request."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from planner.cloth.garment import Garment
from planner.cloth.layer import Layer
from planner.errors import UnsolvedPlanError
from planner.folds.fold_dag import FoldDag
from planner.geometry.pose import Pose2
from planner.geometry.tolerance import TIME_S
from planner.plan.act import Act
from planner.plan.film import FilmMaker
from planner.plan.machine import Machine
from planner.plan.problem import Problem
from planner.plan.timeline import Timeline, standing
from planner.primitives.primitive import Step
from planner.primitives.work import Work
from planner.task.grip import BaseStop, Grip
from planner.task.reason import Reason
from planner.task.scene import Scene


@dataclass(frozen=True, slots=True)
class PlannedPrimitive:
    """One primitive of a plan.

    Attributes:
        step: the primitive as it is performed.
        start_s: when it starts (s).
        duration_s: how long it takes (s): what the cost model says, or longer where the joints are slower.
        base: where it leaves the base.
    """

    step: Step
    start_s: float
    duration_s: float
    base: BaseStop

    @property
    def kind(self) -> str:
        """The primitive's name: "fold", "drag" or "move"."""
        return self.step.kind

    @property
    def grips(self) -> tuple[Grip, ...]:
        """Where the hands go."""
        return self.step.grips

    @property
    def summary(self) -> str:
        """What it does, in a few words."""
        return self.step.summary

    def to_dict(self) -> dict[str, Any]:
        """The primitive as JSON."""
        return {
            "kind": self.kind,
            "start_s": self.start_s,
            "duration_s": self.duration_s,
            **self.step.details,
            "base": self.base.to_dict(),
            "grips": [g.to_dict() for g in self.grips],
        }


@dataclass(frozen=True, slots=True)
class Statistics:
    """What the search did (paper, Table 1).

    Attributes:
        expanded: states expanded.
        explored: successors pushed.
        ik_queries: queries put to the exact inverse kinematics, comfort points counted.
        ik_time_s: time spent in them (s).
        search_time_s: time of the whole search (s), joint paths aside.
        joint_time_s: time spent on joint paths (s).
        bound_s: no plan costs less, whatever the joints can do (s); None when no plan was found for no lack of time.
        ways: ways to go on that were looked at; the work of the search, on every machine the same.
        is_cut_short: whether it ended for want of work, time or states; else to search on would find nothing else.
    """

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
        """Those of a search that went on from another's plan: both together, with this one's bound."""
        return Statistics(
            before.expanded + self.expanded,
            before.explored + self.explored,
            before.ik_queries + self.ik_queries,
            before.ik_time_s + self.ik_time_s,
            before.search_time_s + self.search_time_s,
            before.joint_time_s + self.joint_time_s,
            self.bound_s,
            before.ways + self.ways,
            self.is_cut_short,
        )

    def to_dict(self) -> dict[str, Any]:
        """The statistics as JSON."""
        return {name: getattr(self, name) for name in self.__slots__}


@dataclass(frozen=True)
class Plan:
    """A plan, or why there is none.

    Attributes:
        status: "solved", "infeasible" (a proof that these primitives cannot do it if `is_proven`) or "budget_exceeded".
        primitives: what to do, in order; empty unless solved.
        cost_s: the whole duration (s); None unless solved.
        final_placement: the article frame in the table frame at the end; None unless solved.
        reasons: why there is no plan; empty unless infeasible.
        statistics: what the search did.
        problem: what was asked.
        acts: the primitives again, with the joint paths of those that belong together.
        is_exhaustive: whether nothing was rejected after some tries that more tries might have made possible.
    """

    status: str
    primitives: tuple[PlannedPrimitive, ...]
    cost_s: float | None
    final_placement: Pose2 | None
    reasons: tuple[Reason, ...]
    statistics: Statistics
    problem: Problem
    acts: tuple[Act, ...]
    is_exhaustive: bool

    @staticmethod
    def of(
        problem: Problem,
        status: str,
        acts: tuple[Act, ...],
        why: tuple[Reason, ...],
        statistics: Statistics,
        is_exhaustive: bool,
    ) -> "Plan":
        """The answer to a problem: what is done, act by act, if it is solved."""
        primitives = tuple(_scheduled(problem.work, acts))
        end_s = primitives[-1].start_s + primitives[-1].duration_s if primitives else 0.0
        last = primitives[-1].step.after.offset if primitives else problem.start.offset
        is_solved = status == "solved"
        return Plan(
            status,
            primitives,
            end_s if is_solved else None,
            problem.work.placed(last) if is_solved else None,
            why,
            statistics,
            problem,
            acts,
            is_exhaustive,
        )

    @property
    def work(self) -> Work:
        """The garment's folds, the scene, the robot's reach."""
        return self.problem.work

    @property
    def robot(self) -> Machine:
        """The robot."""
        return self.problem.robot

    @property
    def garment(self) -> Garment:
        """The garment."""
        return self.work.sequence.garment

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self.work.scene

    @property
    def dag(self) -> FoldDag:
        """The Fold-DAG."""
        return self.work.sequence.dag

    @property
    def final_layers(self) -> tuple[Layer, ...]:
        """The stack after all folds, bottom to top; the folds alone decide it."""
        return self.work.sequence.final.layers

    @property
    def is_solved(self) -> bool:
        """Whether there is a plan."""
        return self.status == "solved"

    @property
    def is_proven(self) -> bool:
        """Whether it is known that nothing is quicker, or that there is no plan at all."""
        bound_s = self.statistics.bound_s
        if self.cost_s is None or bound_s is None:
            return self.status == "infeasible" and self.is_exhaustive
        return self.cost_s <= bound_s + TIME_S

    @cached_property
    def _timeline(self) -> Timeline:
        maker, before = self.problem.maker, standing(self.work, self.problem.start)
        film = FilmMaker(maker.transits, maker.collisions, maker.dwell_s).film(self.acts, before)
        return Timeline.of(film, self.cost_s or 0.0, self.work, self.problem.robot.card)

    def timeline(self) -> Timeline:
        """What robot and cloth do at every moment.

        Raises:
            UnsolvedPlanError: the plan is not solved.
        """
        if not self.is_solved:
            raise UnsolvedPlanError(self.status)
        return self._timeline

    def to_dict(self) -> dict[str, Any]:
        """The plan as JSON."""
        return {
            "status": self.status,
            "cost_s": self.cost_s,
            "primitives": [p.to_dict() for p in self.primitives],
            "dag": self.dag.to_dict(),
            "final_layers": [layer.to_dict() for layer in self.final_layers],
            "final_placement": None if self.final_placement is None else self.final_placement.to_dict(),
            "reasons": [r.to_dict() for r in self.reasons],
            "statistics": self.statistics.to_dict(),
        }


def _scheduled(work: Work, acts: tuple[Act, ...]) -> Iterator[PlannedPrimitive]:
    now = 0.0
    for act in acts:
        for step, duration_s in zip(act.steps, act.durations_s(), strict=True):
            yield PlannedPrimitive(step, now, duration_s, work.base_stop(step.after))
            now += duration_s
