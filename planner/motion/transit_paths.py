"""Find transit paths between two configurations: straight in joint space, by way of a few others, or by sampling.

Empty arms are mostly well above the table, and a straight line between two configurations is free. Where it is not, the
arms go one after the other, or by way of raised configurations. Where nothing of that is free, paths are sampled
(`sampled_paths`).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain, pairwise, product

import numpy as np

from planner.geometry.keyframes import ramps
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.tolerance import EDGE_RAD
from planner.motion.answer_memory import RecentAnswers, digest
from planner.motion.joint_trajectory import Keyframes, Line
from planner.motion.lying_cloth import NEAR_GRIP_M, LyingCloth
from planner.motion.opened_collisions import OpenedCollisions
from planner.motion.pacing import needed_s
from planner.motion.path_timing import quickest
from planner.motion.polylines import lengths_on_table
from planner.motion.sampled_paths import SampledPaths, sampled
from planner.robots.armed_robot import ArmedRobot
from planner.robots.card import OPENING_M, JointLayout
from planner.robots.collision.collisions import Collisions

_LEADS = (0.25, 0.5, 0.75)
"""The fractions of their path by which some arms are tried ahead of the others."""

STEP_RAD = 0.05
"""The largest angle that joints turn from one tested configuration to the next (rad)."""


Spared = tuple[FloatArray, FloatArray]
"""Length of path on which each arm may be low over cloth: at the beginning, and at the end (m), shape (arms,) each."""


_WAYS_KEPT = 512
"""Size of the cache of paths, some 7 kB each: two for each transfer that is kept."""

_DIGITS = 9
"""Decimal places to which ends of paths are distinguished (rad): whole turns are not exact."""

_SAMPLED_MAX = 4
"""Paths sampled for the same arms, until one is free."""

_ANSWERS_KEPT = 4096
"""Answers kept about motions, and as many about the lengths of lines."""


@dataclass(frozen=True, slots=True)
class _WayKey:
    """The key of a path: all that it depends on."""

    key: tuple[bytes, ...]
    base: Pose2
    cloth: LyingCloth
    samples: bool
    start: FloatArray = field(compare=False)
    goal: FloatArray = field(compare=False)
    spared: Spared = field(compare=False)


class TransitPaths:
    """Finds and caches paths for empty hands; most recur, in the same task and after a small change to the garment.

    May be shared between threads.
    """

    def __init__(self, machine: ArmedRobot, collisions: OpenedCollisions, torso_m: float) -> None:
        """Keep the robot, its collisions and the height of its lift (m)."""
        self._machine, self._torso_m = machine, torso_m
        self._opened, self._collisions = collisions, collisions.wide
        self.layout = JointLayout.of(machine.card)
        self.home = self.layout.home
        self._searched = RecentAnswers[_WayKey, FloatArray | None](_WAYS_KEPT)
        self._tested = RecentAnswers[bytes, bool](_ANSWERS_KEPT)
        self._lengths_m = RecentAnswers[bytes, float](_ANSWERS_KEPT)

    @property
    def at_grips(self) -> Spared:
        """The allowance for paths that begin and end at grips."""
        near = np.full(len(self.layout.arms), NEAR_GRIP_M)
        return near, near

    def needed_s(self, way: FloatArray) -> FloatArray:
        """Return the least time for each straight line of a path, from rest to rest (s)."""
        turns = np.abs(np.diff(way, axis=0))
        slow = (turns / self.layout.speeds_rad_s).max(axis=1, initial=0.0)
        hard = (turns / self.layout.accelerations).max(axis=1, initial=0.0)
        is_long = slow**2 >= hard
        return np.asarray(np.where(is_long, slow + hard / np.where(slow > 0.0, slow, 1.0), 2.0 * np.sqrt(hard)))

    def eased(self, start: FloatArray, goal: FloatArray, lasts_s: float) -> Keyframes:
        """Return keyframes of a straight line from rest to rest over a time, at least the least one (s)."""
        turns = np.abs(goal - start)
        slow = float((turns / self.layout.speeds_rad_s).max(initial=0.0))
        hard = float((turns / self.layout.accelerations).max(initial=0.0))
        if slow == 0.0:
            return Keyframes.still(goal, lasts_s)
        run = ramps(lasts_s, 1.0, 1.0 / slow, 1.0 / hard)
        shares, rates = np.array(run.fractions)[:, None], np.array(run.rates)[:, None]
        return Keyframes(np.array(run.times_s), start + shares * (goal - start), rates * (goal - start))

    def line(
        self, joints: FloatArray, openings_m: FloatArray | None = None, at_grips: FloatArray | None = None
    ) -> Line:
        """Return the quickest run, from rest to rest, along lines of small steps, shape (n, joints); see `Line`."""
        at = np.append(0.0, np.cumsum(needed_s(joints, self.layout.speeds_rad_s)))
        opened = np.full(len(self.layout.arms), OPENING_M) if openings_m is None else openings_m
        timing = quickest(joints, at, (self.layout.speeds_rad_s, self.layout.accelerations))
        return Line(joints, timing, opened, at_grips)

    def unwound(self, joints: FloatArray, near: FloatArray) -> FloatArray:
        """Return a configuration with its continuous joints within half a turn of another's.

        Those that are stay as they are, so that a joint just half a turn away is not turned to and fro.
        """
        away = near - joints
        is_far = self.layout.is_continuous & (np.abs(away) > np.pi + EDGE_RAD)
        return np.asarray(joints + 2.0 * np.pi * np.where(is_far, np.round(away / (2.0 * np.pi)), 0.0))

    def way(
        self,
        base: Pose2,
        start: FloatArray,
        goal: FloatArray,
        cloth: LyingCloth,
        spared: Spared,
        *,
        samples: bool = True,
    ) -> FloatArray | None:
        """Return a path between two configurations while the base stands.

        Args:
            base: the base's pose, table frame.
            start: all arms' joints (rad), shape (joints,).
            goal: the same; its continuous joints may be turns away.
            cloth: the cloth on the table meanwhile.
            spared: how far hands may go low over it at both ends.
            samples: whether paths are sampled where no line and no detour is free, which takes half a second in vain.

        Returns:
            Configurations from start to goal, shape (n, joints), between which straight lines are free; None if no way
            was found. Where both are whole turns of continuous joints away, the way is the same, as far away.
        """
        whole = np.floor(
            (start + np.pi + EDGE_RAD) / (2.0 * np.pi)
        )  # a joint half a turn away is not distinguished from the other
        turns = np.where(self.layout.is_continuous, 2.0 * np.pi * whole, 0.0)
        unturned = start - turns
        first, last = (joints.round(_DIGITS) + 0.0 for joints in (unturned, self.unwound(goal - turns, unturned)))
        key = tuple(part.tobytes() for part in (first, last, *spared))
        found = self._searched.answer(_WayKey(key, base, cloth, samples, first, last, spared), self._search)
        return None if found is None else np.array([start, *(found[1:-1] + turns), self.unwound(goal, start)])

    def way_near(
        self, base: Pose2, start: FloatArray, goal: FloatArray, cloth: LyingCloth, spared: Spared, near: FloatArray
    ) -> FloatArray | None:
        """Return a path as `way` does, by the same corners as another one; None if it is not free."""
        corners = [self.unwound(joints, start) for joints in (*near[1:-1], goal)]
        way = np.array([start, *corners])
        return way if self._is_free(_Lines(base, self._collisions), way, cloth, spared) else None

    def _search(self, wanted: _WayKey) -> FloatArray | None:
        start, goal, cloth, spared = wanted.start, wanted.goal, wanted.cloth, wanted.spared
        straight, known = np.array([start, goal]), _Lines(wanted.base, self._collisions)
        if self._is_free(known, straight, cloth, spared):
            return straight
        by_samples = self._sampled(wanted.base, start, goal, cloth, spared) if wanted.samples else ()
        ways = chain(self._roundabout(start, goal), by_samples)
        return next((way for way in ways if self._is_free(known, way, cloth, spared)), None)

    def _sampled(
        self, base: Pose2, start: FloatArray, goal: FloatArray, cloth: LyingCloth, spared: Spared
    ) -> Iterator[FloatArray]:
        """Yield paths found by sampling: of the arms that have to move, then of all arms.

        Hands may go low over cloth only near to their ends, along the way, which is only known of whole paths: so each
        may still turn out not to be free.
        """
        layout = self.layout
        tools = [[self._tools(arm, joints[None])[0] for arm in layout.arms] for joints in (start, goal)]

        def free_until(joints: FloatArray) -> int:
            count = self._collisions.free_until(base, joints)
            for arm, span in enumerate(layout.spans):
                if not count:
                    break
                left = np.arange(count)
                ends = [(length[arm], of[arm]) for length, of in zip(spared, tools, strict=True) if length[arm] > 0.0]
                if ends:
                    # A hand has come at least as far as it is away. How far it came is a query of the whole path.
                    there = self._tools(arm, joints[left])
                    is_near = [np.linalg.norm(there - end, axis=1) < length for length, end in ends]
                    left = left[~np.logical_or.reduce(is_near)]
                is_clear = cloth.arm_clear(arm, base, joints[left, span])
                if not is_clear.all():
                    count = int(left[is_clear.argmin()])
            return count

        middle, ends = 0.5 * (start + goal), np.sort([start, goal], axis=0)
        bounds = np.where(np.isinf(layout.ranges.T), middle + np.array([[-np.pi], [np.pi]]), layout.ranges.T)
        has_to_move = np.array([bool((start != goal)[span].any()) for span in layout.spans])
        for moves in (has_to_move,) if has_to_move.all() else (has_to_move, np.ones_like(has_to_move)):
            low, high = np.where(moves[layout.owners], bounds, ends)
            paths = SampledPaths(free_until, low, high, STEP_RAD, self._machine.mirror)
            for _ in range(_SAMPLED_MAX):
                found = paths.path(start, goal)
                if found is None:
                    break
                yield found

    def _tools(self, arm: int, joints: FloatArray) -> FloatArray:
        """Return the places of an arm's tool in the base frame at some configurations, shape (n, 3), m."""
        return self._machine.tool_places(arm, joints[:, self.layout.spans[arm]], self._torso_m)

    def _is_free(self, known: "_Lines", way: FloatArray, cloth: LyingCloth, spared: Spared) -> bool:
        """Return whether the straight lines of a path are free, and high enough above the cloth on the table."""
        if not all(known.is_free(start, end) for start, end in pairwise(way)):
            return False
        base, joints = known.base, np.concatenate([sampled(start, end, STEP_RAD) for start, end in pairwise(way)])
        return self.are_clear(cloth, np.tile([base.x_m, base.y_m, base.yaw_rad], (len(joints), 1)), joints, spared)

    def is_clear(self, cloth: LyingCloth, bases: FloatArray, joints: FloatArray, openings_m: FloatArray) -> bool:
        """Return whether arms from grips to grips touch nothing and stay high enough above the cloth. Cached.

        Args:
            cloth: the cloth on the table.
            bases: the base at moments between which joints turn about evenly, shape (n, 3).
            joints: all arms' joints then (rad), shape (n, joints).
            openings_m: how far each arm's fingers are open at most then (m), shape (n, arms).
        """
        return self._tested.answer(
            digest(cloth.key, bases.tobytes(), joints.tobytes(), openings_m.tobytes()),
            lambda _: (
                self._opened.is_path_free(bases, joints, openings_m)
                and self.are_clear(cloth, bases, joints, self.at_grips, openings_m)
            ),
        )

    def are_clear(
        self,
        cloth: LyingCloth,
        bases: FloatArray,
        joints: FloatArray,
        spared: Spared,
        openings_m: FloatArray | None = None,
    ) -> bool:
        """Return whether arms are high enough above cloth all along a path, shapes (n, 3) and (n, joints).

        Their fingers are open as far as in `is_clear`; None: widely.
        """
        before, after = spared
        for arm, span in enumerate(self.layout.spans):
            must = np.ones(len(joints), dtype=np.bool_)
            if before[arm] > 0.0 or after[arm] > 0.0:
                gone = self._gone_m(arm, bases, joints)
                must = (gone >= before[arm]) & (gone[-1] - gone >= after[arm])
            opened = np.full(len(joints), OPENING_M) if openings_m is None else openings_m[:, arm]
            for opening_m in np.unique(opened[must]).tolist():
                rows = must & (opened == opening_m)
                if not cloth.arm_clear(arm, bases[rows], joints[rows, span], opening_m=opening_m).all():
                    return False
        return True

    def spared(self, retreat: FloatArray | None, approach: FloatArray | None) -> Spared:
        """Return how far hands may go low after lines from their grips and before lines to them.

        The lines are of shape (n, joints) each.
        """
        lengths = [
            [np.inf if line is None else self._length_m(arm, line) for arm in self.layout.arms]
            for line in (retreat, approach)
        ]
        before, after = np.maximum(NEAR_GRIP_M - np.array(lengths), 0.0)
        return before, after

    def _length_m(self, arm: int, line: FloatArray) -> float:
        """Return the way of an arm's tool along a line of configurations, shape (n, joints), m. Cached."""
        joints = line[:, self.layout.spans[arm]]
        key = digest(str(arm).encode(), joints.tobytes())
        return self._lengths_m.answer(key, lambda _: float(self._gone_m(arm, np.zeros((1, 3)), line)[-1]))

    def _gone_m(self, arm: int, bases: FloatArray, joints: FloatArray) -> FloatArray:
        """Return the way of an arm's tool in the table's frame up to each of some configurations, shape (n,), m."""
        return lengths_on_table(bases, self._tools(arm, joints))

    def _roundabout(self, start: FloatArray, goal: FloatArray) -> list[FloatArray]:
        """Return paths that may be free where the straight one is not, the quickest first."""
        raised_start, raised_goal = self._raised(start), self._raised(goal)
        choices = product((False, True), repeat=len(self.layout.arms))
        mixed = [np.where(np.array(first)[self.layout.owners], goal, start) for first in choices]
        home = self.unwound(self.home, start)
        places = [(raised_goal,), (raised_start,), (home,), (raised_start, raised_goal)]
        places += [(place,) for place in mixed[1:-1]]
        places += [(raised_start, place) for place in mixed[1:-1]]
        places += [(place, raised_goal) for place in mixed[1:-1]]
        places += [_staggered(start, goal, first, approach) for first in mixed[1:-1] for approach in _LEADS]
        places.append((raised_start, home, raised_goal))
        ways = [np.array([start, *between, goal]) for between in places]
        return sorted(ways, key=lambda way: float(self.needed_s(way).sum()))

    def _raised(self, joints: FloatArray) -> FloatArray:
        """Return the arms lifted as at home, with shoulders and hands turned as they are."""
        return np.where(self.layout.is_lifting, self.home, joints)


class _Lines:
    """Straight lines between configurations while the base stands, cached because many detours share them."""

    def __init__(self, base: Pose2, collisions: Collisions) -> None:
        self.base = base
        self._collisions = collisions
        self._known: dict[tuple[bytes, bytes], bool] = {}

    def is_free(self, start: FloatArray, end: FloatArray) -> bool:
        """Return whether nothing touches all along a line."""
        key = (start.tobytes(), end.tobytes())
        if key not in self._known:
            self._known[key] = self._collisions.is_path_free(self.base, sampled(start, end, STEP_RAD))
        return self._known[key]


def _staggered(
    start: FloatArray, goal: FloatArray, first: FloatArray, approach: float
) -> tuple[FloatArray, FloatArray]:
    """Return two configurations through which some arms are a fraction of the path ahead of the others.

    The arms ahead are those that are at the goal in `first`.
    """
    before, after = first - start, goal - first
    return start + approach * before, first + (1.0 - approach) * after
