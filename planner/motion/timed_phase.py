"""A phase with its real timing."""

from dataclasses import dataclass

import numpy as np

from planner.geometry.pose import FloatArray, wrapped_angle
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

    def bases_at(self, times_s: FloatArray) -> FloatArray:
        """Return the base at times after its start (s), table frame: x (m), y (m), yaw (rad), shape (n,) -> (n, 3)."""
        start, end = self.phase.base
        shares = np.interp(times_s, self.times_s, self.fractions)[:, None]
        here = np.array([start.x_m, start.y_m, start.yaw_rad])
        way = np.array([end.x_m - start.x_m, end.y_m - start.y_m, wrapped_angle(end.yaw_rad - start.yaw_rad)])
        return np.asarray(here + shares * way)
