"""Keyframes of empty hands, and the straight lines of the hands to grips or from them."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from planner.geometry.pose import FloatArray
from planner.motion.path_timing import PathTiming


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
