"""A phase as it is really timed."""

from dataclasses import dataclass

import numpy as np

from planner.geometry.pose import FloatArray, Pose2
from planner.task.phase import Phase


@dataclass(frozen=True, slots=True, eq=False)
class TimedPhase:
    """A phase, and how much of it is done when.

    Attributes:
        primitive: index of the primitive that it belongs to.
        phase: what happens.
        times_s: rising from 0 to the cue's duration (s), shape (n,).
        fractions: how much of the phase is done then, from 0 to 1, shape (n,).
    """

    primitive: int
    phase: Phase
    times_s: FloatArray
    fractions: FloatArray

    @staticmethod
    def even(primitive: int, phase: Phase, duration_s: float) -> "TimedPhase":
        """A phase that goes on evenly for so long (s)."""
        return TimedPhase(primitive, phase, np.array([0.0, duration_s]), np.array([0.0, 1.0]))

    @property
    def duration_s(self) -> float:
        """How long it takes (s)."""
        return float(self.times_s[-1])

    def fraction_at(self, t_s: float) -> float:
        """How much of the phase is done a time after its start (s)."""
        return float(np.interp(t_s, self.times_s, self.fractions))

    def base_at(self, t_s: float) -> Pose2:
        """Where the base is then, table frame."""
        return self.phase.base[0].between(self.phase.base[1], self.fraction_at(t_s))
