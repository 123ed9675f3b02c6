"""Perform a plan in a world and judge each step; with feedback, look before each and correct it (paper, section 9).

Before hands close the stack's outline is fitted to what is seen, and the step is corrected for it (`BY_WHAT_IS_SEEN`).
Where cloth lies further away than the comfort radius, or hands find none, the rest is planned again from what is there.
A hand that finds no cloth tries again round its grip, and holds the cloth beside it for as long as it holds on. What a
fold is seen to have left short of its place is laid down again; a fold that has left another outline than planned is
opened and made again, once, and if that fails too the run ends. Where it is not known where the stack lies, the arms
withdraw for another look; where that does not help, one step is made as planned, and a run that stays blind ends.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from app.rehearsal.corrections import (
    BY_WHAT_IS_SEEN,
    WITHOUT_LOOKING,
    aimed,
    corrected,
    held_beside,
    regrasps,
    seen_after_drag,
    still_beside,
)
from app.rehearsal.eyes import Picture
from app.rehearsal.finger_ends import round_finger_ends
from app.rehearsal.grasp_points import taken_at
from app.rehearsal.judge import Gate, StepVerdict, carried_pose, carry, judged
from app.rehearsal.result import Decision
from app.rehearsal.step_motions import posture_at, step_motions
from app.rehearsal.step_seen import StepSeen
from app.rehearsal.trace import ClothAfter, counterpart
from app.rehearsal.watch import WITHDRAW_S, Watch
from app.rehearsal.world import WITHDRAW, Performed, StepMotion, World
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.robots.load_robot import robot_card_file
from planner.task.plan import Plan, PlanStep
from planner.task.task import TIME_LIMIT_S, Task
from planner.task.world_state import WorldState

FAILURES_MAX = 3
"""Times that the rest is planned again before a run is given up."""

REPAIRS_MAX = 2
"""Times that what a fold has left short of its place is laid down again."""


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
        progress: called with the fraction that is done.
    """

    plan: Plan
    world: World
    gate: Gate
    replan: Callable[[Task], Plan] | None = None
    progress: Callable[[float], None] = lambda _: None
    _verdicts: list[StepVerdict] = field(default_factory=list)
    _decisions: list[Decision] = field(default_factory=list)
    _cloths: list[ClothAfter] = field(default_factory=list)
    _made: int = 0
    _opened: int = -1
    _held: dict[str, Point2] = field(default_factory=dict)
    _hands: dict[str, Point2] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Note the plan as it is at first, and begin it."""
        self._first = self.plan
        self._watch = Watch(self.world, self.plan.task, self._decide)
        self._begin()

    def performed(self) -> Performance:
        """Perform the plan: before each step look, correct the step and make it, or plan the rest again from there."""
        reason = ""
        while self._number < len(self._motions) and not reason:
            seen, reason = self._seen(self.plan.steps[self._number], self._motions[self._number])
            answer = None if reason else self._performed(seen)
            if answer is not None:
                self._go_on(seen, answer)
            elif not reason:
                reason = self._planned_again(seen)
        if self.replan is not None and self._motions and not reason:
            reason = self._watch.at_end(self.plan, self.plan.steps[-1], self._made)
        pictures, cloths = tuple(self._watch.pictures), tuple(self._cloths)
        return Performance(tuple(self._verdicts), tuple(self._decisions), reason, pictures, cloths)

    def _begin(self) -> None:
        """Begin the plan with its first step, the stack believed to lie where it should."""
        path, radius_m = self.plan.trajectory, self.plan.task.limits.comfort_radius_m
        self._watch.posture = None if path is None else posture_at(path, 0.0)
        arms = robot_card_file(self.plan.task.robot).arms
        thickness_m = {arm.name: arm.gripper.finger_thickness_m for arm in arms}
        self._motions = tuple(round_finger_ends(step_motions(self.plan), thickness_m, radius_m))
        self._number, self._carried = 0, Isometry()

    def _seen(self, step: PlanStep, motion: StepMotion) -> tuple[StepSeen, str]:
        """Return a step with the cloth as it lies before it, and why the run must end, "" if it need not.

        The robot looks only if hands are to take the cloth; hands that hold on have it where they took it.
        """
        known = StepSeen(self.plan, step, motion, self._carried, offsets=self._held)
        if self.replan is None or not known.takes_cloth:
            return known, ""
        lies, blind = self._watch.before(self.plan, step, self._made)
        seen = replace(known, carried=carry(step.before.placement, lies), stack=self._watch.stack)
        return replace(seen, offsets=taken_at(seen)), blind

    def _performed(self, seen: StepSeen) -> Performed | None:
        """Perform a step as corrected; None where cloth lies beyond the comfort radius, or hands never find any.

        Hands that find no cloth try again round where they missed.
        """
        if self.replan is None:
            return self.world.perform(corrected(seen, WITHOUT_LOOKING))
        if not seen.takes_cloth:
            hands, self._hands = self._hands, {}
            return self._tried(seen, hands)
        if seen.shift_m > seen.radius_m:
            return None
        self._decide("corrected", ("shift_m", seen.shift_m))
        self._hands = self._watch.reached(seen, self._made)
        answer = self._tried(seen, self._hands)
        for offsets in regrasps(seen, answer.missing):
            if not answer.missing:
                break
            self._decide("regrasped", ("radius_m", seen.radius_m))
            answer = self._tried(replace(seen, offsets=offsets), self._hands)
        return None if answer.missing else answer

    def _tried(self, seen: StepSeen, hands: Mapping[str, Point2]) -> Performed:
        """Perform a step as corrected, for hands seen at these offsets from their places, by arm, table frame (m)."""
        made = replace(corrected(seen, BY_WHAT_IS_SEEN), needs_all=seen.takes_cloth)
        self._held = still_beside(seen, made)
        return self.world.perform(aimed(made, hands))

    def _go_on(self, seen: StepSeen, answer: Performed) -> None:
        """Judge a step that was made, and go on to the next one."""
        self._watch.after(seen.motion)
        if self._is_opened(seen):
            return
        self._carried = self._after_drag(seen) if seen.motion.is_drag else seen.carried
        self._lay_again(seen)
        self._judge(seen, answer)
        self._number += 1
        self._made += 1
        self.progress(self._number / len(self._motions))

    def _is_opened(self, seen: StepSeen) -> bool:
        """Open a fold again that is seen to have failed, once for each step; return whether it was opened."""
        if self.replan is None or not seen.motion.is_fold or not seen.takes_cloth or self._opened == self._made:
            return False
        motion = self._watch.opened(seen, self._made + 1) if all(grip.opens for grip in seen.motion.grips) else None
        if motion is None:
            return False
        self._opened = self._made
        self.world.perform(motion)
        return True

    def _lay_again(self, seen: StepSeen) -> None:
        """Look at the edges that a fold has laid down, and lay down again those that are short of their places."""
        if self.replan is None or not seen.motion.is_fold or not all(grip.opens for grip in seen.motion.grips):
            return
        for _ in range(REPAIRS_MAX):
            motion = self._watch.laid_again(seen, self._made + 1)
            if motion is None or self.world.perform(motion).missing:
                return

    def _after_drag(self, seen: StepSeen) -> Isometry:
        """Return the stack's offset from its planned pose after a drag; move the hands that keep holding with it.

        A drag ends where it should, but the stack swings behind a single hand, and is pulled straight by it.
        """
        if self.replan is None or all(grip.opens for grip in seen.motion.grips):
            return Isometry()
        ought = seen.step.after
        sight = self._watch.look(self.plan, ought, self._made)
        carried = seen_after_drag(seen.motion, ought.placement, sight, seen.radius_m)
        self._held = held_beside(seen.motion, self._held, carried)
        return carried

    def _planned_again(self, seen: StepSeen) -> str:
        """Plan the rest from the cloth as it lies, and begin it; return why that is not possible, "" if it is."""
        self._decide("replanned", ("shift_m", seen.shift_m))
        if sum(one.code == "replanned" for one in self._decisions) > FAILURES_MAX:
            return f"step {self._made} failed after the rest was planned again {FAILURES_MAX} times"
        before = seen.step.before
        lies = carried_pose(before.placement, seen.carried)
        assert self.replan is not None
        again = self.replan(rest_task(self._first.task, WorldState(before.folds_done, lies, before.base)))
        if not again.is_solved:
            return f"from where the cloth lies before step {self._made} the plan is {again.status}"
        self.plan = again
        self._begin()
        self.world.perform(StepMotion(self._made, WITHDRAW, WITHDRAW_S, ends=self._watch.posture))
        return ""

    def _judge(self, seen: StepSeen, answer: Performed) -> None:
        truth, after = self.world.truth(), seen.step.after
        if truth is None or not all(grip.opens for grip in seen.motion.grips):
            return
        table, empty = self.plan.scene.table, tuple(sorted(answer.missing))
        verdict = judged(truth, self._made, self.plan.sequence, after, self._carried, table, self.gate, empty)
        of_plan = counterpart(self._first, seen.step)
        self._verdicts.append(replace(verdict, of_plan=of_plan))
        self._cloths += [] if of_plan is None else [ClothAfter(of_plan, truth.positions)]

    def _decide(self, code: str, *numbers: tuple[str, float]) -> None:
        self._decisions.append(Decision(self._made, code, numbers))


def rest_task(task: Task, start: WorldState) -> Task:
    """Return the task of finishing the folds from a state.

    The work ends its search, on any machine and under any load, so that a run twice is the same.

    Args:
        task: the task as it was at first.
        start: the state as it is.
    """
    limits = task.limits
    work_s = limits.work_limit_s or limits.time_limit_s
    return replace(task, start=start, limits=replace(limits, work_limit_s=work_s, time_limit_s=TIME_LIMIT_S[1]))
