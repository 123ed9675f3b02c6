"""Find what keeps one fold from being done: causes of which each alone is worth removing.

A fold can be tried in many ways: with the article here or there, from different stations, with free hands or with what
a drag has left held. In each way one or several things stand against it. A cause is something that alone stands against
some way: once it is removed, the fold can be done. The mildest of each kind is reported. If several things stand
against the fold in every way, those of the way that comes nearest are reported together.

A collision is met only where nothing else was wrong, so then it is the cause: a collision in the fold itself, or else
in a drag that the fold would need.

Insufficient hands hide the rest, since without grips there is no path to check. They are therefore a cause only where
no way fails by one other thing alone: what cannot be held with free hands may be within reach when a drag has left it
held.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import islice

from planner.explain.reason_miss import Miss
from planner.explain.reason_obstacle import lacking, of_obstacle
from planner.explain.reason_out_of_reach import out_of_reach
from planner.explain.reason_places import Places
from planner.explain.reason_reach import from_every_station, miss_in, nearest_miss
from planner.primitives.context import Context
from planner.primitives.fold_obstacles import geometric_obstacles
from planner.primitives.fold_trial import fold_trials, grips_obstacle
from planner.primitives.fold_way import can_follow
from planner.primitives.obstacle import Obstacle
from planner.primitives.state import State
from planner.task.reason import Code, Reason

_GEOMETRY = (Code.LINE_OFF_TABLE, Code.NOT_A_G_STATE, Code.SLIPS)
"""Codes of obstacles to how the cloth lies."""

_GRIPS = (Code.TOO_MANY_GRIPS, Code.GRIPS_TOO_CLOSE, Code.RED_NEEDS_HOLD)
"""Codes of obstacles to how the hands hold the cloth."""

_LOOKED_AT_MAX, _EXAMINED_MAX = 60, 3
"""Mildest obstacles of a kind for which it is checked whether the cloth can be brought there, and how many of those
that pass are examined."""


@dataclass(frozen=True, slots=True)
class Causes:
    """The causes why one fold cannot be done.

    Attributes:
        context: the planning context, with the obstacles met.
        fold: the fold.
        dones: the sets of folds done, as bit masks, after which it should have been done.
        places: where the cloth can be brought.
    """

    context: Context
    fold: int
    dones: Collection[int]
    places: Places

    def reasons(self) -> tuple[Reason, ...]:
        """Return the causes, the smallest repair first."""
        every = list(self.context.obstacles.of(self.fold))
        met = [o for o in every if o.state is None or o.state.done in self.dones]
        # After a collision the fold is tried nowhere alike, whichever other folds have been done.
        collided = sorted((o for o in every if o.code is Code.COLLISION), key=lambda o: self._rank(o, met))
        if collided:
            return (of_obstacle(self.context, collided[0]),)
        found = list(self._alone(met)) or list(self._hands(met)) or list(self._together(met))
        return tuple(sorted(found, key=lambda reason: lacking(reason, self.context)))

    def _rank(self, collision: Obstacle, met: Collection[Obstacle]) -> tuple[bool, bool]:
        return collision not in met, collision.dragged_to is not None

    def _alone(self, met: list[Obstacle]) -> Iterator[Reason]:
        """Yield each obstacle that is all that stands against some way."""
        miss = nearest_miss(self.context, self.fold, self.dones, self.places)
        if miss is not None:
            yield out_of_reach(self.context, self.fold, miss)
        for code in _GEOMETRY:
            cause = next((o for o in self._mildest(met, code) if self._is_all_else_right(o)), None)
            if cause is not None:
                yield of_obstacle(self.context, cause)

    def _is_all_else_right(self, obstacle: Obstacle) -> bool:
        """Return whether an obstacle is all that stands against the fold where it was met."""
        state = obstacle.state
        if state is None or len(list(geometric_obstacles(self.context, state, self.fold))) > 1:
            return False
        stands = self.places.stands(state)
        return bool(stands) and any(self._can_follow(at, stands) for at in from_every_station(self.context, state))

    def _can_follow(self, state: State, stands: int) -> bool:
        trials = fold_trials(self.context, state, self.fold)
        return any(can_follow(self.context, state.station, trial, stands) for trial in trials)

    def _hands(self, met: list[Obstacle]) -> Iterator[Reason]:
        """Yield that the hands do not suffice, where nothing else is known to be wrong."""
        lacks = [of_obstacle(self.context, o) for o in met if o.code in _GRIPS and self._is_only_held_up_by(o)]
        if lacks:
            yield min(lacks, key=lambda reason: lacking(reason, self.context))

    def _is_only_held_up_by(self, obstacle: Obstacle) -> bool:
        """Return whether only the hands are known to stand against the fold where an obstacle was met."""
        state = obstacle.state
        return state is None or next(geometric_obstacles(self.context, state, self.fold), None) is None

    def _together(self, met: list[Obstacle]) -> Iterator[Reason]:
        """Yield all that stands against the way that comes nearest, if several things stand against each way."""
        states = [o.state for code in _GEOMETRY for o in self._mildest(met, code) if o.state is not None]
        states = states or [State(done, (0.0, 0.0), 0, 0) for done in sorted(self.dones)]
        ways = [self._all_in(state) for state in states]
        if ways:
            against, miss = min(ways, key=self._repair)
            yield from against
            if miss is not None:
                yield out_of_reach(self.context, self.fold, miss)

    def _repair(self, way: tuple[list[Reason], Miss | None]) -> tuple[int, float]:
        """Return how many things stand against a way, and the total shortfall."""
        against, miss = way
        lack = sum(lacking(reason, self.context) for reason in against)
        return len(against) + (miss is not None), lack + (0.0 if miss is None else miss.short_by_m)

    def _mildest(self, met: list[Obstacle], code: Code) -> list[Obstacle]:
        """Return the mildest obstacles of a kind, among those met where the cloth can be brought and stays."""
        alike = sorted((o for o in met if o.code is code), key=lambda o: o.severity)[:_LOOKED_AT_MAX]
        real = (o for o in alike if o.state is not None and self.places.stands(o.state))
        return list(islice(real, _EXAMINED_MAX))

    def _all_in(self, state: State) -> tuple[list[Reason], Miss | None]:
        """Return all that stands against the fold in a state, and what the hands lack there, if they suffice."""
        against = [of_obstacle(self.context, other) for other in geometric_obstacles(self.context, state, self.fold)]
        grips = None if state.held else grips_obstacle(self.context, state, self.fold)
        if grips is not None:
            return [*against, of_obstacle(self.context, grips)], None
        return against, miss_in(self.context, state, self.fold)
