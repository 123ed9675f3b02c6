"""The joint paths of a transfer."""

from dataclasses import dataclass, replace

import numpy as np

from planner.geometry.pose import FloatArray
from planner.motion.hand_holds import settles
from planner.motion.smoothing import smoothed
from planner.motion.transfer_tool_paths import ApproachLines, Cloths
from planner.motion.waypoints import Waypoints

_SMOOTHING_PASSES = 30
"""How often joints are smoothed while a base drags."""


@dataclass(frozen=True, slots=True, eq=False)
class TransferPath:
    """The joint paths of a transfer.

    Attributes:
        waypoints: the waypoints while cloth is held.
        cloths: the cloth on the table before and after.
        bases: the base at each step: x (m), y (m), yaw (rad), table frame, shape (steps, 3).
        joints: every arm's joints (rad), shape (steps, joints). Arms that take no part are at home; those that have
            let go wait where they withdrew to.
        first: the step at which the hands reach the grips: the first of the waypoints.
        lines: how the hands approach and withdraw.
        half_turns: the extra turn of the joints that turn hands about their approach axes (rad), 0 or pi, shape
            (joints,). The two fingers are interchangeable, so each hand is turned the way that is nearer to home.
    """

    waypoints: Waypoints
    cloths: Cloths
    bases: FloatArray
    joints: FloatArray
    first: int
    lines: ApproachLines
    half_turns: FloatArray

    @property
    def settles(self) -> bool:
        """Whether fingers close a step before the hands are at the grips, and open a step after their last waypoint."""
        return settles(self.lines.holds)

    @property
    def approach(self) -> FloatArray:
        """The joints on the way to where fingers close (rad), shape (n, joints)."""
        return self.joints[: self.first + 1 - int(self.settles)]

    @property
    def retreat(self) -> FloatArray:
        """The joints on the way from where fingers open (rad), shape (n, joints)."""
        return self.joints[self.last + int(self.settles) :]

    @property
    def last(self) -> int:
        """The step of the last of the waypoints, at which the hands let go."""
        return self.first + len(self.waypoints) - 1

    def smoothed(self) -> "TransferPath":
        """Return it without the kinks that slow it down where all tools stand still, seen from the base: in drags."""
        is_still = np.zeros(len(self.joints), dtype=np.bool_)
        is_still[self.first : self.last + 1] = self.waypoints.is_still
        return replace(self, joints=smoothed(self.joints, _SMOOTHING_PASSES, is_still)) if is_still.any() else self

    def guides(self, first: int, waypoints: Waypoints, steps: int) -> FloatArray:
        """Return its joints as guides for a transfer that differs a little, shape (steps, joints).

        Args:
            first: the step of that transfer at which the hands reach the grips.
            waypoints: its waypoints.
            steps: the number of its steps.
        """
        old, new = self.waypoints.progress, waypoints.progress
        held = np.interp(new, old, np.arange(len(old))) + self.first
        coming = np.linspace(0.0, self.first, first, endpoint=False)
        leaving = np.linspace(self.last, len(self.joints) - 1.0, steps - first - len(new) + 1)[1:]
        places = np.concatenate([coming, held, leaving])
        before = np.minimum(places.astype(np.int64), len(self.joints) - 1)
        along = (places - before)[:, None]
        after = np.minimum(before + 1, len(self.joints) - 1)
        return np.asarray((1.0 - along) * self.joints[before] + along * self.joints[after] - self.half_turns)
