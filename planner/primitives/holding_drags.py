"""Drags after which the hands hold on.

Holding on is of use only for a fold, and the base's standoff in between matters to nothing else. So one query finds the
best standoff for the drag and the fold together; drags to all other standoffs are spare.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE, STANDOFFS_PER_M
from planner.geometry.pose import Point2
from planner.primitives.base_move import MoveTimes
from planner.primitives.context import DRAGS_PER_M, Context
from planner.primitives.drag_step import DragStep
from planner.primitives.drag_way import DragWay
from planner.primitives.fold_query import FoldQueries
from planner.primitives.grasping import held_covers
from planner.primitives.primitive import Deferred
from planner.primitives.state import Held, State

STEPS_PER_DRAG = STANDOFFS_PER_M // DRAGS_PER_M
"""The steps of the grid of standoffs in one step of the grid of drags."""


class _Drag(NamedTuple):
    """A drag by given hands, whatever the standoff of the base when it begins.

    Attributes:
        before: the state it starts in.
        way: grips and arms.
        driven: the steps of the grid of standoffs that the base drives with the cloth.
        outcomes: the states in which it may end.
    """

    before: State
    way: DragWay
    driven: int
    outcomes: "_Outcomes"


@dataclass(frozen=True, slots=True, eq=False)
class _Outcomes:
    """The states in which a drag by given hands may end, begun in states that differ in their standoff alone.

    Attributes:
        done: the folds done, as a bit mask.
        offset: how far the garment has been carried since the start, table frame (m).
        station: the base's station.
        held: the grips held.
        count: the length of the drag, in steps of the grid of drags.
        ends: the standoffs at which it may end, shape (n,).
        folds: the folds that can then be done with the grips.
    """

    done: int
    offset: Point2
    station: int
    held: tuple[Held, ...]
    count: int
    ends: NDArray[np.int64]
    folds: tuple[int, ...]
    _afters: dict[int, State] = field(default_factory=dict)

    @property
    def first(self) -> State:
        """One of these states."""
        return self.after(int(self.ends[0]))

    def after(self, end: int) -> State:
        """Return the state with the base at a standoff, made on demand: most are never needed."""
        if end not in self._afters:
            self._afters[end] = State(self.done, self.offset, self.station, end, self.held, self.count)
        return self._afters[end]


class HoldingDrags:
    """The drags of one task after which the hands hold on."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._queries = context.kept(FoldQueries)
        self._moves = context.kept(MoveTimes)
        self._outcomes: dict[tuple[object, ...], _Outcomes] = {}

    def every(self, state: State, way: DragWay, count: int, offset: Point2) -> Iterator[DragStep]:
        """Yield the drags by `count` steps of the grid of drags that leave grips of use to some fold."""
        drag = self._drag(state, way, count, offset)
        if drag.outcomes.folds:
            yield from self._every_step(drag)

    def successors(
        self, state: State, way: DragWay, count: int, offset: Point2
    ) -> Iterator[DragStep | Deferred[DragStep]]:
        """Yield the drags of `every`, those first that are cheapest together with a fold; defer the rest as spare."""
        drag = self._drag(state, way, count, offset)
        folds = drag.outcomes.folds
        if any(self._context.sequence.dag.follows_at_once(fold) for fold in folds):
            yield from self._every_step(drag)
        elif folds:
            for fold in folds:
                yield from self._serving(drag, fold, drag.driven)
                yield from self._serving_before_moves(drag, fold)
            yield self._later(drag, drag.driven, lambda: self._every_step(drag), is_spare=True)

    def _drag(self, state: State, way: DragWay, count: int, offset: Point2) -> _Drag:
        key = (state.done, state.place, state.station, way, count)
        if key not in self._outcomes:
            self._outcomes[key] = self._outcomes_of(state, way, count, offset)
        return _Drag(state, way, count * STEPS_PER_DRAG, self._outcomes[key])

    def _outcomes_of(self, state: State, way: DragWay, count: int, offset: Point2) -> _Outcomes:
        held = tuple(Held(arm, grip) for arm, grip in sorted(zip(way.arms, way.grips, strict=True)))
        ends = np.array(way.stands, dtype=np.int64) + count * STEPS_PER_DRAG
        ends = ends[ends < self._context.standoffs]
        folds = self._served(state, held) if len(ends) else ()
        return _Outcomes(state.done, offset, state.station, held, count, ends, folds)

    def _every_step(self, drag: _Drag) -> Iterator[DragStep]:
        return (self._step(drag, drag.outcomes.after(end)) for end in drag.outcomes.ends.tolist())

    def _step(self, drag: _Drag, after: State) -> DragStep:
        return DragStep(self._context, drag.way, drag.before, after, after.standoff - drag.driven)

    def _served(self, state: State, held: tuple[Held, ...]) -> tuple[int, ...]:
        """Return the folds that can be done with the grips."""
        sequence = self._context.sequence
        blue = (fold for fold in self._context.available(state.done) if not sequence.folds[fold].is_red)
        return tuple(fold for fold in blue if held_covers(self._context, fold, held))

    def _serving(self, drag: _Drag, fold: int, least: int) -> Iterator[DragStep | Deferred[DragStep]]:
        """Yield the drags that serve a fold best, where drag and fold take at least `least` steps of driving in all."""
        begun = self._begun(drag)
        # The limit grows geometrically, so that a fold far away is queried only a few times.
        most = drag.driven + 3 * (least - drag.driven)
        ends, more = self._queries.of(drag.outcomes.first, fold).ends(begun, least, most)
        for end in ends:
            step = self._step(drag, drag.outcomes.after(end.first))
            yield self._later(drag, end.steps, partial(iter, (step,)))
        if more < IMPOSSIBLE:
            yield self._later(drag, more, partial(self._serving, drag, fold, more))

    def _begun(self, drag: _Drag) -> NDArray[np.int64]:
        """Return the steps in which the base can be at each standoff when a fold after the drag begins."""
        begun = np.full(self._context.standoffs, IMPOSSIBLE)
        at = drag.outcomes.ends
        begun[at] = np.abs(drag.before.standoff + drag.driven - at) + drag.driven
        return begun

    def _serving_before_moves(self, drag: _Drag, fold: int) -> Iterator[Deferred[DragStep]]:
        """Yield deferred drags that serve a fold best after which the base moves on, each with fold and move."""
        if self._moves.may_follow(drag.before.done | 1 << fold):
            seconds = self._context.drive_s(drag.driven) + self._moves.at_least_s(drag.before.station)
            yield self._with_move(drag, seconds, partial(self._near_move, drag, fold))

    def _near_move(self, drag: _Drag, fold: int) -> Iterator[Deferred[DragStep]]:
        places = np.arange(self._context.standoffs)
        driven = (self._begun(drag)[:, None] + np.abs(places[:, None] - places)).min(axis=0)
        least_s = self._context.drive_s(1) * driven + self._moves.least_s(drag.before.station)
        yield self._with_move(drag, float(least_s.min()), partial(self._to_move, drag, fold))

    def _to_move(self, drag: _Drag, fold: int) -> Iterator[Deferred[DragStep]]:
        query, least_s = self._queries.of(drag.outcomes.first, fold), self._moves.least_s(drag.before.station)
        for end in query.ends_before_moves(self._begun(drag), self._moves.onward(drag.before.station)):
            step = self._step(drag, drag.outcomes.after(end.first))
            seconds = self._context.drive_s(end.steps) + float(least_s[end.standoff])
            yield self._with_move(drag, seconds, partial(iter, (step,)))

    def _with_move(
        self, drag: _Drag, seconds: float, steps: Callable[[], Iterator[DragStep | Deferred[DragStep]]]
    ) -> Deferred[DragStep]:
        """Return deferred drags; driving, were it all at top speed, and the move take at least so many seconds."""
        dragging_s = self._context.drag_s(drag.driven) - self._context.drive_s(drag.driven)
        duration_s = self._context.scene.arm_motion_s + dragging_s + seconds
        return Deferred(duration_s, drag.outcomes.first, steps)

    def _later(
        self,
        drag: _Drag,
        driven: int,
        steps: Callable[[], Iterator[DragStep | Deferred[DragStep]]],
        is_spare: bool = False,
    ) -> Deferred[DragStep]:
        """Return deferred steps that drive `driven` steps in all: before, with and after the drag."""
        dragging_s, other_s = self._context.drag_s(drag.driven), self._context.drive_s(driven - drag.driven)
        duration_s = self._context.scene.arm_motion_s + dragging_s + other_s
        return Deferred(duration_s, drag.outcomes.first, steps, is_spare)
