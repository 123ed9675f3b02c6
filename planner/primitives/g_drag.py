"""The g-drag: the base backs off with the arms still, and the cloth comes along (paper, section 6)."""

from collections.abc import Iterable, Iterator
from functools import partial

import numpy as np

from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.pose import Point2
from planner.primitives.base_legs import unbeaten
from planner.primitives.context import Context
from planner.primitives.drag_grips import dragged, longest_drag
from planner.primitives.drag_step import DragStep
from planner.primitives.drag_way import DragWay, DragWays
from planner.primitives.holding_drags import STEPS_PER_DRAG, HoldingDrags
from planner.primitives.primitive import Deferred, DeferredSteps
from planner.primitives.state import State


class GDrag:
    """Drags the article towards the robot, in steps of 10 cm."""

    begins_with_driving = True

    def __init__(self, context: Context) -> None:
        self._context = context
        self._ways = context.kept(DragWays)
        self._holding = context.kept(HoldingDrags)
        self._longest = longest_drag(context)

    def successors(self, state: State) -> Iterable[DragStep]:
        """Return drags of every distance that let go afterwards or, if a fold can use the grips, hold on."""
        if state.held:
            return DeferredSteps(())
        held = State(state.done, state.offset, state.station, 0, dragged=1)
        return DeferredSteps((*self._later(state, 1, state), *self._later(state, 1, held)))

    def by(self, state: State, count: int) -> Iterator[DragStep]:
        """Yield the drags of one distance, `count` steps of the grid of drags."""
        ways = () if state.held else self._ways.of(state)
        offset = dragged(self._context, state.offset, state.station, count)
        if ways and self._context.unrest(state.done, offset) is None:
            yield from self._letting_go(state, ways, count, offset)
            for way in ways:
                yield from self._holding.every(state, way, count, offset)

    def _later(self, state: State, count: int, towards: State) -> Iterator[Deferred[DragStep]]:
        """Yield deferred drags of at least `count` steps of the grid; the hands hold on if they do in `towards`."""
        if count <= self._longest:
            duration = self._context.scene.arm_motion_s + self._context.drag_s(count * STEPS_PER_DRAG)
            yield Deferred(duration, towards, partial(self._steps, state, count, towards))

    def _steps(self, state: State, count: int, towards: State) -> Iterator[DragStep | Deferred[DragStep]]:
        """Yield the drags of `count` steps of the grid, then deferred longer ones."""
        ways = self._ways.of(state)
        if not ways:
            return
        offset = dragged(self._context, state.offset, state.station, count)
        if self._context.unrest(state.done, offset) is None:
            if towards.is_dragged:
                for way in ways:
                    yield from self._holding.successors(state, way, count, offset)
            else:
                yield from self._letting_go(state, ways, count, offset)
        yield from self._later(state, count + 1, towards)

    def _letting_go(self, state: State, ways: tuple[DragWay, ...], count: int, offset: Point2) -> Iterator[DragStep]:
        """Yield the cheapest drag to each final standoff that driving on from another one does not reach as cheaply."""
        best: dict[int, DragWay] = {}
        for way in ways:
            for stand in way.stands:
                best.setdefault(stand, way)
        steps = np.full(self._context.standoffs, IMPOSSIBLE)
        for stand in best:
            end = stand + count * STEPS_PER_DRAG
            if end < len(steps):
                steps[end] = abs(state.standoff - stand) + end - stand
        for end in unbeaten(steps):
            stand = end - count * STEPS_PER_DRAG
            after = State(state.done, offset, state.station, end)
            yield DragStep(self._context, best[stand], state, after, stand)
