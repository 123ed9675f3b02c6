"""The g-fold: reach the grips, lift them over the fold line, lay them down (paper, sections 6 and 7)."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import TypeAlias

import numpy as np

from planner.errors import RequestError
from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.pose import FloatArray, Point2
from planner.primitives.base_move import MoveTimes
from planner.primitives.context import Context
from planner.primitives.fold_query import FoldQueries, FoldStands
from planner.primitives.fold_step import FoldStep, fold_step
from planner.primitives.fold_trial import fold_trials
from planner.primitives.primitive import Deferred, DeferredSteps, HeldTools, is_taken_alike
from planner.primitives.state import ANYWHERE, State
from planner.task.plan import PlanStep
from planner.task.trajectory import Segment

_Found: TypeAlias = FoldStep | Deferred[FoldStep]
_Steps: TypeAlias = Callable[[State, int, int], Iterable[_Found]]


class GFold:
    """Performs any fold that the Fold-DAG makes available."""

    kind = FoldStep.kind
    begins_with_driving = True

    def __init__(self, context: Context) -> None:
        self._context = context
        self._queries = context.kept(FoldQueries)
        self._moves = context.kept(MoveTimes)
        self._follows_at_once = [context.sequence.dag.follows_at_once(fold.index) for fold in context.sequence.folds]
        self._stands = context.kept(FoldStands) if context.sequence.dag.is_loose else None

    def successors(self, state: State) -> Iterable[FoldStep]:
        """Return one step for each available fold and each final standoff that no other beats.

        Standoffs that others beat for all but a move come when a path with a move is as good as any.
        """
        folds = self._context.available(state.done)
        if state.is_dragged:
            folds = tuple(fold for fold in folds if not self._context.sequence.folds[fold].is_red)
        return DeferredSteps(tuple([self._later(state, fold, 0, self._begun) for fold in folds]))

    def tools(self, step: PlanStep, taken: Mapping[int, Point2], before: State, _after: State) -> HeldTools:
        """Return where the tools must be: on the path of the fold's cloth, at the sweep of the time."""
        trials = () if step.fold is None else fold_trials(self._context, before, step.fold)
        found = next((trial for trial in trials if is_taken_alike(trial.taken, taken)), None)
        if found is None:
            raise RequestError("holdings", "these grips do not hold what the fold needs")

        def at(segment: Segment, t_s: float) -> Mapping[int, FloatArray]:
            first, last = segment.phase.cloth.sweep
            sweep = first + segment.fraction_at(t_s) * (last - first)
            return dict(zip(found.arms, found.path.tool_points(found.points, sweep), strict=True))

        return at

    def _later(self, state: State, fold: int, driven: int, steps: _Steps) -> Deferred[FoldStep]:
        """Return deferred steps that need at least `driven` steps of driving."""
        duration = self._motions_s(state) + self._context.drive_s(driven)
        towards = State(state.done | 1 << fold, state.offset, state.station, ANYWHERE)
        return Deferred(duration, towards, partial(steps, state, fold, driven), is_there=True)

    def _motions_s(self, state: State) -> float:
        return (2 if state.held else 3) * self._context.scene.arm_motion_s

    def _begun(self, state: State, fold: int, driven: int) -> Iterator[FoldStep | Deferred[FoldStep]]:
        """Yield the steps of a fold, deferred again if the fold needs more driving whatever other folds are done.

        That bound is computed once for all of the many states in which loose folds may be done.
        """
        if self._stands is not None and not state.held:
            least = int(self._stands.least(fold, state.offset, state.station)[state.standoff])
            if driven < least:
                yield self._later(state, fold, least, self._begun)
                return
        yield from self._steps(state, fold, driven if driven < IMPOSSIBLE else 0)
        yield from self._before_moves(state, fold)

    def _steps(self, state: State, fold: int, driven: int) -> Iterator[FoldStep | Deferred[FoldStep]]:
        """Yield the steps with up to three times `driven` steps of driving, then deferred ones with more."""
        query, begun = self._queries.of(state, fold), self._queries.begun(state)
        if self._follows_at_once[fold]:
            ends, more = query.every_end(begun), IMPOSSIBLE
        else:
            # The limit grows geometrically, so that a fold far away is queried only a few times.
            ends, more = query.ends(begun, driven, 3 * driven)
        for end in ends:
            yield fold_step(self._context, end.way, state, end.first, end.standoff, end.steps)
        if more < IMPOSSIBLE:
            yield self._later(state, fold, more, self._steps)

    def _before_moves(self, state: State, fold: int) -> Iterator[Deferred[FoldStep]]:
        """Yield deferred steps to the standoffs that are of use for a move alone, each with the quickest move."""
        if self._follows_at_once[fold] or not self._moves.may_follow(state.done | 1 << fold):
            return
        yield self._with_move(state, fold, self._moves.at_least_s(state.station), self._near_move)

    def _near_move(self, state: State, fold: int) -> Iterator[Deferred[FoldStep]]:
        away = np.abs(np.arange(self._context.standoffs) - state.standoff)
        least_s = self._context.drive_s(1) * away + self._moves.least_s(state.station)
        yield self._with_move(state, fold, float(least_s.min()), self._to_move)

    def _to_move(self, state: State, fold: int) -> Iterator[Deferred[FoldStep]]:
        least_s = self._moves.least_s(state.station)
        query, begun = self._queries.of(state, fold), self._queries.begun(state)
        for end in query.ends_before_moves(begun, self._moves.onward(state.station)):
            step = fold_step(self._context, end.way, state, end.first, end.standoff, end.steps)
            seconds = self._context.drive_s(end.steps) + float(least_s[end.standoff])
            yield self._with_move(state, fold, seconds, partial(_alone, step))

    def _with_move(
        self, state: State, fold: int, seconds: float, steps: Callable[[State, int], Iterable[_Found]]
    ) -> Deferred[FoldStep]:
        """Return deferred steps for which driving, and the move after, take at least so many seconds."""
        towards = State(state.done | 1 << fold, state.offset, state.station, ANYWHERE)
        return Deferred(self._motions_s(state) + seconds, towards, partial(steps, state, fold))


def _alone(step: FoldStep, _state: State, _fold: int) -> tuple[FoldStep]:
    return (step,)
