"""The g-fold: reach the grips, lift them over the fold line, lay them down (paper, sections 6 and 7)."""

from collections.abc import Iterable, Iterator
from functools import partial

from planner.geometry.driving import IMPOSSIBLE
from planner.primitives.context import Context
from planner.primitives.fold_query import FoldQueries
from planner.primitives.fold_stands import FoldStands
from planner.primitives.fold_step import FoldStep, fold_step
from planner.primitives.primitive import Deferred, DeferredSteps
from planner.primitives.state import ANYWHERE, State


class GFold:
    """Performs any fold that the Fold-DAG makes available."""

    begins_with_driving = True

    def __init__(self, context: Context) -> None:
        self._context = context
        self._queries = context.kept(FoldQueries)
        self._follows_at_once = [context.sequence.dag.follows_at_once(fold.index) for fold in context.sequence.folds]
        self._stands = context.kept(FoldStands) if context.sequence.dag.is_loose else None

    def successors(self, state: State) -> Iterable[FoldStep]:
        """Return one step for each available fold and each final standoff that no other beats."""
        folds = self._context.available(state.done)
        if state.is_dragged:
            folds = tuple(fold for fold in folds if not self._context.sequence.folds[fold].is_red)
        return DeferredSteps(tuple([self._later(state, fold, 0) for fold in folds]))

    def _later(self, state: State, fold: int, driven: int) -> Deferred[FoldStep]:
        """Return deferred steps that need at least `driven` steps of driving."""
        motions = 2 if state.held else 3
        duration = motions * self._context.scene.arm_motion_s + self._context.drive_s(driven)
        towards = State(state.done | 1 << fold, state.offset, state.station, ANYWHERE)
        return Deferred(duration, towards, partial(self._begun, state, fold, driven), is_there=True)

    def _begun(self, state: State, fold: int, driven: int) -> Iterator[FoldStep | Deferred[FoldStep]]:
        """Yield the steps of a fold, deferred again if the fold needs more driving whatever other folds are done.

        That bound is computed once for all of the many states in which loose folds may be done.
        """
        if self._stands is not None and not state.held:
            least = int(self._stands.least(fold, state.offset, state.station)[state.standoff])
            if driven < least:
                yield self._later(state, fold, least)
                return
        yield from self._steps(state, fold, driven if driven < IMPOSSIBLE else 0)

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
            yield self._later(state, fold, more)
