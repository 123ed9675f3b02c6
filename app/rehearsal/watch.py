"""Look at a run: before hands close, from arms that are out of the way if need be, at hands, and after drags."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

from app.camera.posture import Posture
from app.rehearsal.eyes import Eyes, Picture, kept
from app.rehearsal.grasp_points import are_edges_hidden
from app.rehearsal.step_motions import posture_at
from app.rehearsal.world import REACH, WITHDRAW, StepMotion, World
from app.vision.look_at_stack import Sight
from app.vision.seen_stack import SeenStack
from planner.geometry.pose import Point2, Pose2
from planner.task.plan import Plan
from planner.task.plan_step import PlanStep
from planner.task.task import Task
from planner.task.world_state import WorldState

BLIND_MAX = 1
"""Steps in a row that are made as planned though it is not known where the cloth lies."""

_WITHDRAW_S = 3.0


@dataclass
class Watch:
    """The looks of a run, and what they have told.

    Attributes:
        world: the world.
        task: the robot and the table.
        decide: notes a decision, its code and its numbers.
        posture: how the robot believes to stand; None where nobody has said.
        stack: the stack as it was seen before the hands close; None where that was not to be made out.
        blind: the steps in a row before which it was not to be made out.
        pictures: those looked at.
    """

    world: World
    task: Task
    decide: Callable[..., None]
    posture: Posture | None = None
    stack: SeenStack | None = None
    blind: int = 0
    pictures: list[Picture] = field(default_factory=list)

    @cached_property
    def eyes(self) -> Eyes:
        """The robot's eyes."""
        return Eyes(self.task)

    def before(self, plan: Plan, step: PlanStep, made: int) -> tuple[Pose2, str]:
        """Return where the stack lies before a step, as seen, and why the run must end, "" if it need not.

        Where that stays uncertain, the estimate is nearer than where it should lie, and is taken, and so it is of a
        stack that was seen before the last fold; where nothing tells it, it is where it was seen then, or should lie.

        Args:
            plan: the plan.
            step: its step.
            made: how many steps have been made.
        """
        sight, self.stack = self.look(plan, step.before, made), None
        if sight is None:
            return step.before.placement, ""
        expected = self.eyes.expected
        if self.posture is not None and (sight.unknown is not None or are_edges_hidden(step, sight.stack)):
            self.posture = self.eyes.withdrawn(self.posture)
            self.world.perform(StepMotion(made, WITHDRAW, _WITHDRAW_S, ends=self.posture))
            clear = self.look(plan, step.before, made, is_clear=True)
            sight = sight if clear is None or (clear.unknown is not None and sight.unknown is None) else clear
        if sight.fit is not None and (sight.is_estimate or expected is not None):
            self.blind, self.stack = 0, sight.stack
            return sight.fit.placement, ""
        self.blind += 1
        self.decide("kept_blindly")
        lies = step.before.placement if expected is None else expected.placement
        if self.blind <= BLIND_MAX or sight.unknown is None:
            return lies, ""
        return lies, f"before step {made} the cloth is not to be made out: {sight.unknown.text}"

    def look(self, plan: Plan, ought: WorldState, made: int, *, is_clear: bool = False) -> Sight | None:
        """Look once for a stack as it ought to lie, and note what was seen; None where the world shows nothing."""
        seen, posture = self.world.observe(), self.posture
        if posture is None:
            return None
        sight = self.eyes.sight(seen, plan.sequence, ought.folds_done, ought.placement, posture)
        if sight is None:
            return None
        fit = sight.fit
        numbers = () if fit is None else (("error_m", fit.error_m), ("share_on_outline", fit.share_on_outline))
        self.decide("seen" if sight.unknown is None else "not_known", *numbers)
        picture = kept(made, ought, seen, sight, is_clear=is_clear)
        self.pictures += [] if picture is None else [picture]
        return sight

    def reached(self, plan: Plan, step: PlanStep, motion: StepMotion, made: int) -> dict[str, Point2]:
        """Return how far beside its place each hand is seen where it is to close, by arm, table frame (m).

        Args:
            plan: the plan.
            step: its step.
            motion: the step's motion, in which all hands close.
            made: how many steps have been made.
        """
        path = plan.trajectory
        if path is None or not self.eyes.has_camera:
            return {}
        self.posture = posture_at(path, step.start_s + max(grip.times_s[0] for grip in motion.grips))
        self.world.perform(StepMotion(made, REACH, 0.0, ends=self.posture))
        hands = self.eyes.hands(self.world.observe(), self.posture)
        if hands:
            self.decide("aimed", ("beside_m", max(math.hypot(*beside) for beside in hands.values())))
        return hands

    def after(self, motion: StepMotion) -> None:
        """Note a step that was made."""
        self.posture = motion.ends
        self.eyes.after(motion)
