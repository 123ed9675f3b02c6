"""Joint trajectories of all arms and grippers, as keyframes with velocities: cubics in between."""

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from planner.geometry.keyframes import least_s, values_at
from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.motion.path_timing import PathTiming
from planner.robots.card import FINGER_RISE_S, GripperCard


class Keyframes(NamedTuple):
    """Joint positions of all arms over time.

    Attributes:
        times_s: rising, shape (n,).
        joints: all arms' joints at each time (rad), shape (n, joints).
        velocities: their velocities (rad/s), alike.
    """

    times_s: FloatArray
    joints: FloatArray
    velocities: FloatArray

    @staticmethod
    def still(joints: FloatArray, *times_s: float) -> "Keyframes":
        """Return keyframes at which the hands rest."""
        rows = np.tile(joints, (len(times_s), 1))
        return Keyframes(np.array(times_s), rows, np.zeros_like(rows))

    @staticmethod
    def joined(parts: "list[Keyframes]") -> "Keyframes":
        """Return keyframes one after the other."""
        return Keyframes(*(np.concatenate(of_all) for of_all in zip(*parts, strict=True)))

    def until(self, count: int) -> "Keyframes":
        """Return the first of them."""
        return Keyframes(self.times_s[:count], self.joints[:count], self.velocities[:count])

    def later(self, by_s: float) -> "Keyframes":
        """Return the same keyframes later (s)."""
        return Keyframes(self.times_s + by_s, self.joints, self.velocities)


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A straight line of the hands to grips or from them, as part of a transfer.

    Attributes:
        joints: all arms' joints (rad), shape (n, joints).
        timing: the quickest run along it, from rest to rest.
        openings_m: how far each arm's fingers are open at most meanwhile (m), shape (arms,).
        at_grips: all arms' joints at the grips (rad), shape (joints,), where fingers close elsewhere; None: they close
            at the line's end.
    """

    joints: FloatArray
    timing: PathTiming
    openings_m: FloatArray
    at_grips: FloatArray | None = None

    @property
    def shortest_s(self) -> float:
        """The least time for all of it (s)."""
        return self.timing.duration_s

    def over(self, lasts_s: float) -> Keyframes:
        """Return its keyframes after its start, over a time no less than the least (s)."""
        timing = self.timing.stretched(max(lasts_s / self.shortest_s, 1.0)) if self.shortest_s > 0.0 else self.timing
        return Keyframes(timing.times_s[1:], self.joints[1:], timing.velocities[1:])

    def moved(self, by: FloatArray) -> "Line":
        """Return the line with turns added to its joints (rad), shape (joints,)."""
        at_grips = None if self.at_grips is None else self.at_grips + by
        return replace(self, joints=self.joints + by, at_grips=at_grips)


OPEN_M, CLOSED_M = 0.04, 0.004
"""The gripper's opening when it is empty and when it holds a ridge of cloth from above (m)."""


def finger_limits(gripper: GripperCard) -> tuple[float, float]:
    """Return the top speed and acceleration of fingers that close or open, as fractions of their way (1/s, 1/s2)."""
    evenly_s = gripper.least_s(OPEN_M, CLOSED_M)
    return 1.0 / evenly_s, 1.0 / (evenly_s * FINGER_RISE_S)


def finger_limits_over(gripper: GripperCard, way_m: float) -> tuple[float, float]:
    """Return the same as fractions of a part of their way (m)."""
    share = abs(way_m) / (OPEN_M - CLOSED_M)
    speed, acceleration = finger_limits(gripper)
    return (speed / share, acceleration / share) if share > 0.0 else (speed, acceleration)


def finger_run_s(gripper: GripperCard) -> float:
    """Return the least time in which fingers close or open, from rest to rest (s)."""
    return least_s(1.0, *finger_limits(gripper))


@dataclass(slots=True)
class JointTrajectory:
    """The joint trajectory of all arms, and the openings of their grippers.

    Attributes:
        times_s: the times of the keyframes (s), rising.
        joints: the joints of all arms at each (rad), shape (joints,) each.
        velocities: their velocities (rad/s), alike.
    """

    times_s: list[float]
    joints: list[FloatArray]
    velocities: list[FloatArray]
    _grip_times_s: list[list[float]] = field(default_factory=list)
    _openings_m: list[list[float]] = field(default_factory=list)

    @staticmethod
    def at_rest(joints: FloatArray, arms: int) -> "JointTrajectory":
        """Return a trajectory of some arms that begins at their joints, shape (joints,), with all grippers open."""
        times, openings = [[0.0] for _ in range(arms)], [[OPEN_M] for _ in range(arms)]
        return JointTrajectory([0.0], [joints], [np.zeros_like(joints)], times, openings)

    @property
    def last(self) -> FloatArray:
        """The joints of the last keyframe (rad), shape (joints,)."""
        return self.joints[-1]

    def joints_at(self, times_s: FloatArray) -> FloatArray:
        """Return all arms' joints at some times (rad), shape (n,) -> (n, joints)."""
        return values_at(np.array(self.times_s), np.array(self.joints), np.array(self.velocities), times_s)

    def openings(self, arm: int) -> tuple[list[float], list[float]]:
        """Return a gripper's keyframes: their times (s) and openings (m)."""
        return self._grip_times_s[arm], self._openings_m[arm]

    def add(self, keyframes: Keyframes) -> None:
        """Add keyframes; skip those no later than the last."""
        for t, here, velocity in zip(keyframes.times_s.tolist(), keyframes.joints, keyframes.velocities, strict=True):
            if t > self.times_s[-1] + TIME_S:
                self.times_s.append(t)
                self.joints.append(here)
                self.velocities.append(velocity)

    def begin_closed(self, arm: int, opening_m: float) -> None:
        """Have a gripper hold cloth from the beginning, its fingers open by so much (m)."""
        self._openings_m[arm][0] = opening_m

    def close(self, arm: int, start_s: float, end_s: float, opening_m: float = CLOSED_M) -> None:
        """Close a gripper from one time to another, down to an opening (m)."""
        self._grip(arm, start_s, end_s, opening_m)

    def open(self, arm: int, start_s: float, end_s: float, opening_m: float = OPEN_M) -> None:
        """Open a gripper from one time to another, as far as to an opening (m)."""
        self._grip(arm, start_s, end_s, opening_m)

    def narrow(self, arm: int, opening_m: float, lasts_s: float, end_s: float) -> None:
        """Narrow an empty gripper for its next grip (m) as soon as it has let go, before an end (s).

        It opens only where it lets go.
        """
        start_s = self._grip_times_s[arm][-1]
        if self._openings_m[arm][-1] > opening_m and end_s - start_s > TIME_S:
            self._grip(arm, start_s, min(start_s + lasts_s, end_s), opening_m)

    def _grip(self, arm: int, start_s: float, end_s: float, opening_m: float) -> None:
        times, openings = self._grip_times_s[arm], self._openings_m[arm]
        if start_s > times[-1] + TIME_S:
            times.append(start_s)
            openings.append(openings[-1])
        times.append(end_s)
        openings.append(opening_m)
