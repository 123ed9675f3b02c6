"""Perform a plan in a world and judge each step; with feedback, look before each and correct it (paper, section 9).

Before hands close the stack's outline is fitted to what is seen. Grips follow the cloth as far as the comfort radius
goes; beyond that, the rest is planned again from what is there. A hand that finds no cloth tries again round its grip,
and holds the cloth beside it for as long as it holds on. Where it is not known where the stack lies, the arms withdraw
for another look; where that does not help, one step is made as planned, and a run that stays blind ends. So does one in
which a fold has left another outline than planned, on a second look too; after the last step it is looked for as well.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from app.rehearsal.corrections import (
    SHORT_M,
    aimed,
    beside,
    carry,
    corrected,
    held_beside,
    landing_short,
    reflection_in,
    regrasps,
    seen_after_drag,
    shift_of,
    still_beside,
)
from app.rehearsal.eyes import Picture
from app.rehearsal.finger_ends import round_finger_ends
from app.rehearsal.grasp_points import at_layered_corners, inside, inwards_at, laid_short, where_seen
from app.rehearsal.judge import Gate, StepVerdict, judged
from app.rehearsal.rest import rest_task
from app.rehearsal.result import Decision
from app.rehearsal.step_motions import posture_at, step_motions
from app.rehearsal.taut_way import taut
from app.rehearsal.trace import ClothAfter, counterpart
from app.rehearsal.trailing_flaps import flaps_beside, trailing
from app.rehearsal.watch import WITHDRAW_S, Watch
from app.rehearsal.world import WITHDRAW, Performed, StepMotion, World
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2, Pose2
from planner.robots.load_robot import robot_card_file
from planner.task.plan import Plan
from planner.task.plan_step import PlanStep
from planner.task.task import Task
from planner.task.world_state import WorldState

FAILURES_MAX = 3
"""Times that the rest is planned again before a run is given up."""


@dataclass(frozen=True, slots=True)
class Performance:
    """The outcome of a plan: verdicts, decisions of the feedback, the reason of an early end ("" if none), pictures.

    `cloths` is the cloth after each judged step that has its counterpart in the plan as it was at first.
    """

    steps: tuple[StepVerdict, ...]
    decisions: tuple[Decision, ...] = ()
    reason: str = ""
    pictures: tuple[Picture, ...] = ()
    cloths: tuple[ClothAfter, ...] = ()


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
    _hands: dict[str, Point2] = field(default_factory=dict)
    _cloths: list[ClothAfter] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Note the plan as it is at first."""
        self._first = self.plan
        self._watch = Watch(self.world, self.plan.task, self._decide)

    def performed(self) -> Performance:
        """Perform the plan."""
        motions, number, carried = self._anew()
        while number < len(motions):
            step, motion = self.plan.steps[number], motions[number]
            is_free = all(grip.closes for grip in motion.grips)
            if self.replan is not None and motion.grips and is_free:
                lies, blind = self._watch.before(self.plan, step, self._made)
                if blind:
                    return self._ended(blind)
                carried = carry(step.before.placement, lies)
                shift_m = shift_of(motion, carried)
                answer = None
                if shift_m <= self.plan.task.limits.comfort_radius_m:
                    self._decide("corrected", ("shift_m", shift_m))
                    spare_m = self.plan.task.limits.comfort_radius_m - shift_m
                    answer = self._tried(replace(corrected(motion, carried), needs_all=True), step, carried, spare_m)
                if answer is None:
                    reason = self._planned_again(step, lies, shift_m)
                    if reason:
                        return self._ended(reason)
                    motions, number, carried = self._anew()
                    self.world.perform(StepMotion(self._made, WITHDRAW, WITHDRAW_S, ends=self._watch.posture))
                    continue
            else:
                answer = self._held_on(corrected(motion, carried), step, carried)
            self._watch.after(motion)
            if motion.is_drag:
                carried = self._after_drag(motion, step)
            self._judge(motion, step, answer, carried)
            number += 1
            self._made += 1
            self.progress(number / len(motions))
        sees_end = self.replan is not None and len(motions) > 0
        return self._ended(self._watch.at_end(self.plan, self.plan.steps[-1], self._made) if sees_end else "")

    def _ended(self, reason: str) -> Performance:
        pictures, cloths = tuple(self._watch.pictures), tuple(self._cloths)
        return Performance(tuple(self._verdicts), tuple(self._decisions), reason, pictures, cloths)

    def _anew(self) -> tuple[tuple[StepMotion, ...], int, Isometry]:
        """Begin the plan: its motions, the number of the first, and how far the stack lies from its place."""
        path, radius_m = self.plan.trajectory, self.plan.task.limits.comfort_radius_m
        self._watch.posture = None if path is None else posture_at(path, 0.0)
        arms = robot_card_file(self.plan.task.robot).arms
        thickness_m = {arm.name: arm.gripper.finger_thickness_m for arm in arms}
        return tuple(round_finger_ends(step_motions(self.plan), thickness_m, radius_m)), 0, Isometry()

    def _after_drag(self, motion: StepMotion, step: PlanStep) -> Isometry:
        """Return how far from where it should be a stack lies after a drag; hands that hold on are beside it then.

        A drag ends where it should, but the stack swings behind a single hand, and is pulled straight by it.
        """
        if self.replan is None or all(grip.opens for grip in motion.grips):
            return Isometry()
        sight, radius_m = self._watch.look(self.plan, step.after, self._made), self.plan.task.limits.comfort_radius_m
        carried = seen_after_drag(motion, step.after.placement, sight, radius_m)
        self._beside = held_beside(motion, self._beside, carried)
        return carried

    def _tried(self, motion: StepMotion, step: PlanStep, carried: Isometry, spare_m: float) -> Performed | None:
        """Perform a step, and where hands find no cloth again round their grips; None if they never find any.

        A part that moved last, and an edge, is taken where it is seen, corners of several layers inside of that,
        `spare_m` from the grips at most.
        """
        radius_m, sequence = self.plan.task.limits.comfort_radius_m, self.plan.sequence
        fold, flaps = reflection_in(step, sequence, carried), flaps_beside(step, sequence, carried)
        inwards = inwards_at(step, sequence, carried)
        corners = {arm: inwards[arm] for arm in at_layered_corners(step, sequence) & inwards.keys()}
        offsets = inside(where_seen(step, carried, self._watch.stack, spare_m), corners, spare_m)
        short = landing_short(taut(motion, spare_m), laid_short(self.plan, step), SHORT_M)
        made = trailing(beside(short, offsets, fold), motion, flaps, carried, radius_m)
        self._hands = self._watch.reached(self.plan, step, motion, self._made)
        answer = self.world.perform(aimed(made, self._hands))
        missing = frozenset(arm for arm, has in answer.has_cloth.items() if not has)
        # A drag may pull the cloth behind it, so that its way says nothing of where cloth is; a fold's leads over it.
        ahead = {} if step.fold is not None else inwards
        for again in regrasps(short, missing, radius_m, ahead, offsets, fold) if missing else ():
            self._decide("regrasped", ("radius_m", radius_m))
            made = trailing(again, motion, flaps, carried, radius_m)
            answer = self.world.perform(aimed(made, self._hands))
            if not answer.is_missing_cloth:
                break
        self._beside = still_beside(motion, made)
        return None if answer.is_missing_cloth else answer

    def _held_on(self, motion: StepMotion, step: PlanStep, carried: Isometry) -> Performed:
        """Perform a step with the hands where they hold the cloth, be that beside their grips."""
        held = {grip.arm: self._beside[grip.arm] for grip in motion.grips if grip.arm in self._beside}
        short = landing_short(motion, laid_short(self.plan, step), 0.0 if self.replan is None else SHORT_M)
        made = beside(short, held, reflection_in(step, self.plan.sequence, carried))
        self._beside = still_beside(motion, made)
        hands, self._hands = self._hands, {}
        return self.world.perform(aimed(made, hands))

    def _planned_again(self, step: PlanStep, lies: Pose2, shift_m: float) -> str:
        """Plan the rest from what is there; return why that cannot be, "" if it can."""
        self._decide("replanned", ("shift_m", shift_m))
        if sum(one.code == "replanned" for one in self._decisions) > FAILURES_MAX:
            return f"step {self._made} failed after the rest was planned again {FAILURES_MAX} times"
        start = WorldState(step.before.folds_done, lies, step.before.base)
        assert self.replan is not None
        again = self.replan(rest_task(self._first.task, start))
        if again.is_solved:
            self.plan = again
            return ""
        return f"from where the cloth lies before step {self._made} the plan is {again.status}"

    def _judge(self, motion: StepMotion, step: PlanStep, answer: Performed, carried: Isometry) -> None:
        truth = self.world.truth()
        if truth is None or not all(grip.opens for grip in motion.grips):
            return
        empty = tuple(arm for arm, has in answer.has_cloth.items() if not has)
        verdict = judged(
            truth, self._made, self.plan.sequence, step.after, carried, self.plan.scene.table, self.gate, empty
        )
        of_plan = counterpart(self._first, step)
        self._verdicts.append(replace(verdict, of_plan=of_plan))
        self._cloths += [] if of_plan is None else [ClothAfter(of_plan, truth.positions)]

    def _decide(self, code: str, *numbers: tuple[str, float]) -> None:
        self._decisions.append(Decision(self._made, code, numbers))
