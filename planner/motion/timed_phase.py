"""A phase with its real timing."""

from dataclasses import dataclass

import numpy as np

from planner.geometry.pose import FloatArray, Pose2
from planner.task.phase import Phase


@dataclass(frozen=True, slots=True, eq=False)
class TimedPhase:
    """A phase, and its progress over time.

    Attributes:
        primitive: index of the primitive that it belongs to.
        phase: the phase.
        times_s: rising from 0 to its duration (s), shape (n,).
        fractions: the fraction of the phase that is done at each time, from 0 to 1, shape (n,).
    """

    primitive: int
    phase: Phase
    times_s: FloatArray
    fractions: FloatArray

    @staticmethod
    def even(primitive: int, phase: Phase, duration_s: float) -> "TimedPhase":
        """Return a phase that goes on evenly for a duration (s)."""
        return TimedPhase(primitive, phase, np.array([0.0, duration_s]), np.array([0.0, 1.0]))

    @property
    def duration_s(self) -> float:
        """The duration (s)."""
        return float(self.times_s[-1])

    def fraction_at(self, t_s: float) -> float:
        """Return the fraction of the phase that is done a time after its start (s)."""
        return float(np.interp(t_s, self.times_s, self.fractions))

    def base_at(self, t_s: float) -> Pose2:
        """Return the base's pose a time after its start (s), table frame."""
        return self.phase.base[0].between(self.phase.base[1], self.fraction_at(t_s))
