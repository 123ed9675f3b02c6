"""A phase with its real timing."""

import math
from dataclasses import dataclass, field

import numpy as np

from planner.geometry.keyframes import values_at
from planner.geometry.pose import FloatArray, wrapped_angle
from planner.primitives.drive_time import DriveTime
from planner.task.phase import Phase


def _evenly() -> FloatArray:
    return np.empty(0)


@dataclass(frozen=True, slots=True, eq=False)
class TimedPhase:
    """A phase, and its progress over time.

    Attributes:
        primitive: index of the primitive that it belongs to.
        phase: the phase.
        times_s: rising from 0 to its duration (s), shape (n,).
        fractions: the fraction of the phase that is done at each time, from 0 to 1, shape (n,).
        rates: its change for the cloth at each time, shape (n,), 1/s; empty: it goes on evenly.
        base_rates: its change for the base, alike.
    """

    primitive: int
    phase: Phase
    times_s: FloatArray
    fractions: FloatArray
    rates: FloatArray = field(default_factory=_evenly)
    base_rates: FloatArray = field(default_factory=_evenly)

    @staticmethod
    def even(primitive: int, phase: Phase, duration_s: float) -> "TimedPhase":
        """Return a phase that goes on evenly for a duration (s): one in which neither base nor cloth moves."""
        return TimedPhase(primitive, phase, np.array([0.0, duration_s]), np.array([0.0, 1.0]))

    @staticmethod
    def driven(primitive: int, phase: Phase, time: DriveTime) -> "TimedPhase":
        """Return a phase in which the base drives or turns from rest to rest in the least time, and nothing else moves.

        The phase itself may last less.
        """
        start, end = phase.base
        driven_m = math.dist((start.x_m, start.y_m), (end.x_m, end.y_m))
        turned_rad = abs(wrapped_angle(end.yaw_rad - start.yaw_rad))
        found = time.ramps(driven_m, turned_rad)
        rates = np.array(found.rates)
        return TimedPhase(primitive, phase, np.array(found.times_s), np.array(found.fractions), rates, rates)

    @property
    def duration_s(self) -> float:
        """The duration (s)."""
        return float(self.times_s[-1])

    def bases_at(self, times_s: FloatArray) -> FloatArray:
        """Return the base at times after its start (s), table frame: x (m), y (m), yaw (rad), shape (n,) -> (n, 3)."""
        start, end = self.phase.base
        shares = values_at(self.times_s, self.fractions, self.base_rates, times_s)[:, None]
        here = np.array([start.x_m, start.y_m, start.yaw_rad])
        way = np.array([end.x_m - start.x_m, end.y_m - start.y_m, wrapped_angle(end.yaw_rad - start.yaw_rad)])
        return np.asarray(here + shares * way)
