"""Where the hands of a plan can end their folds elsewhere: in reach of the robot as it stands then."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.primitives.reach import Reach
from planner.robots.load_robot import load_robot
from planner.task.plan import Plan


@dataclass(frozen=True)
class HandReach:
    """What the hands of a plan's robot reach, with the plan's margin.

    Attributes:
        plan: the plan.
    """

    plan: Plan

    def ends_in(self, step: int, arm: str, points: FloatArray) -> BoolArray:
        """Return at which points, table frame, an arm can open its hand in a step, shape (n, 3) -> (n,).

        The hand is turned as the plan has it when it opens, and the base stands where it does then.
        """
        path = self.plan.trajectory
        if path is None:
            return np.zeros(len(points), dtype=bool)
        number = next(one for one, track in enumerate(path.grippers) if track.arm == arm)
        for segment in reversed(path.of_step(step)):
            hand = segment.phase.hands[number]
            if hand is not None and hand.is_closed and not hand.is_reaching:
                if hand.approach not in self._reach.approaches:
                    break  # of a plan from elsewhere
                base, height_m = segment.phase.base[-1], self.plan.scene.table.height_m
                seen = np.column_stack([base.to_inner(points[:, :2]), points[:, 2] + height_m])
                approaches = np.array([self._reach.approaches.index(hand.approach)])
                (reached,) = self._reach.from_anywhere(self._reach.arm_names.index(arm), seen, approaches, 1, 0.0)
                return np.asarray(reached)
        return np.zeros(len(points), dtype=bool)

    @cached_property
    def _reach(self) -> Reach:
        """The robot's reach, its lift as high as in the plan."""
        assert self.plan.trajectory is not None
        limits = self.plan.task.limits
        return load_robot(self.plan.task.robot).reach(self.plan.trajectory.torso_m, limits.comfort_radius_m)
