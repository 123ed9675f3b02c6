"""All that robot and cloth do, from runs and moves: cues for base and cloth, one track for the arms.

While cloth is held the joints are those of the runs. Between two runs the hands are free, and the base drives (see
`planner.plan.free_hands`).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from planner.geometry.pose import FloatArray
from planner.plan.act import Act
from planner.plan.cue import Cue
from planner.plan.free_hands import FreeHands, Line
from planner.plan.free_time import FreeTime
from planner.plan.joint_track import JointTrack
from planner.plan.machine import Collisions
from planner.plan.real_run import RealRun
from planner.plan.transits import Transits
from planner.primitives.phase import Phase


@dataclass(frozen=True, slots=True, eq=False)
class Film:
    """What happens.

    Attributes:
        cues: what base and cloth do, one after the other.
        starts_s: when each begins (s).
        track: what the arms do.
    """

    cues: tuple[Cue, ...]
    starts_s: tuple[float, ...]
    track: JointTrack


class FilmMaker:
    """Puts runs and moves together."""

    def __init__(self, transits: Transits, collisions: Collisions, dwell_s: float) -> None:
        """A maker for one robot, who knows its ways and how long its fingers take to close and to open (s)."""
        self._transits = transits
        self._dwell_s = dwell_s
        self._hands = FreeHands(transits, collisions, dwell_s)
        self._track = JointTrack.at_rest(transits.home)
        self._cues: list[Cue] = []
        self._free: list[Cue] = []
        self._now = 0.0
        self._before: RealRun | None = None
        self._turns: FloatArray = np.zeros_like(transits.home)

    def film(self, acts: Sequence[Act], rest: Phase) -> Film:
        """The film of a plan's acts; `rest` is all there is to see if there are none."""
        for act in acts:
            if act.run is not None:
                self._run(act.first, act.run)
                continue
            for number, step in enumerate(act.steps):
                lasting = (phase for phase in step.phases() if phase.duration_s > 0.0)
                self._free += [Cue.even(act.first + number, phase, phase.duration_s) for phase in lasting]
        self._cues += self._free
        if not self._cues:
            self._cues.append(Cue.even(0, rest, 0.0))
        starts = accumulate((cue.duration_s for cue in self._cues), initial=0.0)
        return Film(tuple(self._cues), tuple(starts)[:-1], self._track)

    def _run(self, primitive: int, run: RealRun) -> None:
        for phase in run.free_phases:
            extra = run.reach_late_s if any(phase.hands) else 0.0
            self._free.append(Cue.even(primitive, phase, phase.duration_s + extra))
        self._reach(run)
        held = self._now
        timing = run.timing
        for cue in timing.cues:
            self._cues.append(Cue(primitive + cue.primitive, cue.phase, cue.times_s, cue.fractions))
        self._track.add(held + timing.times_s, run.carried.joints[run.carried.first + timing.moments] + self._turns)
        is_last = run.carried.moments.is_last_held
        for arm in np.flatnonzero(run.carried.moments.is_used).tolist():
            opens = held + timing.first_s(int(np.argmax(is_last[arm])))
            self._track.close(arm, held - self._dwell_s, held)
            self._track.open(arm, opens, opens + self._dwell_s)
        self._now = held + float(timing.times_s[-1])
        self._before = run
        self._free = []

    def _reach(self, run: RealRun) -> None:
        """Everything until a run's grips are reached."""
        tail, start = self._tail(), run.carried.joints[0]
        self._turns = self._transits.unwound(start, tail.joints[-1]) - start
        lead = Line(run.carried.joints[: run.carried.first + 1] + self._turns, run.lead_s)
        between = FreeTime(self._free, self._now, run.carried.cloths[0])
        free, keyframes = self._hands.keyframes(between, tail, lead)
        self._track.add(keyframes.times_s, keyframes.joints)
        self._cues += free.cues
        self._now = free.end_s

    def _tail(self) -> Line:
        """The way on which the hands withdraw from the run before."""
        if self._before is None:
            return Line(self._track.last[None], np.empty(0))
        joints = self._before.carried.joints[self._before.carried.last :]
        return Line(joints + (self._track.last - joints[0]), self._before.tail_s)
