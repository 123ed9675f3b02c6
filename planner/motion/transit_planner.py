"""Plan transits: keyframes for hands that let go and come to their next grips in time, while the base drives.

The hands withdraw straight from where they let go (the *tail* of the transfer before), travel, and come straight to the
next grips (the *lead* of the next transfer). If the straight path is not clear beside the moving base, they go home
first; if that is not clear either, the base waits until they are there.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from planner.geometry.pose import FloatArray
from planner.motion.joint_trajectory import JointTrajectory
from planner.motion.pacing import eased
from planner.motion.transit_paths import TransitPaths
from planner.motion.transit_time import TransitTime

_LEAD_S, _TAIL_S = 0.8, 0.6
"""The time in which hands come straight to their grips and withdraw, if there is enough of it (s)."""

_CHECK_S = 0.04
"""The time between moments at which empty hands beside a moving base are tested (s)."""

_CHECKS_MAX = 1000
"""The most moments tested: hands that take minutes for a path move less from one moment to the next."""

_KEYFRAMES = 12
"""The keyframes of an eased line of empty hands."""

_EASING = 0.3
"""The fraction of a line's time that is spent speeding up, and again slowing down, if there is time."""


class Keyframes(NamedTuple):
    """Joint positions of all arms over time.

    Attributes:
        times_s: rising, shape (n,).
        joints: all arms' joints at each time (rad), shape (n, joints).
    """

    times_s: FloatArray
    joints: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A straight line of the hands to grips or from them, as part of a transfer.

    Attributes:
        joints: all arms' joints (rad), shape (n, joints).
        least_s: the least time for each of its steps (s), shape (n - 1,).
    """

    joints: FloatArray
    least_s: FloatArray

    @property
    def shortest_s(self) -> float:
        """The least time for all of it (s)."""
        return float(self.least_s.sum())


class TransitPlanner:
    """Leads empty hands from transfer to transfer."""

    def __init__(self, transits: TransitPaths, dwell_s: float) -> None:
        """Keep the transit paths and the time that fingers take to close (s)."""
        self._dwell_s = dwell_s
        self._transits = transits

    def keyframes(self, free: TransitTime, tail: Line, lead: Line) -> tuple[TransitTime, Keyframes]:
        """Return the hands' keyframes from a tail to a lead, and the transit's time, changed if the base must wait."""
        keyframes = self._overlapping(free, tail, lead)
        return self._waiting(free, tail, lead) if keyframes is None else (free, keyframes)

    def _overlapping(self, free: TransitTime, tail: Line, lead: Line) -> Keyframes | None:
        """Return keyframes of hands that travel while the base drives; None if that is not clear."""
        for way in self._ways(free, tail, lead):
            # Beside a base that drives at once, hands that withdraw quickly are high before they have been swept along.
            for tail_s in (_TAIL_S, 0.0):
                keyframes = self._timed(free, tail, way, lead, tail_s)
                if keyframes is not None and self._is_clear(free, tail, keyframes):
                    return keyframes
        return None

    def _ways(self, free: TransitTime, tail: Line, lead: Line) -> Iterator[FloatArray]:
        """Yield paths from a tail to a lead: straight, free where the base will stand, by way of home.

        The second is looked for only once the first has failed, since that takes the most time.
        """
        start, goal = tail.joints[-1], lead.joints[0]
        yield np.array([start, goal])
        spared = self._transits.spared(tail.joints, lead.joints)
        found = self._transits.way(free.last, start, goal, free.cloth, spared)
        if found is not None:
            yield found
        yield np.array([start, self._transits.unwound(self._transits.home, start), goal])

    def _timed(self, free: TransitTime, tail: Line, way: FloatArray, lead: Line, tail_s: float) -> Keyframes | None:
        """Return keyframes that withdraw, travel and come to the grips in time; None if there is too little."""
        needed = self._transits.needed_s(way)
        arrives = free.end_s - self._dwell_s
        spare = arrives - free.start_s - (tail.shortest_s + lead.shortest_s + float(needed.sum()))
        if spare < 0.0:
            return None
        out = _stretched(tail.least_s, min(tail_s, tail.shortest_s + spare / 4))
        down = _stretched(lead.least_s, min(_LEAD_S, lead.shortest_s + spare / 4))
        leaves, comes = free.start_s + float(out.sum()), arrives - float(down.sum())
        travel_t, travel = _travel(way, needed, leaves, comes)
        times = [free.start_s + np.cumsum(out), travel_t, comes + np.cumsum(down), np.array([free.end_s])]
        return _keyframes(times, tail, [travel], lead)

    def _is_clear(self, free: TransitTime, tail: Line, keyframes: Keyframes) -> bool:
        """Return whether hands that go on from a tail touch nothing while the base drives, nor pass low over cloth."""
        track = JointTrajectory([free.start_s], [tail.joints[0]])
        track.add(keyframes.times_s, keyframes.joints)
        count = min(int(np.ceil((free.end_s - free.start_s) / _CHECK_S)), _CHECKS_MAX)
        moments = np.linspace(free.start_s, free.end_s, count + 1)
        bases, there = free.bases_at(moments), track.joints_at(moments)
        return self._transits.is_clear(free.cloth, bases, there)

    def _waiting(self, free: TransitTime, tail: Line, lead: Line) -> tuple[TransitTime, Keyframes]:
        """Return keyframes for a base that waits until the hands are home; they set out again when it has arrived.

        The waiting is taken from the reach, which lasts long enough for both: see `ReachTime`.
        """
        home = self._transits.unwound(self._transits.home, tail.joints[-1])
        first, last = free.first, free.last
        away = self._transits.way(first, tail.joints[-1], home, free.cloth, self._transits.spared(tail.joints, None))
        if away is None and np.array_equal(tail.joints[-1], home):  # Already at home, at a table as high as the hands.
            away = np.array([home, home])
        back = self._transits.way(last, home, lead.joints[0], free.cloth, self._transits.spared(None, lead.joints))
        assert away is not None and back is not None, (
            "a transfer that was validated can be left and reached by way of home"
        )
        leave_s, back_s = self._transits.needed_s(away), self._transits.needed_s(back)
        wait_s = tail.shortest_s + float(leave_s.sum())
        waited = free.after_waiting(wait_s)
        arrives = waited.end_s - self._dwell_s
        begins = arrives - (lead.shortest_s + float(back_s.sum()))
        travel = [
            _travel(away, leave_s, waited.start_s + tail.shortest_s, waited.start_s + wait_s),
            (np.array([begins]), home[None]),
            _travel(back, back_s, begins, arrives - lead.shortest_s),
        ]
        come = travel[-1][0][-1] + np.cumsum(lead.least_s)
        times = [waited.start_s + np.cumsum(tail.least_s), *(t for t, _ in travel), come, np.array([waited.end_s])]
        return waited, _keyframes(times, tail, [joints for _, joints in travel], lead)


def _keyframes(times: list[FloatArray], tail: Line, travel: list[FloatArray], lead: Line) -> Keyframes:
    """Return keyframes on a tail, on the path from it to a lead, on that, and once more at its end."""
    joints = np.concatenate([tail.joints[1:], *travel, lead.joints[1:], lead.joints[-1:]])
    return Keyframes(np.concatenate(times), joints)


def _travel(way: FloatArray, needed: FloatArray, start: float, end: float) -> tuple[FloatArray, FloatArray]:
    """Return keyframes along a path, each of its lines eased."""
    total = float(needed.sum())
    if total <= 0.0:
        return np.array([end]), way[-1:]
    pace = (end - start) / total
    easing = min(_EASING, max(0.0, 1.0 - 1.0 / pace))
    shares = np.linspace(0.0, 1.0, _KEYFRAMES + 1)[1:]
    times, joints = [], []
    for (a, b), begin, need in zip(pairwise(way), np.cumsum(needed) - needed, needed, strict=True):
        times.append(start + pace * (begin + shares * need))
        joints.append(a + eased(shares, easing)[:, None] * (b - a))
    return np.concatenate(times), np.concatenate(joints)


def _stretched(steps_s: FloatArray, total_s: float) -> FloatArray:
    """Return the steps lengthened to a total duration, none of them shorter than it needs (s)."""
    if not len(steps_s):
        return steps_s
    return np.asarray(steps_s + max(0.0, total_s - float(steps_s.sum())) / len(steps_s))
