"""A step of a plan, and the cloth as the robot knows it before it makes the step."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from app.rehearsal.step_motions import step_motions
from app.rehearsal.vision.seen_stack import SeenStack
from app.rehearsal.world import StepMotion
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.task.plan import Plan, PlanStep


@dataclass(frozen=True)
class StepSeen:
    """A step, and what was seen before it.

    Attributes:
        plan: the plan.
        step: its step.
        motion: the step's motion, which lands short by what fingers reach (see `round_finger_ends`).
        carried: from where the stack should lie to where it lies, table frame.
        stack: how it was seen; None where it was not to be made out.
        offsets: how far beside their grips these arms take the cloth, or hold it (m).
    """

    plan: Plan
    step: PlanStep
    motion: StepMotion
    carried: Isometry = field(default_factory=Isometry)
    stack: SeenStack | None = None
    offsets: Mapping[str, Point2] = field(default_factory=dict)

    @property
    def sequence(self) -> FoldSequence:
        """The garment's folds."""
        return self.plan.sequence

    @cached_property
    def planned(self) -> StepMotion:
        """The step's motion as planned."""
        return step_motions(self.plan)[self.motion.step]

    @property
    def radius_m(self) -> float:
        """The distance from their planned paths within which hands can reach for certain (m)."""
        return self.plan.task.limits.comfort_radius_m

    @cached_property
    def shift_m(self) -> float:
        """The largest distance from a planned grip to where the cloth has it now (m)."""
        picks = [grip.points[0][:2] for grip in self.motion.grips]
        return max((math.dist(pick, self.carried.apply_point(pick)) for pick in picks), default=0.0)

    @property
    def spare_m(self) -> float:
        """How much further hands that follow the cloth may leave their paths (m)."""
        return max(0.0, self.radius_m - self.shift_m)

    @property
    def takes_cloth(self) -> bool:
        """Whether hands take the cloth in the step, rather than hold on to it."""
        return bool(self.motion.grips) and all(grip.closes for grip in self.motion.grips)

    @cached_property
    def fold(self) -> Isometry | None:
        """What the step's fold does to the cloth as it lies, table frame; None if it makes none."""
        if self.step.fold is None:
            return None
        lies = self.step.before.placement
        to_table = self.carried.after(Isometry.rotation(lies.yaw_rad, lies.x_m, lies.y_m))
        over = Isometry.reflection(self.sequence.folds[self.step.fold].line)
        return to_table.after(over).after(to_table.inverse)

    def to_table(self, vector: Point2) -> Point2:
        """Return a vector of the garment frame in the table frame, as the cloth lies."""
        yaw_rad = self.step.before.placement.yaw_rad + math.atan2(self.carried.c, self.carried.a)
        return Isometry.rotation(yaw_rad).apply_point(vector)
