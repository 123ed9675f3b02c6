"""Find which attempt at a fold came closest, among all that the arms could not follow.

There are hundreds: stations, places that drags lead to, choices of grips and arms. Computing what one attempt truly
lacks takes a few milliseconds, a lower bound on it some microseconds. So the attempts are checked in the order of their
bounds, and once a bound exceeds the least shortfall found, no better attempt is left.
"""

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass

import numpy as np

from planner.explain.reason_attempt import miss_of
from planner.explain.reason_miss import Miss
from planner.explain.reason_places import Places
from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.pose import FloatArray
from planner.primitives.context import STANDOFF_STEP_M, Context
from planner.primitives.fold_obstacles import geometric_obstacle
from planner.primitives.fold_trial import fold_trials
from planner.primitives.fold_way import away_from_shoulders
from planner.primitives.obstacle import Attempt
from planner.primitives.state import State

CANDIDATES_MAX = 1000
"""Candidates examined; of more, only those that are roughly nearest to the arms' reach."""

EXAMINED_MAX = 32
"""Candidates with the least bounds that are examined exactly."""

_UNSURE_MAX = 8
"""Candidates examined before it is known whether the cloth can be brought there, which usually takes longer."""

_EXTREMES = np.array([0.0, 1.0, 2.0])
"""The sweeps at start, apex and end of a fold."""


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
        """The state with the article at the place."""
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
        found = context.reach.at_least_short(arm, in_base, approaches, context.standoffs, STANDOFF_STEP_M)
        bounds = np.maximum(bounds, found)
    for place, bound in zip(worthy, bounds, strict=True):
        yield _Candidate(attempt, int(place), float(bound))


def _tools(attempt: Attempt, places: FloatArray) -> FloatArray:
    """Return the tools at start, apex and end at some places, shape (grips, 3, places, 3), table frame (m)."""
    shift = places - np.array(attempt.state.offset)
    raised = np.column_stack([shift, np.full(len(shift), REST_HEIGHT_M)])
    swept = attempt.path.swept(attempt.points, _EXTREMES[:, None])
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
