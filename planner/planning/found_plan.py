"""A plan together with the data it was found with, for use in the next plan of a similar garment."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from planner.geometry.tolerance import TIME_S
from planner.motion.plan_segment import PlanSegment
from planner.motion.trajectory_maker import trajectory
from planner.planning.problem import Problem
from planner.primitives.context import DRAGS_PER_M, Context
from planner.primitives.primitive import Step
from planner.task.plan import Plan, PlanStep, Statistics
from planner.task.reason import Reason
from planner.task.task import Task
from planner.task.trajectory import Trajectory
from planner.task.world_state import Grip, HeldPoint, WorldState


@dataclass(frozen=True, eq=False)
class FoundPlan:
    """A plan and how it was found.

    Attributes:
        plan: the plan, which is data alone.
        context: the planning context, with the obstacles met. The problem's transfer planner, which has some megabytes
            of joint paths, ends with the search.
        plan_segments: the steps, grouped into segments with their transfers.
    """

    plan: Plan
    context: Context
    plan_segments: tuple[PlanSegment, ...]

    @staticmethod
    def of(
        problem: Problem,
        status: Literal["solved", "infeasible", "budget_exceeded"],
        plan_segments: tuple[PlanSegment, ...],
        reasons: tuple[Reason, ...],
        statistics: Statistics,
        *,
        is_exhaustive: bool,
    ) -> "FoundPlan":
        """Make a plan of the segments that were found."""
        path = (
            trajectory(problem.context, problem.robot.card, problem.maker, plan_segments)
            if status == "solved"
            else None
        )
        steps = () if path is None else tuple(_scheduled(problem, plan_segments, path))
        if path is not None and steps:
            path = replace(path, duration_s=steps[-1].end_s)
        plan = Plan(problem.task, status, steps, path, reasons, statistics, is_exhaustive)
        return FoundPlan(plan, problem.context, plan_segments)

    def or_quicker(self, other: "FoundPlan") -> "FoundPlan":
        """Return the quicker of this plan and another for the same task; its bound is one that neither beats."""
        better = other if _rank(other) < _rank(self) else self
        bounds = [one.plan.bound_s for one in (self, other) if one.plan.status != "infeasible"]
        known = [bound_s for bound_s in bounds if bound_s is not None]
        bound_s = min(known) if known and len(known) == len(bounds) else None
        statistics = replace(other.plan.statistics.after(self.plan.statistics), bound_s=bound_s)
        is_exhaustive = self.plan.is_exhaustive and other.plan.is_exhaustive
        return better.with_statistics(better.plan.task, statistics, is_exhaustive=is_exhaustive)

    def with_reasons(self, reasons: tuple[Reason, ...]) -> "FoundPlan":
        """Return this answer with the reasons why there is no plan."""
        return replace(self, plan=replace(self.plan, reasons=reasons))

    def with_statistics(self, task: Task, statistics: Statistics, *, is_exhaustive: bool) -> "FoundPlan":
        """Return this plan as the answer to a task with other limits, with new statistics."""
        plan = replace(self.plan, task=task, statistics=statistics, is_exhaustive=is_exhaustive)
        return FoundPlan(plan, self.context, self.plan_segments)


def _rank(found: FoundPlan) -> tuple[bool, float, bool]:
    """Return the sort key of a plan: any plan before none, then the cost, then a limit reached before "infeasible"."""
    cost_s = found.plan.cost_s
    return cost_s is None, 0.0 if cost_s is None else cost_s, found.plan.status == "infeasible"


def _scheduled(problem: Problem, plan_segments: Sequence[PlanSegment], path: Trajectory) -> Iterator[PlanStep]:
    """Yield the steps; each lasts as long as its motion: what was validated, or longer for a transit before it."""
    now, before = 0.0, problem.task.start
    for plan_segment in plan_segments:
        for number, (step, validated_s) in enumerate(
            zip(plan_segment.steps, plan_segment.durations_s(), strict=True), start=plan_segment.first
        ):
            segments = path.of_step(number)
            lasts_s = segments[-1].start_s + segments[-1].duration_s - segments[0].start_s
            duration_s = validated_s if abs(lasts_s - validated_s) <= TIME_S else lasts_s
            after = _world_after(problem.context, step, before)
            yield PlanStep(
                step.kind,
                now,
                duration_s,
                step.details,
                problem.context.base_stop(step.after),
                _grips(problem.context, step, plan_segment),
                before,
                after,
                step.holdings(),
            )
            now, before = now + duration_s, after


def _grips(context: Context, step: Step, plan_segment: PlanSegment) -> tuple[Grip, ...]:
    """Return a step's grips, with the way in which each hand holds the cloth."""
    if plan_segment.transfer is None:
        return step.grips
    kinds = dict(zip(context.reach.arm_names, (hold.kind for hold in plan_segment.transfer.holds), strict=True))
    return tuple(replace(grip, kind=kinds[grip.arm]) for grip in step.grips)


def _world_after(context: Context, step: Step, before: WorldState) -> WorldState:
    state = step.after
    new = tuple(fold for fold in range(len(context.sequence.folds)) if (state.done & ~step.before.done) >> fold & 1)
    return WorldState(
        before.folds_done + new,
        context.placed(state.offset),
        context.base_stop(state),
        tuple(HeldPoint(context.reach.arm_names[held.arm], held.point) for held in state.held),
        state.dragged / DRAGS_PER_M,
    )
