"""Perform a plan in a world and judge each step; with feedback, look before each and correct it (paper, section 9).

Before hands close the stack's outline is fitted to what is seen. Grips follow the cloth as far as the comfort radius
goes; beyond that, the rest is planned again from what is there. A hand that finds no cloth tries again round its grip,
and holds the cloth beside it for as long as it holds on.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from app.rehearsal.corrections import beside, carry, corrected, regrasps, shift_of, still_beside
from app.rehearsal.judge import Gate, StepVerdict, judged
from app.rehearsal.result import Decision
from app.rehearsal.step_motions import step_motions
from app.rehearsal.world import Performed, StepMotion, World
from app.vision.fit_stack import fit_stack
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2, Pose2
from planner.task.plan import Plan
from planner.task.plan_step import PlanStep
from planner.task.task import Task
from planner.task.world_state import WorldState

FAILURES_MAX = 3
"""Times that the rest is planned again before a run is given up."""


@dataclass(frozen=True, slots=True)
class Performance:
    """The outcome of a plan: verdicts, decisions of the feedback, and the reason of an early end ("" if none)."""

    steps: tuple[StepVerdict, ...]
    decisions: tuple[Decision, ...] = ()
    reason: str = ""


@dataclass
class Performer:
    """Performs a plan.

    Attributes:
        plan: the plan; after it was planned again the new one.
        world: the world.
        gate: what counts as held.
        replan: plans a task again; None performs the plan as it is, without looking.
        progress: told the fraction that is done.
    """

    plan: Plan
    world: World
    gate: Gate
    replan: Callable[[Task], Plan] | None = None
    progress: Callable[[float], None] = lambda _: None
    _verdicts: list[StepVerdict] = field(default_factory=list)
    _decisions: list[Decision] = field(default_factory=list)
    _made: int = 0
    _beside: dict[str, Point2] = field(default_factory=dict)

    def performed(self) -> Performance:
        """Perform the plan."""
        motions, number = step_motions(self.plan), 0
        carried = Isometry()
        while number < len(motions):
            step, motion = self.plan.steps[number], motions[number]
            is_free = all(grip.closes for grip in motion.grips)
            if self.replan is not None and motion.grips and is_free:
                lies = self._seen(step)
                carried = carry(step.before.placement, lies)
                shift_m = shift_of(motion, carried)
                answer = None
                if shift_m <= self.plan.task.limits.comfort_radius_m:
                    self._decide("corrected", ("shift_m", shift_m))
                    answer = self._tried(replace(corrected(motion, carried), needs_all=True), step, carried)
                if answer is None:
                    reason = self._planned_again(step, lies, shift_m)
                    if reason:
                        return Performance(tuple(self._verdicts), tuple(self._decisions), reason)
                    motions, number, carried = step_motions(self.plan), 0, Isometry()
                    continue
            else:
                answer = self._held_on(corrected(motion, carried), step, carried)
            if motion.is_drag:  # it ends where it should, so the hands that hold on fold where they should
                carried = Isometry()
            self._judge(motion, step, answer, carried)
            number += 1
            self._made += 1
            self.progress(number / len(motions))
        return Performance(tuple(self._verdicts), tuple(self._decisions))

    def _seen(self, step: PlanStep) -> Pose2:
        """Return where the stack lies as seen; where nothing is known, where it should lie."""
        outline = self.world.observe().outline
        if outline is None:
            return step.before.placement
        fit = fit_stack(outline, self.plan.sequence.cloth(step.before.done), step.before.placement)
        return fit.placement if fit.is_known or fit.others else step.before.placement

    def _tried(self, motion: StepMotion, step: PlanStep, carried: Isometry) -> Performed | None:
        """Perform a step, and where hands find no cloth again round their grips; None if they never find any."""
        answer, made = self.world.perform(motion), motion
        missing = frozenset(arm for arm, has in answer.has_cloth.items() if not has)
        radius_m, fold = self.plan.task.limits.comfort_radius_m, self._reflection(step, carried)
        for made in regrasps(motion, missing, radius_m, fold) if missing else ():
            self._decide("regrasped", ("radius_m", radius_m))
            answer = self.world.perform(made)
            if not answer.is_missing_cloth:
                break
        self._beside = still_beside(motion, made)
        return None if answer.is_missing_cloth else answer

    def _held_on(self, motion: StepMotion, step: PlanStep, carried: Isometry) -> Performed:
        """Perform a step with the hands where they hold the cloth, be that beside their grips."""
        held = {grip.arm: self._beside[grip.arm] for grip in motion.grips if grip.arm in self._beside}
        made = beside(motion, held, self._reflection(step, carried))
        self._beside = still_beside(motion, made)
        return self.world.perform(made)

    def _reflection(self, step: PlanStep, carried: Isometry) -> Isometry | None:
        """Return what a fold does to the cloth as it lies, table frame."""
        if step.fold is None:
            return None
        lies = step.before.placement
        to_table = carried.after(Isometry.rotation(lies.yaw_rad, lies.x_m, lies.y_m))
        over = Isometry.reflection(self.plan.sequence.folds[step.fold].line)
        return to_table.after(over).after(to_table.inverse)

    def _planned_again(self, step: PlanStep, lies: Pose2, shift_m: float) -> str:
        """Plan the rest from what is there; return why that cannot be, "" if it can."""
        self._decide("replanned", ("shift_m", shift_m))
        if sum(one.code == "replanned" for one in self._decisions) > FAILURES_MAX:
            return f"step {self._made} failed after the rest was planned again {FAILURES_MAX} times"
        start = WorldState(step.before.folds_done, lies, step.before.base)
        assert self.replan is not None
        again = self.replan(replace(self.plan.task, start=start))
        if not again.is_solved:
            return f"from where the cloth lies before step {self._made} the plan is {again.status}"
        self.plan = again
        return ""

    def _judge(self, motion: StepMotion, step: PlanStep, answer: Performed, carried: Isometry) -> None:
        truth = self.world.truth()
        if truth is None or not all(grip.opens for grip in motion.grips):
            return
        empty = tuple(arm for arm, has in answer.has_cloth.items() if not has)
        verdict = judged(
            truth, self._made, self.plan.sequence, step.after, carried, self.plan.scene.table, self.gate, empty
        )
        self._verdicts.append(verdict)

    def _decide(self, code: str, *numbers: tuple[str, float]) -> None:
        self._decisions.append(Decision(self._made, code, numbers))
