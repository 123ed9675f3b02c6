"""All that robot and cloth do, from runs and moves: cues for base and cloth, one track for the arms.

While cloth is held the joints are those of the runs. Between two runs the hands are free: they withdraw from where
they let go, travel, and come straight to the next grips, while the base drives. If the straight way will not do beside
the moving base, they go home first; if that will not do either, the base waits until they are there.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np

from planner.geometry.pose import FloatArray
from planner.plan.act import Act
from planner.plan.cue import Cue
from planner.plan.joint_track import JointTrack
from planner.plan.machine import Collisions
from planner.plan.pacing import eased
from planner.plan.real_run import RealRun, pose_of
from planner.plan.transits import Transits
from planner.primitives.phase import Phase

_LEAD_S, _TAIL_S = 0.8, 0.6
"""How long hands take to come straight to their grips and to withdraw, if there is time (s)."""

_GRASP_S, _HELD_S = 0.3, 0.1
"""How long hands rest at their grips before the cloth moves, if there is time; the last part of it shut (s)."""

_CHECK_S = 0.04
"""How far apart moments are at which free hands beside a moving base are checked (s)."""

_KEYFRAMES = 12
"""Into how many keyframes an eased line of free hands is cut."""

_EASING = 0.3


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


@dataclass(frozen=True, slots=True, eq=False)
class _Window:
    """A time in which hands are free: what base and cloth do then, and when it begins."""

    cues: list[Cue]
    start_s: float

    @property
    def end_s(self) -> float:
        return self.start_s + sum(cue.duration_s for cue in self.cues)

    def base_at(self, t_s: float) -> FloatArray:
        """Where the base is at a time: x (m), y (m), yaw (rad)."""
        start = self.start_s
        for cue in self.cues[:-1]:
            if t_s <= start + cue.duration_s:
                break
            start += cue.duration_s
        else:
            cue = self.cues[-1]
        pose = cue.base_at(t_s - start)
        return np.array([pose.x_m, pose.y_m, pose.yaw_rad])


class FilmMaker:
    """Puts runs and moves together."""

    def __init__(self, transits: Transits, collisions: Collisions) -> None:
        """A maker for one robot, who knows its ways."""
        self._transits = transits
        self._collisions = collisions
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
            extra = run.late_s[0] if any(phase.hands) else 0.0
            self._free.append(Cue.even(primitive, phase, phase.duration_s + extra))
        self._reach(run)
        held = self._now
        for cue in run.cues:
            self._cues.append(Cue(primitive + cue.primitive, cue.phase, cue.times_s, cue.fractions))
        self._track.add(held + run.times_s, run.carried.joints[run.carried.first : run.carried.last + 1] + self._turns)
        is_held = run.carried.moments.is_held
        for arm in np.flatnonzero(run.carried.is_used):
            self._track.close(int(arm), held - _HELD_S)
            self._track.open(int(arm), held + float(run.times_s[np.flatnonzero(is_held[arm])[-1]]))
        self._now = held + float(run.times_s[-1])
        self._before = run
        self._free = [self._still(run.late_s[1])] if run.late_s[1] > 0.0 else []

    def _still(self, duration_s: float) -> Cue:
        """So long after the last cue, with nothing that moves."""
        last = self._cues[-1]
        return Cue(last.primitive, last.phase, np.array([0.0, duration_s]), np.array([1.0, 1.0]))

    def _reach(self, run: RealRun) -> None:
        """Everything until a run's grips are reached."""
        goal = self._transits.unwound(run.carried.joints[0], self._tail()[0][-1])
        self._turns = goal - run.carried.joints[0]
        lead = run.carried.joints[: run.carried.first + 1] + self._turns
        window = _Window(self._free, self._now)
        keyframes = self._overlapping(window, lead, run)
        if keyframes is None:
            window, keyframes = self._waiting(window, lead, run)
        self._track.add(*keyframes)
        self._cues += window.cues
        self._now = window.end_s

    def _overlapping(self, window: _Window, lead: FloatArray, run: RealRun) -> tuple[FloatArray, FloatArray] | None:
        """Keyframes of hands that travel while the base drives; None if that would not be free."""
        tail, tail_s = self._tail()
        ways = [np.array([tail[-1], lead[0]])]
        home = self._transits.unwound(self._transits.home, tail[-1])
        found = self._transits.way(pose_of(window.base_at(window.end_s)), tail[-1], lead[0])
        if found is not None:
            ways.append(found)
        ways.append(np.array([tail[-1], home, lead[0]]))
        for way in ways:
            keyframes = self._timed(window, tail, tail_s, way, lead, run.lead_s)
            if keyframes is not None and self._is_free(window, *keyframes):
                return keyframes
        return None

    def _tail(self) -> tuple[FloatArray, FloatArray]:
        """The way on which the hands withdraw from the run before, and the least time for its steps."""
        if self._before is None:
            return self._track.last[None], np.empty(0)
        joints = self._before.carried.joints[self._before.carried.last :]
        return joints + (self._track.last - joints[0]), self._before.tail_s

    def _timed(
        self,
        window: _Window,
        tail: FloatArray,
        tail_s: FloatArray,
        way: FloatArray,
        lead: FloatArray,
        lead_s: FloatArray,
    ) -> tuple[FloatArray, FloatArray] | None:
        """Keyframes that withdraw, go a way and come to the grips within a window; None if that is too short."""
        needed = self._transits.needed_s(way)
        spare = window.end_s - window.start_s - float(tail_s.sum() + lead_s.sum() + needed.sum())
        if spare < 0.0:
            return None
        out = _stretched(tail_s, min(_TAIL_S, float(tail_s.sum()) + spare / 4))
        down = _stretched(lead_s, min(_LEAD_S, float(lead_s.sum()) + spare / 4))
        arrives = window.end_s - min(_GRASP_S, spare / 4)
        leaves, comes = window.start_s + float(out.sum()), arrives - float(down.sum())
        travel_t, travel = self._travel(way, needed, leaves, comes)
        times = [window.start_s + np.cumsum(out), travel_t, comes + np.cumsum(down), np.array([window.end_s])]
        return np.concatenate(times), np.concatenate([tail[1:], travel, lead[1:], lead[-1:]])

    def _travel(self, way: FloatArray, needed: FloatArray, start: float, end: float) -> tuple[FloatArray, FloatArray]:
        """Keyframes along a way, each of its lines eased."""
        total = float(needed.sum())
        if total <= 0.0:
            return np.array([end]), way[-1:]
        pace = (end - start) / total
        easing = min(_EASING, max(0.0, 1.0 - 1.0 / pace))
        shares = np.linspace(0.0, 1.0, _KEYFRAMES + 1)[1:]
        times, joints = [], []
        for (a, b), begin, need in zip(pairwise(way), np.cumsum(needed) - needed, needed, strict=True):
            times.append(start + pace * (begin + shares * need))
            joints.append(a + eased(shares, easing)[:, None, None] * (b - a))
        return np.concatenate(times), np.concatenate(joints)

    def _is_free(self, window: _Window, times: FloatArray, joints: FloatArray) -> bool:
        """Whether keyframes are free of collisions, the base where it is then."""
        track = JointTrack([window.start_s], [self._track.last])
        track.add(times, joints)
        count = int(np.ceil((window.end_s - window.start_s) / _CHECK_S))
        moments = np.linspace(window.start_s, window.end_s, count + 1)
        bases = np.array([window.base_at(t) for t in moments])
        there = np.array([track.joints_at(t) for t in moments])
        return bool(self._collisions.free(bases, there).all())

    def _waiting(
        self, window: _Window, lead: FloatArray, run: RealRun
    ) -> tuple[_Window, tuple[FloatArray, FloatArray]]:
        """The base waits until the hands are home; they set out again when it has arrived.

        What it waits is taken from the reach, which lasts long enough for both: see `RealRun.late_s`.
        """
        tail, tail_s = self._tail()
        home = self._transits.unwound(self._transits.home, tail[-1])
        first, last = pose_of(window.base_at(window.start_s)), pose_of(window.base_at(window.end_s))
        away = self._transits.way(first, tail[-1], home)
        back = self._transits.way(last, home, lead[0])
        assert away is not None and back is not None, "a run that was made real can be left and reached by way of home"
        leave_s, back_s = self._transits.needed_s(away), self._transits.needed_s(back)
        wait_s = float(tail_s.sum() + leave_s.sum())
        *driving, reach = window.cues
        waiting = Cue(reach.primitive, _resting(window.cues[0].phase), np.array([0.0, wait_s]), np.array([0.0, 1.0]))
        waited = _Window(
            [waiting, *driving, Cue.even(reach.primitive, reach.phase, reach.duration_s - wait_s)], window.start_s
        )
        begins = waited.end_s - float(run.lead_s.sum() + back_s.sum())
        travel = [
            self._travel(away, leave_s, waited.start_s + float(tail_s.sum()), waited.start_s + wait_s),
            (np.array([begins]), home[None]),
            self._travel(back, back_s, begins, waited.end_s - float(run.lead_s.sum())),
        ]
        times = [waited.start_s + np.cumsum(tail_s), *(t for t, _ in travel), travel[-1][0][-1] + np.cumsum(run.lead_s)]
        joints = [tail[1:], *(j for _, j in travel), lead[1:]]
        return waited, (np.concatenate(times), np.concatenate(joints))


def _resting(phase: Phase) -> Phase:
    """A phase in which everything is as at the start of another."""
    cloth = phase.cloth
    return Phase(
        0.0,
        (phase.base[0], phase.base[0]),
        tuple(None for _ in phase.hands),
        type(cloth)(cloth.done, cloth.start, cloth.start, cloth.top, cloth.fold, (cloth.sweep[0], cloth.sweep[0])),
    )


def _stretched(steps_s: FloatArray, total_s: float) -> FloatArray:
    """Steps that take so long together, none of them less than it needs (s)."""
    if not len(steps_s):
        return steps_s
    return np.asarray(steps_s + max(0.0, total_s - float(steps_s.sum())) / len(steps_s))
