"""Find which attempt at a fold came closest, among all that the arms could not follow.

There are hundreds: stations, places that drags lead to, choices of grips and arms. Computing what one attempt truly
lacks takes a few milliseconds, a lower bound on it some microseconds. So the attempts are checked in the order of their
bounds, and once a bound exceeds the least shortfall found, no better attempt is left.

The relaxation that quickly proves that a fold is impossible lets the garment lie wherever drags lead and lets the hands
hold whatever a drag could have left them with, whether or not the robot can make those drags. A reason must not, since
a person would try in vain to repair it there. So a place counts only if the search reached it, or if one drag leads to
it from the start or from a place that the search reached.
"""

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.explain.reason_attempt import Miss, miss_of
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.reach_query import ReachQuery
from planner.geometry.tolerance import LENGTH_M, grid_key, grid_keys
from planner.primitives.context import Context
from planner.primitives.drag_way import drag_covers, dragged, longest_drag, towards_robot
from planner.primitives.fold_obstacles import geometric_obstacle
from planner.primitives.fold_trial import fold_trials
from planner.primitives.fold_way import away_from_shoulders
from planner.primitives.g_drag import GDrag
from planner.primitives.obstacle import Attempt, Situation, situation
from planner.primitives.state import UNDRAGGED, State

CANDIDATES_MAX = 1000
"""Candidates examined; of more, only those that are roughly nearest to the arms' reach."""

EXAMINED_MAX = 32
"""Candidates with the least bounds that are examined exactly."""

_UNSURE_MAX = 8
"""Candidates examined before it is known whether the cloth can be brought there, which usually takes longer."""

_EXTREMES = np.array([0.0, 1.0, 2.0])
"""The sweeps at start, apex and end of a fold."""

_Place = tuple[int, int]
"""A place of the cloth in steps of the grid."""

_AS_ONE = np.array([1 << 32, 1])
"""The weights that turn a place on the grid into one number."""


class Places:
    """Decides whether situations can be brought about; keeps the answers."""

    def __init__(self, context: Context, reached: Collection[Situation]) -> None:
        """Prepare the decision from the situations that the search reached."""
        self._context = context
        self._everywhere = (1 << context.standoffs) - 1
        self._drags = GDrag(context)
        counts = np.arange(1, longest_drag(context) + 1)[:, None]
        self._shifts = tuple(
            grid_keys(counts * np.array(dragged(context, UNDRAGGED, station, 1)))
            for station in range(len(context.scene.stations))
        )
        self._origins_at: dict[int, dict[_Place, Point2]] = {}
        self._able: dict[tuple[int, int | None], NDArray[np.int64]] = {}
        self._led_to: dict[tuple[int, int, _Place, int], tuple[State, ...]] = {}
        self._taken: dict[tuple[int, int], frozenset[tuple[_Place, ...]]] = {}
        self._reached: dict[tuple[object, ...], dict[_Place, int]] = {}
        for done, x, y, held, is_dragged, standoff in reached:
            at = self._reached.setdefault((done, held, is_dragged), {})
            at[(x, y)] = at.get((x, y), 0) | (1 << standoff if held else self._everywhere)

    def worth_trying(self, attempt: Attempt) -> NDArray[np.int64]:
        """Return the indices of an attempt's places that may have `stands`; a quick first check."""
        state = attempt.state
        able = [_as_one(np.array(list(self._reached_in(state)), dtype=np.int64))]
        if not state.held:
            able.append(self._led_to_by_any(state.done, None))
        elif self._is_taken(state):
            able.append(self._led_to_by_any(state.done, state.station))
        keys = grid_keys(attempt.places)
        return np.flatnonzero(np.isin(_as_one(keys), np.concatenate(able)))

    def stands(self, state: State) -> int:
        """Return the standoffs at which the base may be in a state's situation, as a bit mask.

        The mask is 0 where the situation cannot be brought about. With free hands the base may be anywhere.
        """
        reached = self._reached_in(state).get(_key(state.offset), 0)
        if state.held:
            return reached | self._left_by_drags(state.station, state)
        if reached or _key(state.offset) == _key(UNDRAGGED):
            return self._everywhere
        stations = range(len(self._context.scene.stations))
        return self._everywhere if any(self._left_by_drags(station, state) for station in stations) else 0

    def _reached_in(self, state: State) -> dict[_Place, int]:
        """Return the places that the search reached with the folds done and the grips of a state."""
        done, _, _, held, is_dragged, _ = situation(state)
        return self._reached.get((done, held, is_dragged), {})

    def _origins(self, done: int) -> dict[_Place, Point2]:
        """Return where the cloth may lie free before a drag, on the grid and in m, the start first."""
        if done not in self._origins_at:
            free = [_key(UNDRAGGED), *self._reached.get((done, (), False), {})]
            self._origins_at[done] = {(x, y): (x * LENGTH_M, y * LENGTH_M) for x, y in free}
        return self._origins_at[done]

    def _led_to_by_any(self, done: int, station: int | None) -> NDArray[np.int64]:
        """Return where the cloth may lie free, or after one drag from a station, each place as one number.

        A station of None stands for any station.
        """
        key = (done, station)
        if key not in self._able:
            shifts = np.vstack(self._shifts if station is None else self._shifts[station : station + 1])
            origins = np.array(list(self._origins(done)), dtype=np.int64)
            led_to = (origins[:, None] + shifts[None]).reshape(-1, 2)
            self._able[key] = np.unique(_as_one(np.vstack([led_to, origins[:1]]) if station is None else led_to))
        return self._able[key]

    def _is_taken(self, state: State) -> bool:
        """Return whether a drag from the start, made at a state's station, takes the grips that the state holds."""
        key = (state.done, state.station)
        if key not in self._taken:
            towards = towards_robot(self._context, state.station)
            covers = drag_covers(self._context, state.done, UNDRAGGED, towards).covers
            self._taken[key] = frozenset(tuple(sorted(_key(grip) for grip in cover)) for cover in covers)
        return tuple(sorted(_key(held.point) for held in state.held)) in self._taken[key]

    def _left_by_drags(self, station: int, state: State) -> int:
        """Return the standoffs at which drags from a station leave the base when they lead to a state's situation."""
        origins = self._origins(state.done)
        for number, (x, y) in enumerate(_key(state.offset) - self._shifts[station]):
            before = origins.get((int(x), int(y)))
            found = 0 if before is None else self._left_by_drag(before, station, number + 1, state)
            if found:
                return found
        return 0

    def _left_by_drag(self, before: Point2, station: int, count: int, state: State) -> int:
        key = (state.done, station, _key(before), count)
        if key not in self._led_to:
            drags = self._drags.by(State(state.done, before, station, 0), count)
            self._led_to[key] = tuple(step.after for step in drags)
        held = tuple(h.key for h in state.held)
        ends = {after.standoff for after in self._led_to[key] if tuple(h.key for h in after.held) == held}
        return sum(1 << end for end in ends)


def _key(place: Point2) -> _Place:
    """Round a place to the grid, since dragging to and fro changes the last digits."""
    return (grid_key(place[0]), grid_key(place[1]))


def _as_one(places: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return places on the grid, shape (n, 2), as one number each."""
    return np.asarray(places.reshape(-1, 2) @ _AS_ONE)


@dataclass(frozen=True, eq=False, slots=True)
class _Candidate:
    """An attempt at one place.

    Attributes:
        attempt: the attempt.
        place: the index of the place.
        bound_m: a lower bound on the shortfall (m).
    """

    attempt: Attempt
    place: int
    bound_m: float

    @property
    def state(self) -> State:
        """The state with the garment at the place."""
        return self.attempt.at(self.place)


def nearest_miss(context: Context, fold: int, dones: Collection[int], places: Places) -> Miss | None:
    """Return what the closest attempt lacked, among those with no other obstacle; None if there is none.

    Args:
        context: the planning context, with the attempts made.
        fold: the fold.
        dones: the sets of folds done, as bit masks, after which attempts count.
        places: where the cloth can be brought.
    """
    attempts = [attempt for attempt in context.obstacles.attempts(fold) if attempt.state.done in dones]
    each = max(1, CANDIDATES_MAX // max(1, len(attempts)))
    candidates = [candidate for attempt in attempts for candidate in _candidates(context, attempt, places, each)]
    best: Miss | None = None
    examined = 0
    for number, candidate in enumerate(sorted(candidates, key=lambda c: c.bound_m)):
        at_most_m = math.inf if best is None else best.short_by_m
        is_enough = examined >= EXAMINED_MAX or context.deadline.is_over
        if candidate.bound_m >= at_most_m or (is_enough and best is not None):
            break
        state = candidate.state
        is_to_be_sure = bool(state.held) or number >= _UNSURE_MAX
        stands = places.stands(state) if is_to_be_sure else (1 << context.standoffs) - 1
        if stands and geometric_obstacle(context, state, fold) is None:
            examined += 1
            miss = _miss(context, candidate.attempt, state, stands, at_most_m)
            if miss is not None and miss.short_by_m < at_most_m and places.stands(state):
                best = miss
    return best


def miss_in(context: Context, state: State, fold: int) -> Miss | None:
    """Return what the closest attempt in a state lacks, from any station; None if one lacks nothing."""
    best: Miss | None = None
    for at in from_every_station(context, state):
        for trial in fold_trials(context, at, fold):
            at_most_m = math.inf if best is None else best.short_by_m
            stands = 1 << at.standoff if at.held else (1 << context.standoffs) - 1
            miss = miss_of(context, at, trial, stands, at_most_m)
            if miss is None:
                return None
            if miss.short_by_m < at_most_m:
                best = miss
    return best


def from_every_station(context: Context, state: State) -> Iterator[State]:
    """Yield a state with the base at each station, or at its own station where something is held."""
    for station in (state.station,) if state.held else range(len(context.scene.stations)):
        yield State(state.done, state.offset, station, state.standoff, state.held, state.dragged)


def _candidates(context: Context, attempt: Attempt, places: Places, at_most: int) -> Iterator[_Candidate]:
    """Yield an attempt at its places where the cloth may be brought, with their bounds."""
    worthy = places.worth_trying(attempt)
    if not len(worthy):
        return
    tools, station = _tools(attempt, attempt.places[worthy]), attempt.state.station
    if len(worthy) > at_most:
        nearest = np.argsort(away_from_shoulders(context, station, attempt.arms, tools), kind="stable")[:at_most]
        worthy, tools = worthy[nearest], tools[:, :, nearest]
    bounds = np.zeros(len(worthy))
    for arm, ways, approaches in zip(attempt.arms, tools, attempt.approaches, strict=True):
        in_base = context.in_base(station, ways.transpose(1, 0, 2))
        found = context.reach.at_least_short(ReachQuery(arm, in_base, approaches, context.standoffs))
        bounds = np.maximum(bounds, found)
    for place, bound in zip(worthy, bounds, strict=True):
        yield _Candidate(attempt, int(place), float(bound))


def _tools(attempt: Attempt, places: FloatArray) -> FloatArray:
    """Return the tools at start, apex and end at some places, shape (grips, 3, places, 3), table frame (m)."""
    shift = places - np.array(attempt.state.offset)
    raised = np.column_stack([shift, np.zeros(len(shift))])
    swept = attempt.path.tools_unrolled(attempt.points, _EXTREMES)
    unrolled = swept.transpose(1, 0, 2)[:, :, None, :] + raised
    is_hanging = np.array([not attempt.state.is_dragged, True, True])
    over_edge = attempt.path.over_edge(unrolled, attempt.path.top)
    return np.asarray(np.where(is_hanging[None, :, None, None], over_edge, unrolled))


def _miss(context: Context, attempt: Attempt, state: State, stands: int, at_most_m: float) -> Miss | None:
    """Return what an attempt lacks in one of its states; None if nothing."""
    for trial in fold_trials(context, state, attempt.fold):
        if (trial.cover, trial.arms) == (attempt.cover, attempt.arms):
            return miss_of(context, state, trial, stands, at_most_m)
    return None
