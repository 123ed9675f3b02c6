"""What keeps one fold from being done, each cause on its own enough to mend.

A fold can be tried in many ways: with the article here or there, from this station or that one, with free hands or with
what a drag has left held. In each way one thing or several stand against it. A cause is what is the only thing that
stands against some way: mend it and the fold can be done. Of each kind the mildest is named. If in every way several
things stand against the fold, those of the way that comes nearest are named together.

A collision is met only where nothing else was wrong, so then it is the cause: one in the fold itself, or else one in
a drag that it would need.

Hands that do not suffice hide the rest: without grips there is no path to ask about. So that is a cause only where no
way is known that fails by one thing alone: what cannot be held with free hands may be within reach when a drag has left
it held.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass

from planner.plan.reason import Reason
from planner.plan.reason_obstacle import lacking, of_obstacle
from planner.plan.reason_places import Places
from planner.plan.reason_reach import from_every_station, miss_in, nearest_miss
from planner.plan.reason_words import out_of_reach
from planner.primitives.fold_trial import fold_trials, geometric_obstacles, grips_obstacle
from planner.primitives.fold_way import can_follow
from planner.primitives.obstacle import Code, Obstacle
from planner.primitives.state import State
from planner.primitives.work import Work

_GEOMETRY = (Code.LINE_OFF_TABLE, Code.NOT_A_G_STATE, Code.SLIPS)
_GRIPS = (Code.TOO_MANY_GRIPS, Code.GRIPS_TOO_CLOSE, Code.RED_NEEDS_HOLD)

_EXAMINED_MAX = 3
"""So many of the mildest obstacles of a kind are examined."""


@dataclass(frozen=True, slots=True)
class Causes:
    """Why one fold cannot be done.

    Attributes:
        work: the problem, with what was met.
        fold: the fold.
        dones: the sets of folds done, as bit masks, after which it should have been done.
        places: where the cloth can be brought.
    """

    work: Work
    fold: int
    dones: Collection[int]
    places: Places

    def reasons(self) -> tuple[Reason, ...]:
        """The causes, the smallest repair first."""
        met = [o for o in self.work.obstacles.of(self.fold) if o.state is None or o.state.done in self.dones]
        collided = sorted((o for o in met if o.code is Code.COLLISION), key=lambda o: o.dragged_to is not None)
        if collided:
            return (of_obstacle(self.work, collided[0]),)
        found = list(self._alone(met)) or list(self._hands(met)) or list(self._together(met))
        return tuple(sorted(found, key=lambda reason: lacking(reason, self.work)))

    def _alone(self, met: list[Obstacle]) -> Iterator[Reason]:
        """What stands alone against some way."""
        miss = nearest_miss(self.work, self.fold, self.dones, self.places)
        if miss is not None:
            yield out_of_reach(self.work, self.fold, miss)
        for code in _GEOMETRY:
            mildest = sorted((o for o in met if o.code is code), key=lambda o: o.severity)[:_EXAMINED_MAX]
            cause = next((o for o in mildest if self._is_all_else_right(o)), None)
            if cause is not None:
                yield of_obstacle(self.work, cause)

    def _is_all_else_right(self, obstacle: Obstacle) -> bool:
        """Whether nothing but an obstacle stands against the fold where it was met."""
        state = obstacle.state
        if state is None or len(list(geometric_obstacles(self.work, state, self.fold))) > 1:
            return False
        stands = self.places.stands(state)
        return bool(stands) and any(self._can_follow(at, stands) for at in from_every_station(self.work, state))

    def _can_follow(self, state: State, stands: int) -> bool:
        trials = fold_trials(self.work, state, self.fold)
        return any(can_follow(self.work, state.station, trial, stands) for trial in trials)

    def _hands(self, met: list[Obstacle]) -> Iterator[Reason]:
        """The hands not sufficing, where nothing else is known to be wrong."""
        lacks = [of_obstacle(self.work, o) for o in met if o.code in _GRIPS and self._is_only_held_up_by(o)]
        if lacks:
            yield min(lacks, key=lambda reason: lacking(reason, self.work))

    def _is_only_held_up_by(self, obstacle: Obstacle) -> bool:
        """Whether nothing but its hands is known to stand against the fold where an obstacle was met."""
        state = obstacle.state
        return state is None or next(geometric_obstacles(self.work, state, self.fold), None) is None

    def _together(self, met: list[Obstacle]) -> Iterator[Reason]:
        """All that stands against the way that comes nearest, several things in each."""
        ways = [list(self._all_in(o)) for o in _mildest(met)]
        if ways:
            yield from min(ways, key=lambda way: (len(way), sum(lacking(reason, self.work) for reason in way)))

    def _all_in(self, obstacle: Obstacle) -> Iterator[Reason]:
        """All that stands against the fold in the state in which an obstacle was met."""
        state = obstacle.state
        if state is None:
            return
        for other in geometric_obstacles(self.work, state, self.fold):
            yield of_obstacle(self.work, other)
        grips = None if state.held else grips_obstacle(self.work, state, self.fold)
        if grips is not None:
            yield of_obstacle(self.work, grips)
            return
        miss = miss_in(self.work, state, self.fold)
        if miss is not None:
            yield out_of_reach(self.work, self.fold, miss)


def _mildest(met: list[Obstacle]) -> Iterator[Obstacle]:
    for code in _GEOMETRY:
        yield from sorted((o for o in met if o.code is code), key=lambda o: o.severity)[:_EXAMINED_MAX]
