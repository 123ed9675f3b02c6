"""The time of a transit: the motion of base and cloth while no hand holds cloth."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from planner.geometry.pose import FloatArray, Pose2
from planner.motion.lying_cloth import LyingCloth
from planner.motion.timed_phase import TimedPhase
from planner.task.phase import Phase


@dataclass(frozen=True, slots=True, eq=False)
class TransitTime:
    """A time in which hands are empty.

    Attributes:
        timed_phases: the timed phases of base and cloth, one after the other.
        start_s: when it begins (s).
        cloth: the cloth on the table meanwhile.
    """

    timed_phases: list[TimedPhase]
    start_s: float
    cloth: LyingCloth

    @property
    def end_s(self) -> float:
        """The time at which it ends (s)."""
        return self.start_s + sum(timed.duration_s for timed in self.timed_phases)

    @property
    def borders_s(self) -> tuple[float, ...]:
        """The times at which one step of the plan ends and the next begins (s)."""
        ends = np.cumsum([self.start_s, *(timed.duration_s for timed in self.timed_phases)]).tolist()
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
    def first(self) -> Pose2:
        """The base's pose at the beginning."""
        return self.timed_phases[0].phase.base[0]

    @property
    def last(self) -> Pose2:
        """The base's pose at the end."""
        return self.timed_phases[-1].phase.base[1]

    def bases_at(self, times_s: FloatArray) -> FloatArray:
        """Return the base at each of some times: x (m), y (m), yaw (rad), shape (n,) -> (n, 3)."""
        ends = np.cumsum([self.start_s, *(timed.duration_s for timed in self.timed_phases)])
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
        return TransitTime([*driving, longer], self.start_s, self.cloth)

    def after_waiting(self, wait_s: float) -> "TransitTime":
        """Return the transit with a wait of the base before it (s), taken from the reach at its end.

        The wait is part of the first step.
        """
        *driving, reach = self.timed_phases
        first = self.timed_phases[0]
        waiting = TimedPhase.even(first.primitive, _resting(first.phase), wait_s)
        shorter = TimedPhase.even(reach.primitive, reach.phase, reach.duration_s - wait_s)
        return TransitTime([waiting, *driving, shorter], self.start_s, self.cloth)


def _resting(phase: Phase) -> Phase:
    """Return a phase in which everything stays as at the start of another."""
    cloth = phase.cloth
    return Phase(
        0.0,
        (phase.base[0], phase.base[0]),
        tuple(None for _ in phase.hands),
        type(cloth)(cloth.done, cloth.start, cloth.start, cloth.top, cloth.fold, (cloth.sweep[0], cloth.sweep[0])),
    )
