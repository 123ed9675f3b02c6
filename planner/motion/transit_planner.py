"""Plan transits: keyframes for hands that let go and come to their next grips in time, while the base drives.

The hands withdraw straight from where they let go (the *retreat* of the transfer before), travel, and come straight to
the next grips (the *approach* of the next transfer). If the straight path is not clear beside the moving base, the base
waits until they have withdrawn, or they go home first; if that is not clear either, the base waits until they are
there. Where hands come late nevertheless, their lines are smoothed, without the kinks that slow them down and without
stops at corners, and `sooner` takes shortcuts, one arm at a time.
"""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.tolerance import TIME_S
from planner.motion.hand_holds import settling_s
from planner.motion.joint_trajectory import JointTrajectory, Keyframes, Line
from planner.motion.path_shortcuts import PARTS, places, shortcuts
from planner.motion.smoothing import smoothed
from planner.motion.timed_phase import TransitTime
from planner.motion.transit_paths import TransitPaths
from planner.robots.card import EDGE_OPEN_M, HELD_M, OPENING_M

_APPROACH_S, _RETREAT_S = 0.8, 0.6
"""The time in which hands come straight to their grips and withdraw, if there is enough of it (s)."""

_CHECK_S = 0.02
"""The time between moments at which empty hands are tested (s): between them joints turn about evenly."""

_CHECKS_MAX = 1000
"""The most waypoints tested: hands that take minutes for a path move less from one moment to the next."""

_STRAIGHTENED = 4
"""How often the difference between a path that takes too long and the straight one is halved."""

_SHORTCUTS_MAX = 60
"""The most shortcuts tested for a transit."""

_GAIN_S = 0.02
"""The least time by which a shortcut must be quicker, unless hands are in time then (s)."""


class _Late(NamedTuple):
    """A run that takes longer than there is time.

    Attributes:
        late_s: by how much (s).
        run: returns its keyframes in a transit that lasts so much longer, None if that is not clear.
        way: its path between retreat and approach, shape (n, joints), rad.
        along: returns the run that is made alike along another path.
    """

    late_s: float
    run: Callable[[TransitTime], Keyframes | None]
    way: FloatArray
    along: Callable[[FloatArray], "_Late"]


class _Homeward(NamedTuple):
    """The way home from a retreat and the way from home to an approach.

    Attributes:
        away, back: the two paths, shape (n, joints), rad.
        leave_s, back_s: the least time for each of their lines (s).
        wait_s: the time after which the hands are home, the retreat included (s).
        late_s: the time by which the hands come late if the base waits for them (s).
    """

    away: FloatArray
    leave_s: FloatArray
    back: FloatArray
    back_s: FloatArray
    wait_s: float
    late_s: float


class TransitPlanner:
    """Leads empty hands from transfer to transfer.

    Attributes:
        dwell_s: the time that fingers take to close, with the arms at rest (s).
    """

    def __init__(self, transits: TransitPaths, dwell_s: float) -> None:
        """Keep the transit paths and the time that fingers take to close (s)."""
        self.dwell_s = dwell_s
        self._transits = transits

    def keyframes(
        self,
        free: TransitTime,
        retreat: Line | None,
        approach: Line,
        going: FloatArray | None,
        coming: FloatArray | None,
    ) -> tuple[TransitTime, Keyframes]:
        """Return the hands' keyframes from a retreat, or from home, to an approach, and its time.

        That has changed where the base must wait, or where the hands need longer: then by as little as was found. They
        may end whole turns of endless joints away from the approach.

        Args:
            free: the time of the transit.
            retreat: where they come from; None: the hands are at home.
            approach: where they go to.
            going: the way home from the retreat, shape (n, joints), rad; None where there is no retreat.
            coming: the way from home to the approach, alike.
        """
        if retreat is None:
            retreat = self._transits.line(self._transits.home[None])
        start = approach.joints[0]
        approach = approach.moved(self._transits.unwound(start, retreat.joints[-1]) - start)
        late: list[_Late] = []
        for way in self._ways(free, retreat, approach):
            late_s = self._late_s(free, retreat, way, approach)
            if late_s > TIME_S:
                late += self._quicker(free, retreat, way, approach)
            elif found := self._first_clear(
                free, retreat, approach, partial(self._overlapping, retreat, way, approach)
            ):
                return found
        waiting = self._homeward(free, retreat, approach, going, coming)
        if waiting.late_s > TIME_S:
            turned = approach.moved(waiting.back[-1] - approach.joints[0])
            late += self._quicker(free, retreat, np.concatenate([waiting.away, waiting.back[1:]]), turned)
        for one in sorted(late, key=lambda one: one.late_s):
            if one.late_s >= waiting.late_s:
                break
            found = self._first_clear(free.longer(one.late_s), retreat, approach, one.run)
            if found is not None:
                return self._straightened(free, retreat, approach, one) or found
        return self._waiting(free.longer(waiting.late_s), retreat, approach, waiting)

    def sooner(
        self, free: TransitTime, retreat: Line | None, approach: Line, late: tuple[TransitTime, Keyframes]
    ) -> tuple[TransitTime, Keyframes]:
        """Return a quicker transit than a late one, by shortcuts on its path; the late one itself if none is found.

        Args:
            free: the time of the transit.
            retreat: where they come from; None: the hands are at home.
            approach: where they go to.
            late: what `keyframes` has returned.
        """
        if free.borders_s:
            return late
        if retreat is None:
            retreat = self._transits.line(self._transits.home[None])
        path = _path(retreat, approach, late[1], late[0].end_s - self.dwell_s)
        approach = approach.moved(path[-1] - approach.joints[-1])
        least_s, left, layout = late[0].end_s - free.end_s, _SHORTCUTS_MAX, self._transits.layout
        begun_s = least_s
        for parts in PARTS:
            if parts != PARTS[0] and least_s == begun_s:
                break  # where the longest shortcuts are all in vain, mostly the shorter ones are, too
            for place in places(path, layout, parts, free_rows(path, retreat, approach)):
                for tried in shortcuts(path, layout, place):
                    if least_s <= TIME_S or left == 0:
                        return late
                    line = smoothed_line(self._transits, tried, retreat, approach, BLENDED[0])
                    late_s = max(line.shortest_s - self._time_s(free), 0.0)
                    if late_s > max(least_s - _GAIN_S, 0.0):
                        continue
                    left -= 1
                    run = partial(self._along, line, retreat, approach)
                    found = self._first_clear(free.longer(late_s), retreat, approach, run)
                    if found is not None:
                        path, least_s, late = tried, late_s, found
                        break
        return late

    def _first_clear(
        self, free: TransitTime, retreat: Line, approach: Line, run: Callable[[TransitTime], Keyframes | None]
    ) -> tuple[TransitTime, Keyframes] | None:
        """Return time and keyframes of a clear run, with a base that drives at once or after the hands withdrew.

        A base that drives at once may sweep hands along that are still low. The wait is taken from the reach, of which
        enough must be left for coming to the grips. None if neither is clear.
        """
        times = [free]
        if free.is_driving and retreat.shortest_s + approach.shortest_s + self.dwell_s <= free.reach_s:
            times.append(free.after_waiting(retreat.shortest_s))
        return next(((time, keyframes) for time in times if (keyframes := run(time)) is not None), None)

    def _straightened(
        self, free: TransitTime, retreat: Line, approach: Line, late: _Late
    ) -> tuple[TransitTime, Keyframes] | None:
        """Return a clear run alike, as near to the straight path as is found by halving; None if none is quicker."""
        lengths = np.append(0.0, np.cumsum(self._transits.needed_s(late.way)))
        straight = late.way[0] + (lengths / max(lengths[-1], TIME_S))[:, None] * (late.way[-1] - late.way[0])
        low, high, quicker, least_s = 0.0, 1.0, None, late.late_s
        for _ in range(_STRAIGHTENED):
            if least_s <= TIME_S or len(late.way) < 3:
                break
            share = 0.5 * (low + high)
            tried = late.along(straight + share * (late.way - straight))
            found = None
            if tried.late_s < least_s - TIME_S:
                found = self._first_clear(free.longer(tried.late_s), retreat, approach, tried.run)
            if found is None:
                low = share
            else:
                high, quicker, least_s = share, found, tried.late_s
        return quicker

    def _quicker(self, free: TransitTime, retreat: Line, way: FloatArray, approach: Line) -> Iterator["_Late"]:
        """Yield runs along a path that takes too long: as it is, with smooth lines, and without stops at corners."""
        smoothed_ends = (
            _smoothed(self._transits, retreat, _STRAIGHT, 0),
            _smoothed(self._transits, approach, 0, _STRAIGHT),
        )
        for ends in ((retreat, approach), smoothed_ends):
            yield self._stopping(free, *ends, way)
        if not free.borders_s:
            for passes in BLENDED:
                yield self._blended(free, retreat, approach, passes, way)

    def _stopping(self, free: TransitTime, retreat: Line, approach: Line, way: FloatArray) -> "_Late":
        return _Late(
            self._late_s(free, retreat, way, approach),
            partial(self._overlapping, retreat, way, approach),
            way,
            partial(self._stopping, free, retreat, approach),
        )

    def _blended(self, free: TransitTime, retreat: Line, approach: Line, passes: int, way: FloatArray) -> "_Late":
        path = joined(retreat.joints, way, approach.joints)
        line = smoothed_line(self._transits, path, retreat, approach, passes)
        return _Late(
            max(line.shortest_s - self._time_s(free), 0.0),
            partial(self._along, line, retreat, approach),
            way,
            partial(self._blended, free, retreat, approach, passes),
        )

    def _along(self, line: Line, retreat: Line, approach: Line, free: TransitTime) -> Keyframes | None:
        """Return keyframes along one line that joins a retreat and an approach; None if that is not clear."""
        run = line.over(self._time_s(free))
        times = np.append(0.0, run.times_s)
        ends_s = (float(times[len(retreat.joints) - 1]), float(times[-len(approach.joints)]))
        keyframes = Keyframes.joined([run, self._still(approach, line.joints[-1], free.end_s)])
        return keyframes if self._is_clear(free, retreat, keyframes, approach, ends_s) else None

    def _still(self, approach: Line, joints: FloatArray, end_s: float) -> Keyframes:
        """Return keyframes of hands at rest at the end of an approach, which at last go on to their grips."""
        if approach.at_grips is None:
            return Keyframes.still(joints, end_s)
        begins_s = end_s - settling_s(self.dwell_s)
        settled = self._transits.eased(joints, approach.at_grips, end_s - begins_s).later(begins_s)
        return Keyframes.joined([Keyframes.still(joints, begins_s), settled])

    def _time_s(self, free: TransitTime) -> float:
        """Return the time in which hands can move (s)."""
        return free.end_s - self.dwell_s

    def _overlapping(self, retreat: Line, way: FloatArray, approach: Line, free: TransitTime) -> Keyframes | None:
        """Return keyframes of hands that travel along a path while the base drives; None if that is not clear."""
        # Beside a base that drives at once, hands that withdraw quickly are high before they have been swept along.
        for retreat_s in (_RETREAT_S, 0.0):
            timed = self._timed(free, retreat, way, approach, retreat_s)
            if timed is not None and self._is_clear(free, retreat, timed[0], approach, timed[1]):
                return timed[0]
        return None

    def _late_s(self, free: TransitTime, retreat: Line, way: FloatArray, approach: Line) -> float:
        """Return the time by which the hands would come late along a path (s)."""
        needed_s = retreat.shortest_s + approach.shortest_s + float(self._transits.needed_s(way).sum())
        return max(needed_s - self._time_s(free), 0.0)

    def _ways(self, free: TransitTime, retreat: Line, approach: Line) -> Iterator[FloatArray]:
        """Yield paths from a retreat to an approach: straight, free where the base will stand, by way of home.

        The second is looked for only once the first has failed, since that takes the most time.
        """
        start, goal = retreat.joints[-1], approach.joints[0]
        yield np.array([start, goal])
        spared = self._transits.spared(retreat.joints, approach.joints)
        found = self._transits.way(free.last, start, goal, free.cloth, spared, samples=False)
        if found is not None:
            yield found
        yield np.array([start, self._transits.unwound(self._transits.home, start), goal])

    def _timed(
        self, free: TransitTime, retreat: Line, way: FloatArray, approach: Line, retreat_s: float
    ) -> tuple[Keyframes, tuple[float, float]] | None:
        """Return keyframes that withdraw, travel and come to the grips in time, and when the travel begins and ends.

        There must be time enough; None where none is left for resting between the plan's steps.
        """
        needed = self._transits.needed_s(way)
        arrives = free.end_s - self.dwell_s
        spare = max(arrives - (retreat.shortest_s + approach.shortest_s + float(needed.sum())), 0.0)
        leaves = max(retreat.shortest_s, min(retreat_s, retreat.shortest_s + spare / 4))
        comes = arrives - max(approach.shortest_s, min(_APPROACH_S, approach.shortest_s + spare / 4))
        travel = led_along(self._transits, way, needed, (leaves, comes), free.borders_s)
        if travel is None:
            return None
        out, down = retreat.over(leaves), approach.over(arrives - comes)
        still = self._still(approach, approach.joints[-1], free.end_s)
        return _joined(out, travel, comes, down, still), (leaves, comes)

    def _is_clear(
        self, free: TransitTime, retreat: Line, keyframes: Keyframes, approach: Line, ends_s: tuple[float, float]
    ) -> bool:
        """Return whether hands after a retreat touch nothing while the base drives, and do not pass low over cloth."""
        track = JointTrajectory.at_rest(retreat.joints[0], len(self._transits.layout.arms))
        track.add(keyframes)
        count = min(int(np.ceil(free.end_s / _CHECK_S)), _CHECKS_MAX)
        waypoints = np.linspace(0.0, free.end_s, count + 1)
        bases, there = free.bases_at(waypoints), track.joints_at(waypoints)
        is_out, is_in = (waypoints <= ends_s[0])[:, None], (waypoints >= ends_s[1])[:, None]
        openings_m = np.where(is_out, retreat.openings_m, np.where(is_in, approach.openings_m, OPENING_M))
        if approach.at_grips is not None:  # fingers at edges are shut when their hands go on to the grips
            is_settling = (waypoints > free.end_s - settling_s(self.dwell_s))[:, None]
            openings_m[is_settling & (approach.openings_m <= EDGE_OPEN_M)] = HELD_M
        return self._transits.is_clear(free.cloth, bases, there, openings_m)

    def _homeward(
        self, free: TransitTime, retreat: Line, approach: Line, going: FloatArray | None, coming: FloatArray | None
    ) -> "_Homeward":
        """Return the paths home and from home, while the base stands."""
        home = self._transits.unwound(self._transits.home, retreat.joints[-1])
        away = np.array([home, home]) if going is None else going
        assert coming is not None, "a transfer that was validated can be reached by way of home"
        back = coming + (home - coming[0])
        leave_s, back_s = self._transits.needed_s(away), self._transits.needed_s(back)
        wait_s, come_s = retreat.shortest_s + float(leave_s.sum()), float(back_s.sum()) + approach.shortest_s
        late_s = max(wait_s + come_s + self.dwell_s - free.reach_s, 0.0)
        return _Homeward(away, leave_s, back, back_s, wait_s, late_s)

    def _waiting(
        self, free: TransitTime, retreat: Line, approach: Line, ways: "_Homeward"
    ) -> tuple[TransitTime, Keyframes]:
        """Return keyframes for a base that waits until the hands are home; they set out again when it has arrived.

        The waiting is taken from the reach, which must last long enough for both.
        """
        waited, approach = free.after_waiting(ways.wait_s), approach.moved(ways.back[-1] - approach.joints[0])
        comes = waited.end_s - self.dwell_s - approach.shortest_s
        begins = comes - float(ways.back_s.sum())
        travel = [
            *quickest_lines(self._transits, ways.away, ways.leave_s, retreat.shortest_s),
            Keyframes.still(ways.away[-1], begins),
            *quickest_lines(self._transits, ways.back, ways.back_s, begins),
        ]
        still = self._still(approach, approach.joints[-1], waited.end_s)
        out, down = retreat.over(retreat.shortest_s), approach.over(approach.shortest_s)
        return waited, _joined(out, travel, comes, down, still)


def _joined(out: Keyframes, travel: list[Keyframes], comes_s: float, down: Keyframes, still: Keyframes) -> Keyframes:
    """Return keyframes on a retreat, on the path from it to an approach, on that, and once more at its end."""
    return Keyframes.joined([out, *travel, down.later(comes_s), still])


def _path(retreat: Line, approach: Line, keyframes: Keyframes, arrives_s: float) -> FloatArray:
    """Return the path of keyframes, up to when the hands are there, with small steps between retreat and approach."""
    rows = keyframes.joints[keyframes.times_s <= arrives_s + TIME_S]
    out, down = len(retreat.joints) - 1, len(rows) - len(approach.joints)
    start = np.concatenate([retreat.joints[:1], rows[:out]])
    return joined(start, np.concatenate([start[-1:], rows[out : down + 1]]), rows[down:])


_HALVINGS = 40
"""How often the part of a line in which hands rest is halved."""


def led_along(
    transits: TransitPaths, way: FloatArray, needed: FloatArray, span: tuple[float, float], borders_s: tuple[float, ...]
) -> list[Keyframes] | None:
    """Return keyframes along a path within a span of time, each of its lines from rest to rest.

    The hands rest where one step of the plan ends and the next begins; None if there is no time for that.
    """
    (start, end), total = span, float(needed.sum())
    within = [border for border in borders_s if start + TIME_S < border < end - TIME_S]
    if any(border < start - TIME_S or border > end + TIME_S for border in borders_s):
        return None
    if total <= 0.0:
        return [Keyframes.still(way[-1], end)]
    begins = start + (end - start) * np.append(0.0, np.cumsum(needed)) / total
    found: list[Keyframes] = []
    for (a, b), begin, until in zip(pairwise(way), begins, begins[1:], strict=False):
        for border in (border for border in within if begin + TIME_S < border < until - TIME_S):
            middle = _middle(transits, a, b, border - begin, until - border)
            if _least_s(transits, a, middle) > border - begin or _least_s(transits, middle, b) > until - border:
                return None
            found.append(transits.eased(a, middle, border - begin).later(begin))
            a, begin = middle, border
        found.append(transits.eased(a, b, until - begin).later(begin))
    return found


def _middle(transits: TransitPaths, start: FloatArray, end: FloatArray, before_s: float, after_s: float) -> FloatArray:
    """Return where on a line to rest so that the ways before and after take equal shares of their times."""
    low, high = start, end
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if _least_s(transits, start, middle) * after_s < _least_s(transits, middle, end) * before_s:
            low = middle
        else:
            high = middle
    return np.asarray(0.5 * (low + high))


def _least_s(transits: TransitPaths, start: FloatArray, end: FloatArray) -> float:
    return float(transits.needed_s(np.array([start, end])).sum())


def quickest_lines(transits: TransitPaths, way: FloatArray, needed: FloatArray, start_s: float) -> list[Keyframes]:
    """Return keyframes along a path, each of its lines as quickly as it can be."""
    begins = start_s + np.append(0.0, np.cumsum(needed))
    return [
        transits.eased(a, b, need).later(begin)
        for (a, b), begin, need in zip(pairwise(way), begins, needed.tolist(), strict=False)
    ]


_SMOOTHING_PASSES = 3
"""How often the lines of late hands are smoothed."""

BLENDED = (10, 30, 60, 120)
"""How often paths without stops at their corners are smoothed.

The more often, the further from what is known to be free.
"""

_STRAIGHT = 4
"""Steps of a centimetre at grips that stay as they are: fingers come straight to the cloth, and leave it so."""

_CUT_RAD = 0.1
"""The largest angle from one keyframe to the next on such a path (rad)."""


def joined(retreat: FloatArray, way: FloatArray, approach: FloatArray) -> FloatArray:
    """Return a retreat, a path and an approach, of shape (n, joints) each, as one path with small steps."""
    return np.concatenate([retreat, *(_cut(a, b)[1:] for a, b in pairwise(way)), approach[1:]])


def smoothed_line(transits: TransitPaths, path: FloatArray, retreat: Line, approach: Line, passes: int) -> Line:
    """Return a line along a path from a retreat to an approach, smoothed but for some steps at the grips."""
    first, last = free_rows(path, retreat, approach)
    return transits.line(smoothed(path, passes, _may_move(path, first, len(path) - 1 - last)))


def free_rows(path: FloatArray, retreat: Line, approach: Line) -> tuple[int, int]:
    """Return the rows of a path from a retreat to an approach between which it may be changed."""
    first, last = (_STRAIGHT if len(line.joints) > 1 else 0 for line in (retreat, approach))
    return first, len(path) - 1 - last


def _smoothed(transits: TransitPaths, line: Line, first: int, last: int) -> Line:
    """Return a line from grips or to grips, smoothed but for some steps at the grips."""
    joints = smoothed(line.joints, _SMOOTHING_PASSES, _may_move(line.joints, first, last))
    return transits.line(joints, line.openings_m, line.at_grips)


def _may_move(joints: FloatArray, first: int, last: int) -> BoolArray:
    """Return which rows of a path may be moved: all but some steps at its start and at its end."""
    numbers = np.arange(len(joints))
    return np.asarray((numbers > first) & (numbers < len(joints) - 1 - last))


def _cut(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return a straight line in steps, its ends included."""
    count = max(1, int(np.ceil(np.abs(end - start).max() / _CUT_RAD)))
    return np.asarray(start + np.linspace(0.0, 1.0, count + 1)[:, None] * (end - start))
