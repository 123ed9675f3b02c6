"""Measure what one attempt at a fold lacked: the point furthest out of reach, and by how much.

A hand follows its path in one orientation. So each orientation counts by its worst point, and the orientation whose
worst point is least out of reach decides. The checks get stricter until one of them finds a shortfall:

1. start, apex and end of each hand's path, each from the standoff that suits it best;
2. all waypoints of each hand's path;
3. whether the base can drive from standoff to standoff while the hand rests;
4. all hands' paths at once, from common standoffs.

The point that is furthest out of reach says why an attempt failed. But repairing that point alone may not be enough,
since the hands must follow their whole path. A sure repair is to shift the whole path as the robot sees it, which a
person can do: sideways by moving the station or the cloth, up or down by the height of the table or the torso. The
least such shift is looked for along each of `DIRECTIONS`, and each shift is tried as the planner would try it.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import reduce
from itertools import product
from operator import and_

import numpy as np
from numpy.typing import NDArray

from planner.explain.change import Bisection
from planner.geometry.driving import STANDOFF_STEP_M
from planner.geometry.pose import FloatArray, Point3
from planner.geometry.reach_query import ReachQuery, Shortfall
from planner.primitives.context import Context
from planner.primitives.fold_trial import FoldTrial
from planner.primitives.fold_way import can_follow
from planner.primitives.state import State

_ORIENTATIONS_MAX, _PAIRED_MAX = 8, 4
"""Orientations of a hand, the best first, that the third and the fourth check examine."""

_FINEST_M = 0.002
"""Shortfalls that differ by less count as equal (m); each is found to a millimetre."""

FURTHEST_M = 0.2
"""Largest shift that is tried (m)."""

_SHIFT_STEP_M, _SHIFT_FINEST_M = 0.02, 0.001
"""Step between the shifts tried, and how exactly the least shift is found (m)."""

_SLANT = math.sqrt(0.5)

DIRECTIONS: tuple[Point3, ...] = (
    (-1.0, 0.0, 0.0),
    (0.0, 1.0, 0.0),
    (0.0, -1.0, 0.0),
    (1.0, 0.0, 0.0),
    (-_SLANT, _SLANT, 0.0),
    (-_SLANT, -_SLANT, 0.0),
    (_SLANT, _SLANT, 0.0),
    (_SLANT, -_SLANT, 0.0),
    (0.0, 0.0, -1.0),
    (0.0, 0.0, 1.0),
)
"""Directions in which a path is shifted, base frame: eight horizontal directions, down and up."""


class Demand(StrEnum):
    """The requirements on a point that is out of reach."""

    ALONE = "alone"
    ONE_ORIENTATION = "one orientation"
    DRIVING = "driving"
    WITH_THE_OTHER_HAND = "with the other hand"


@dataclass(frozen=True, eq=False, slots=True)
class Miss:
    """The point of an attempt that is furthest out of reach, seen from where it is least so.

    Attributes:
        state: the state in which the attempt was made.
        trial: the attempt.
        stands: the standoffs at which the base may be when it begins, as a bit mask.
        grip: the index of the grip.
        waypoint: the index of the waypoint in the trial.
        standoff: the standoff from which the point is least out of reach.
        shortfall: by how much, and why.
        demand: what the point must satisfy.
    """

    state: State
    trial: FoldTrial
    stands: int
    grip: int
    waypoint: int
    standoff: int
    shortfall: Shortfall
    demand: Demand

    @property
    def short_by_m(self) -> float:
        """The distance by which the point would have to be displaced (m)."""
        return self.shortfall.short_by_m


def worst_miss(misses: Iterable[Miss | None]) -> Miss | None:
    """Return the miss that lacks most, the first of equals; None if there is none."""
    return max((m for m in misses if m is not None), key=lambda m: m.short_by_m, default=None)


def least_miss(misses: Iterable[Miss | None]) -> Miss | None:
    """Return the miss that lacks least, the first of equals; None if there is none."""
    return min((m for m in misses if m is not None), key=lambda m: m.short_by_m, default=None)


def miss_of(context: Context, state: State, trial: FoldTrial, stands: int, at_most_m: float) -> Miss | None:
    """Return what an attempt lacks; None if the arms can follow it after all.

    Args:
        context: the planning context.
        state: where the attempt begins.
        trial: the attempt.
        stands: the standoffs at which the base may be when it begins, as a bit mask.
        at_most_m: the shortfall from which on it is returned without looking for a larger one (m).
    """
    return _Attempt(context, state, trial, stands, at_most_m).miss()


def explained(context: Context, miss: Miss) -> Miss:
    """Return the miss, with the demand `ALONE` if its point is as far out of reach in every orientation."""
    if miss.demand is not Demand.ONE_ORIENTATION:
        return miss
    stands = _bits(miss.stands) if miss.waypoint == 0 else range(context.standoffs)
    seen = _seen(context, miss.state, miss.trial.tools[miss.grip, miss.waypoint], stands)
    place = ReachQuery(miss.trial.arms[miss.grip], seen[None], miss.trial.approaches[miss.grip])
    alone = context.reach.shortfall(place, miss.short_by_m, context.deadline)
    is_alone = alone is not None and alone.short_by_m >= miss.short_by_m - _FINEST_M
    return replace(miss, demand=Demand.ALONE) if is_alone else miss


class _Attempt:
    """Looks for what one attempt lacks."""

    def __init__(self, context: Context, state: State, trial: FoldTrial, stands: int, at_most_m: float) -> None:
        self._context = context
        self._state = state
        self._trial = trial
        self._stands = stands
        self._at_most_m = at_most_m

    def miss(self) -> Miss | None:
        hands = range(len(self._trial.arms))
        last = len(self._trial.sweeps) - 1
        found = self._worst_hand((hand, (last // 2, last, 0)) for hand in hands)
        if found is not None:
            return found
        masks = [self._masks(hand) for hand in hands]
        found = self._worst_hand((hand, range(last + 1)) for hand in hands if not self._followed(masks[hand]))
        if found is not None:
            return found
        return self._on_the_way(masks)

    def _worst_hand(self, ways: Iterable[tuple[int, Sequence[int]]]) -> Miss | None:
        """Return the miss of the hand that lacks most at some of its waypoints, in one orientation."""
        worst: Miss | None = None
        for hand, waypoints in ways:
            worst = worst_miss((worst, self._in_one_orientation(hand, waypoints)))
            if worst is not None and worst.short_by_m >= self._at_most_m:
                return worst
        return worst

    def _in_one_orientation(self, hand: int, waypoints: Sequence[int]) -> Miss | None:
        context, trial = self._context, self._trial
        begin = np.resize(_bits(self._stands), context.standoffs)
        stands = [begin if waypoint == 0 else np.arange(context.standoffs) for waypoint in waypoints]
        seen = np.stack(
            [_seen(context, self._state, trial.tools[hand, w], s) for w, s in zip(waypoints, stands, strict=True)]
        )
        places = ReachQuery(trial.arms[hand], seen, trial.approaches[hand])
        found = context.reach.shortfall(places, self._at_most_m, context.deadline)
        if found is None:
            return None
        standoff = int(stands[found.place][found.seen_from])
        return self._miss(hand, waypoints[found.place], standoff, found, Demand.ONE_ORIENTATION)

    def _miss(self, hand: int, waypoint: int, standoff: int, shortfall: Shortfall, demand: Demand) -> Miss:
        return Miss(self._state, self._trial, self._stands, hand, waypoint, standoff, shortfall, demand)

    def _masks(self, hand: int) -> NDArray[np.uint32]:
        """Return for each approach and waypoint by itself the standoffs within the comfort radius, shape (k, n)."""
        context, trial = self._context, self._trial
        points = context.in_base(self._state.station, trial.tools[hand])
        arm, approaches = trial.arms[hand], trial.approaches[hand]
        columns = [
            context.reach.standoffs(ReachQuery(arm, point[None], approaches, context.standoffs)) for point in points
        ]
        return np.hstack(columns)

    def _followed(self, masks: NDArray[np.uint32]) -> list[int]:
        """Return the orientations in which a hand's whole path can be followed, those with the most freedom first."""
        able = [number for number, row in enumerate(masks) if self._stuck(row) is None]
        freedom = np.bitwise_count(masks).sum(axis=1, dtype=np.int64)
        return sorted(able, key=lambda number: -int(freedom[number]))

    def _on_the_way(self, masks: list[NDArray[np.uint32]]) -> Miss | None:
        """Return what is lacking although each hand can reach every waypoint in one orientation."""
        driving = worst_miss(self._driving(hand, rows) for hand, rows in enumerate(masks))
        return driving if driving is not None else self._together(masks)

    def _driving(self, hand: int, masks: NDArray[np.uint32]) -> Miss | None:
        """Return what a hand lacks where the base cannot drive on; None if it can in some orientation."""
        if self._followed(masks):
            return None
        complete = np.flatnonzero(masks.all(axis=1))[:_ORIENTATIONS_MAX]
        stuck = ((number, self._stuck(masks[number])) for number in complete)
        misses = (self._lacking(hand, int(n), *at, Demand.DRIVING) for n, at in stuck if at is not None)
        return least_miss(misses)

    def _stuck(self, row: NDArray[np.uint32]) -> tuple[int, int] | None:
        """Return the waypoint at which the base cannot drive on, and where it is then; None if there is none."""
        before = self._stands
        for waypoint, mask in enumerate(row):
            after = _spread(before, int(mask))
            if not after:
                return waypoint, before
            before = after
        return None

    def _lacking(self, hand: int, orientation: int, waypoint: int, standoffs: int, demand: Demand) -> Miss | None:
        """Return what one tool point lacks in one orientation from some standoffs, given as a bit mask."""
        context, trial = self._context, self._trial
        stands = _bits(standoffs)
        seen = _seen(context, self._state, trial.tools[hand, waypoint], stands)
        place = ReachQuery(trial.arms[hand], seen[None], trial.approaches[hand][orientation : orientation + 1])
        found = context.reach.shortfall(place, self._at_most_m, context.deadline)
        if found is None:
            return None
        return self._miss(hand, waypoint, stands[found.seen_from], found, demand)

    def _together(self, masks: list[NDArray[np.uint32]]) -> Miss | None:
        """Return what the hands lack together though each alone has a path; None if they lack nothing."""
        if len(masks) < 2:
            return None
        misses: list[Miss | None] = []
        for orientations in product(*(self._followed(of_hand)[:_PAIRED_MAX] for of_hand in masks)):
            rows = [of_hand[number] for of_hand, number in zip(masks, orientations, strict=True)]
            stuck = self._stuck(np.bitwise_and.reduce(rows))
            if stuck is None:
                return None
            misses += self._held_up(stuck, rows, orientations)
        return least_miss(misses)

    def _held_up(
        self, stuck: tuple[int, int], rows: Sequence[NDArray[np.uint32]], orientations: tuple[int, ...]
    ) -> Iterator[Miss | None]:
        """Yield what each hand lacks where all get stuck, from where the others have what they need."""
        waypoint, before = stuck
        for hand, orientation in enumerate(orientations):
            of_others = [int(row[waypoint]) for other, row in enumerate(rows) if other != hand]
            stands = _spread(before, reduce(and_, of_others))
            if stands:
                yield self._lacking(hand, orientation, waypoint, stands, Demand.WITH_THE_OTHER_HAND)


def _bits(mask: int) -> list[int]:
    return [bit for bit in range(mask.bit_length()) if mask >> bit & 1]


def _seen(context: Context, state: State, tool: FloatArray, standoffs: Sequence[int] | NDArray[np.int64]) -> FloatArray:
    """Transform a tool point from the table frame to the base frame at each of some standoffs, shape (n, 3), m."""
    at_station = context.in_base(state.station, tool[None])
    return np.asarray(at_station + np.array(standoffs)[:, None] * np.array([STANDOFF_STEP_M, 0.0, 0.0]))


def _spread(seed: int, mask: int) -> int:
    """Return the standoffs of a mask to which the base can drive within the mask from those of a seed."""
    seed &= mask
    while True:
        wider = (seed | seed << 1 | seed >> 1) & mask
        if wider == seed:
            return seed
        seed = wider


def least_shift(context: Context, miss: Miss) -> tuple[float, Point3] | None:
    """Return the least shift tried that lets the arms follow an attempt; None if none does.

    It is given by its distance (m) and its unit direction, base frame.
    """
    attempt = _Shifted(context, miss)
    best: tuple[float, Point3] | None = None
    for towards in DIRECTIONS:
        limit = FURTHEST_M if best is None else best[0] - _SHIFT_FINEST_M
        distance_m = attempt.least(towards, limit)
        if distance_m is not None:
            best = distance_m, towards
    return best


class _Shifted:
    """An attempt, shifted as its robot sees it."""

    def __init__(self, context: Context, miss: Miss) -> None:
        self._context = context
        self._trial = miss.trial
        self._station = miss.state.station
        self._stands = miss.stands
        pose = context.station_pose(self._station)
        self._axes = pose.to_outer(np.eye(3)) - pose.to_outer(np.zeros((3, 3)))
        last = len(miss.trial.sweeps) - 1
        self._extremes = (last // 2, last, 0)

    def least(self, towards: Point3, limit: float) -> float | None:
        """Return the least sufficient shift along a direction, up to a limit; None if there is none."""
        outer = np.array(towards) @ self._axes
        near, far, deadline = 0.0, _SHIFT_STEP_M, self._context.deadline
        while far <= limit + _SHIFT_FINEST_M and not deadline.is_over:
            short = self._at_least_short(far * outer)
            if short > 0.0:
                near, far = far + short, far + max(_SHIFT_STEP_M, _SHIFT_STEP_M * math.ceil(short / _SHIFT_STEP_M))
            elif self._is_in_reach(far * outer):
                return self._settled(outer, near, far)
            else:
                near, far = far, far + _SHIFT_STEP_M
        return None

    def _settled(self, outer: FloatArray, near: float, far: float) -> float:
        search = Bisection(near, far, _SHIFT_FINEST_M)
        while (distance := search.amount) is not None:
            search.note(distance, distance if self._is_in_reach(distance * outer) else None)
        return search.works

    def _at_least_short(self, shift: FloatArray) -> float:
        context, trial = self._context, self._trial
        return max(
            float(
                context.reach.at_least_short(
                    ReachQuery(arm, self._seen(hand, shift)[None], approaches, context.standoffs)
                )[0]
            )
            for hand, (arm, approaches) in enumerate(zip(trial.arms, trial.approaches, strict=True))
        )

    def _is_in_reach(self, shift: FloatArray) -> bool:
        """Return whether the arms can follow the attempt, shifted in the table frame."""
        shifted = replace(self._trial, tools=self._trial.tools + shift)
        return can_follow(self._context, self._station, shifted, self._stands)

    def _seen(self, hand: int, shift: FloatArray) -> FloatArray:
        """Return apex, end and start of a hand's path in the base frame, shape (3, 3), m."""
        return self._context.in_base(self._station, self._trial.tools[hand, list(self._extremes)] + shift)
