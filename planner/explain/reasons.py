"""Report why there is no plan: for each fold that was never done, what stood in its way, where, and by how much.

Blocked folds come first, each with its causes, the smallest repair first. Folds that only wait for them come last.
Where every fold can be done, but not all of them in sequence, the blocked folds are those left when the most were done.

A fold can be tried in many ways: with the garment here or there, from different stations, with free hands or with what
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

from planner.cloth.g_state import StabilityViolation
from planner.explain.reason_attempt import Miss
from planner.explain.reason_grips import GRIP_CODES
from planner.explain.reason_obstacle import collisions, lacking, of_obstacle
from planner.explain.reason_out_of_reach import out_of_reach
from planner.explain.reason_reach import Places, from_every_station, miss_in, nearest_miss
from planner.planning.events import Obstacles
from planner.primitives.context import Context
from planner.primitives.fold_obstacles import geometric_obstacles
from planner.primitives.fold_trial import fold_trials, grips_obstacle
from planner.primitives.fold_way import can_follow
from planner.primitives.obstacle import BlockingContact, Obstacle, Situation
from planner.primitives.primitive import Step
from planner.primitives.state import UNDRAGGED, State
from planner.task.reason import Code, Reason
from planner.words.catalogue import worded

_GEOMETRY = (Code.LINE_OFF_TABLE, Code.NOT_A_G_STATE, Code.SLIPS)
"""Codes of obstacles to how the cloth lies."""

_LOOKED_AT_MAX, _EXAMINED_MAX = 60, 3
"""Mildest obstacles of a kind for which it is checked whether the cloth can be brought there, and how many of those
that pass are examined."""


def reasons_met(obstacles: Obstacles) -> tuple[Reason, ...]:
    """Return the reasons that a search met, not tried yet."""
    context = obstacles.problem.context
    violation = obstacles.problem.stability_violation
    if violation is not None:
        return (reason_at_start(context, violation),)
    for step, contact in obstacles.contacts():
        note_collision(context, step, contact)
    return reasons(context, obstacles.reached, obstacles.impossible)


def reasons(context: Context, reached: Collection[Situation], impossible: Collection[int]) -> tuple[Reason, ...]:
    """Return the reasons once it is proven that there is no plan.

    Args:
        context: the planning context, with the obstacles met.
        reached: the situations that the search reached.
        impossible: folds that cannot be done even alone, for which the search may have ended early; empty if the search
            has exhausted all states.
    """
    return _Reasons(context, reached, impossible).all()


def reason_at_start(context: Context, violation: StabilityViolation) -> Reason:
    """Return why there is no plan for cloth that does not stay as it lies at the start."""
    state = context.start
    spread, top = context.sequence.cloth(state.done).silhouette, context.table_in_garment(state.offset)
    is_too_large = all(spread.contains(edge.start) for edge in top.edges)
    says = worded("at_start", {"what": violation.says.to_dict(), "is_too_large": is_too_large})
    return of_obstacle(context, Obstacle(None, Code(violation.code), says, violation.severity, state, violation.point))


def note_collision(context: Context, step: Step, contact: BlockingContact | None) -> None:
    """Note that the arms cannot perform a step although its places are in reach, and the blocking contact."""
    for obstacle in collisions(context, step, contact):
        context.obstacles.note(obstacle)


class _Reasons:
    """Collects the reasons why one problem has no plan."""

    def __init__(self, context: Context, reached: Collection[Situation], impossible: Collection[int]) -> None:
        self._context = context
        self._places = Places(context, reached)
        self._dones = {0, *(situation[0] for situation in reached)}
        self._impossible = impossible

    def all(self) -> tuple[Reason, ...]:
        blocked = self._blocked()
        causes = [reason for fold in blocked for reason in self._causes(fold)]
        return (*causes, *self._of_no_fold(), *self._waiting(blocked))

    def _of_no_fold(self) -> Iterator[Reason]:
        """Yield the mildest drag that the arms could not follow and that only another drag would have made useful."""
        met = sorted(self._context.obstacles.of(None), key=lambda obstacle: obstacle.severity)
        yield from (of_obstacle(self._context, obstacle) for obstacle in met[:1])

    def _blocked(self) -> list[int]:
        """Return the folds that could come next but cannot be done."""
        if self._impossible:
            return sorted(self._impossible)
        achieved = 0
        for done in self._dones:
            achieved |= done
        never = {fold for done in self._dones for fold in self._next(done) if not achieved >> fold & 1}
        return sorted(never or {fold for done in self._furthest(self._dones) for fold in self._next(done)})

    def _next(self, done: int) -> tuple[int, ...]:
        return self._context.sequence.dag.available(done)

    @staticmethod
    def _furthest(dones: Collection[int]) -> set[int]:
        """Return those sets of folds with the most folds in them."""
        most = max((done.bit_count() for done in dones), default=0)
        return {done for done in dones if done.bit_count() == most}

    def _causes(self, fold: int) -> tuple[Reason, ...]:
        """Return why a fold could not be done when the most others were."""
        could = {done for done in self._dones if fold in self._next(done)}
        met = self._context.obstacles.dones(fold)
        found = _Causes(self._context, fold, self._furthest(could & met or met), self._places).reasons()
        return found or (self._nothing_known(fold),)

    def _nothing_known(self, fold: int) -> Reason:
        """Return the reason for a fold that was not done for an unknown cause."""
        says = worded("not_with_the_others", {}, self._context.sequence.folds, fold)
        return Reason(fold, Code.WAITS_FOR_FOLD, says)

    def _waiting(self, blocked: list[int]) -> Iterator[Reason]:
        folds = self._context.sequence.folds
        for fold in folds:
            roots = [b for b in blocked if b in self._context.sequence.dag.before(fold.index)]
            if roots and fold.index not in blocked:
                says = worded("waits_for", {"folds": roots}, folds, fold.index)
                yield Reason(fold.index, Code.WAITS_FOR_FOLD, says)


@dataclass(frozen=True, slots=True)
class _Causes:
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
        lacks = [of_obstacle(self.context, o) for o in met if o.code in GRIP_CODES and self._is_only_held_up_by(o)]
        if lacks:
            yield min(lacks, key=lambda reason: lacking(reason, self.context))

    def _is_only_held_up_by(self, obstacle: Obstacle) -> bool:
        """Return whether only the hands are known to stand against the fold where an obstacle was met."""
        state = obstacle.state
        return state is None or next(geometric_obstacles(self.context, state, self.fold), None) is None

    def _together(self, met: list[Obstacle]) -> Iterator[Reason]:
        """Yield all that stands against the way that comes nearest, if several things stand against each way."""
        states = [o.state for code in _GEOMETRY for o in self._mildest(met, code) if o.state is not None]
        states = states or [State(done, UNDRAGGED, 0, 0) for done in sorted(self.dones)]
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
