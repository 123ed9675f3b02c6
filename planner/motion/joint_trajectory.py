"""Joint trajectories of all arms and grippers, as keyframes between which everything moves evenly."""

from dataclasses import dataclass, field

import numpy as np

from planner.geometry.pose import FloatArray

OPEN_M, CLOSED_M = 0.04, 0.004
"""The gripper's opening when it is empty and when it holds cloth (m)."""


@dataclass(slots=True)
class JointTrajectory:
    """The joint trajectory of all arms, and the openings of their grippers.

    Attributes:
        times_s: the times of the keyframes (s), rising.
        joints: the joints of all arms at each (rad), shape (joints,) each.
    """

    times_s: list[float]
    joints: list[FloatArray]
    _grip_times_s: list[list[float]] = field(default_factory=list)
    _openings_m: list[list[float]] = field(default_factory=list)

    @staticmethod
    def at_rest(joints: FloatArray, arms: int) -> "JointTrajectory":
        """Return a trajectory of some arms that begins at their joints, shape (joints,), with all grippers open."""
        return JointTrajectory([0.0], [joints], [[0.0] for _ in range(arms)], [[OPEN_M] for _ in range(arms)])

    @property
    def last(self) -> FloatArray:
        """The joints of the last keyframe (rad), shape (joints,)."""
        return self.joints[-1]

    def joints_at(self, times_s: FloatArray) -> FloatArray:
        """Return all arms' joints at some times (rad), shape (n,) -> (n, joints)."""
        knots, joints = np.array(self.times_s), np.array(self.joints)
        after = np.searchsorted(knots, times_s, side="right").clip(1, max(len(knots) - 1, 1))
        if len(knots) == 1:
            return joints.repeat(len(times_s), axis=0)
        shares = ((times_s - knots[after - 1]) / (knots[after] - knots[after - 1])).clip(0.0, 1.0)[:, None]
        return np.asarray((1.0 - shares) * joints[after - 1] + shares * joints[after])

    def openings(self, arm: int) -> tuple[list[float], list[float]]:
        """Return a gripper's keyframes: their times (s) and openings (m)."""
        return self._grip_times_s[arm], self._openings_m[arm]

    def add(self, times_s: FloatArray, joints: FloatArray) -> None:
        """Add keyframes, shapes (n,) and (n, joints); skip those no later than the last."""
        for t, here in zip(times_s.tolist(), joints, strict=True):
            if t > self.times_s[-1]:
                self.times_s.append(t)
                self.joints.append(here)

    def begin_closed(self, arm: int) -> None:
        """Have a gripper hold cloth from the beginning."""
        self._openings_m[arm][0] = CLOSED_M

    def close(self, arm: int, start_s: float, end_s: float) -> None:
        """Close a gripper from one time to another."""
        self._grip(arm, start_s, end_s, CLOSED_M)

    def open(self, arm: int, start_s: float, end_s: float) -> None:
        """Open a gripper from one time to another."""
        self._grip(arm, start_s, end_s, OPEN_M)

    def _grip(self, arm: int, start_s: float, end_s: float, opening_m: float) -> None:
        self._grip_times_s[arm] += [start_s, end_s]
        self._openings_m[arm] += [self._openings_m[arm][-1], opening_m]
