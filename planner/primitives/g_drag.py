"""The g-drag: the base backs off with the arms still, and the cloth comes along (paper, section 6)."""

from collections.abc import Iterable, Iterator, Mapping
from functools import partial

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.pose import Point2
from planner.primitives.base_legs import unbeaten
from planner.primitives.base_move import MoveTimes
from planner.primitives.context import Context
from planner.primitives.drag_step import DragStep
from planner.primitives.drag_way import DragWay, DragWays, dragged, dragged_tools, longest_drag
from planner.primitives.holding_drags import STEPS_PER_DRAG, HoldingDrags
from planner.primitives.primitive import Deferred, DeferredSteps, HeldTools
from planner.primitives.state import State
from planner.task.plan import PlanStep


class GDrag:
    """Drags the garment towards the robot, in steps of 10 cm."""

    kind = DragStep.kind
    begins_with_driving = True

    def __init__(self, context: Context) -> None:
        self._context = context
        self._ways = context.kept(DragWays)
        self._holding = context.kept(HoldingDrags)
        self._moves = context.kept(MoveTimes)
        self._longest = longest_drag(context)

    def successors(self, state: State) -> Iterable[DragStep]:
        """Return drags of every distance that let go afterwards or, if a fold can use the grips, hold on."""
        if state.held:
            return DeferredSteps(())
        held = State(state.done, state.offset, state.station, 0, dragged=1)
        return DeferredSteps((*self._later(state, 1, state), *self._later(state, 1, held)))

    def tools(self, step: PlanStep, taken: Mapping[int, Point2], before: State, _after: State) -> HeldTools:
        """Return where the tools must be: they keep hold of the cloth as it comes along."""
        return dragged_tools(self._ways.of(before), step, taken)

    def by(self, state: State, count: int) -> Iterator[DragStep]:
        """Yield the drags of one distance, `count` steps of the grid of drags."""
        ways = () if state.held else self._ways.of(state)
        offset = dragged(self._context, state.offset, state.station, count)
        if ways and self._context.stays(state.done, offset):
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
        if self._context.stays(state.done, offset):
            if towards.is_dragged:
                for way in ways:
                    yield from self._holding.successors(state, way, count, offset)
            else:
                yield from self._letting_go(state, ways, count, offset)
                yield from self._before_moves(state, ways, count, offset)
        yield from self._later(state, count + 1, towards)

    def _letting_go(self, state: State, ways: tuple[DragWay, ...], count: int, offset: Point2) -> Iterator[DragStep]:
        """Yield the cheapest drag to each final standoff that driving on from another one does not reach as cheaply."""
        for end in unbeaten(self._steps_to(state, ways, count)):
            yield self._to(state, ways, count, offset, end)

    def _before_moves(
        self, state: State, ways: tuple[DragWay, ...], count: int, offset: Point2
    ) -> Iterator[Deferred[DragStep]]:
        """Yield deferred drags to the other standoffs that are of use for a move, each with the quickest move."""
        if self._moves.may_follow(state.done):
            seconds, after = self._moves.at_least_s(state.station), State(state.done, offset, state.station, 0)
            duration_s = self._context.scene.arm_motion_s + self._context.drag_s(count * STEPS_PER_DRAG) + seconds
            yield Deferred(duration_s, after, partial(self._to_move, state, ways, count, offset))

    def _to_move(
        self, state: State, ways: tuple[DragWay, ...], count: int, offset: Point2
    ) -> Iterator[Deferred[DragStep]]:
        steps, least_s = self._steps_to(state, ways, count), self._moves.least_s(state.station)
        for end in sorted({*unbeaten(steps, self._moves.onward(state.station))} - {*unbeaten(steps)}):
            step = self._to(state, ways, count, offset, end)
            yield Deferred(step.duration_s + float(least_s[end]), step.after, partial(iter, (step,)))

    def _steps_to(self, state: State, ways: tuple[DragWay, ...], count: int) -> NDArray[np.int64]:
        """Return the least steps of driving in all to each final standoff, `IMPOSSIBLE` where there is no drag."""
        steps = np.full(self._context.standoffs, IMPOSSIBLE)
        for stand in {stand for way in ways for stand in way.stands}:
            end = stand + count * STEPS_PER_DRAG
            if end < len(steps):
                steps[end] = abs(state.standoff - stand) + end - stand
        return steps

    def _to(self, state: State, ways: tuple[DragWay, ...], count: int, offset: Point2, end: int) -> DragStep:
        """Return the drag to a final standoff by the best hands."""
        stand = end - count * STEPS_PER_DRAG
        way = next(way for way in ways if stand in way.stands)
        return DragStep(self._context, way, state, State(state.done, offset, state.station, end), stand)
