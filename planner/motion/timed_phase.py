"""Phases with their real timing, and the time of a transit: base and cloth move while no hand holds cloth."""

import math
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from planner.geometry.keyframes import values_at
from planner.geometry.pose import FloatArray, Pose2, wrapped_angle
from planner.motion.lying_cloth import LyingCloth
from planner.primitives.drive_time import DriveTime
from planner.task.trajectory import Phase


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


@dataclass(frozen=True, slots=True, eq=False)
class TransitTime:
    """A time in which hands are empty.

    Attributes:
        timed_phases: the timed phases of base and cloth, one after the other.
        cloth: the cloth on the table meanwhile.
    """

    timed_phases: list[TimedPhase]
    cloth: LyingCloth

    @property
    def end_s(self) -> float:
        """The time at which it ends, if it begins at 0 (s)."""
        return sum(timed.duration_s for timed in self.timed_phases)

    @property
    def borders_s(self) -> tuple[float, ...]:
        """The times at which one step of the plan ends and the next begins (s)."""
        ends = np.cumsum([0.0, *(timed.duration_s for timed in self.timed_phases)]).tolist()
        return tuple(
            end
            for end, (one, other) in zip(ends[1:], pairwise(self.timed_phases), strict=False)
            if one.primitive != other.primitive
        )

    @property
    def is_driving(self) -> bool:
        """Whether the base drives."""
        return any(timed.phase.base[0] != timed.phase.base[1] for timed in self.timed_phases)

    @property
    def reach_s(self) -> float:
        """The duration of the reach at its end (s)."""
        return self.timed_phases[-1].duration_s

    @property
    def last(self) -> Pose2:
        """The base's pose at the end."""
        return self.timed_phases[-1].phase.base[1]

    def bases_at(self, times_s: FloatArray) -> FloatArray:
        """Return the base at each of some times: x (m), y (m), yaw (rad), shape (n,) -> (n, 3)."""
        ends = np.cumsum([0.0, *(timed.duration_s for timed in self.timed_phases)])
        which = np.searchsorted(ends[1:-1], times_s)
        bases = np.empty((len(times_s), 3))
        for number, timed in enumerate(self.timed_phases):
            own = which == number
            bases[own] = timed.bases_at(times_s[own] - ends[number])
        return bases

    def longer(self, by_s: float) -> "TransitTime":
        """Return the transit with a longer reach at its end (s)."""
        *driving, reach = self.timed_phases
        longer = TimedPhase.even(reach.primitive, reach.phase, reach.duration_s + by_s)
        return TransitTime([*driving, longer], self.cloth)

    def after_waiting(self, wait_s: float) -> "TransitTime":
        """Return the transit with a wait of the base before it (s), taken from the reach at its end.

        The wait is part of the first step.
        """
        *driving, reach = self.timed_phases
        first = self.timed_phases[0]
        waiting = TimedPhase.even(first.primitive, _resting(first.phase), wait_s)
        shorter = TimedPhase.even(reach.primitive, reach.phase, reach.duration_s - wait_s)
        return TransitTime([waiting, *driving, shorter], self.cloth)


def _resting(phase: Phase) -> Phase:
    """Return a phase in which everything stays as at the start of another."""
    cloth = phase.cloth
    return Phase(
        0.0,
        (phase.base[0], phase.base[0]),
        tuple(None for _ in phase.hands),
        type(cloth)(cloth.done, cloth.start, cloth.start, cloth.top, cloth.fold, (cloth.sweep[0], cloth.sweep[0])),
    )
