"""The drag by the arms: where the base stays, they reach for the cloth and pull it along the table."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, ClassVar

from planner.geometry.pose import Point2
from planner.geometry.tolerance import grid_key
from planner.primitives.context import Context
from planner.primitives.drag_step import DragStep
from planner.primitives.drag_way import DragWays, along, arm_drag_steps, arm_dragged, dragged_tools, longest_drag
from planner.primitives.grasping import by_nearness
from planner.primitives.primitive import Deferred, DeferredSteps, HeldTools
from planner.primitives.state import State
from planner.task.plan import PlanStep


@dataclass(frozen=True)
class ArmDragStep(DragStep):
    """A drag as a step of a plan in which the arms move the cloth while the base stands; the hands let go."""

    kind: str = "arm_drag"
    arm_motion: ClassVar[int | None] = 0

    @property
    def distance_m(self) -> float:
        """The distance over which the garment is dragged (m)."""
        return math.hypot(*self._move)

    @property
    def dragging_s(self) -> float:
        """The time from the grips to where the cloth is let go (s)."""
        return self.context.scene.arm_motion_s

    @property
    def towards(self) -> Point2:
        """The direction of the drag: a unit vector, garment frame."""
        return along(self.context, self._move)

    @property
    def details(self) -> dict[str, Any]:
        """The distance, the direction in the table frame, and that the hands let go."""
        x, y = self._move
        return {"distance_m": self.distance_m, "heading_rad": math.atan2(y, x), "holds": False}

    @cached_property
    def situation(self) -> tuple[object, ...]:
        """The key it shares with drags in which the hands move alike and the base stands elsewhere."""
        return (self.kind, self._direction, self.before.station, self.before.place, self.way.hands)

    @property
    def task(self) -> tuple[object, ...]:
        """The key it shares with other drags of the same cloth in this direction by the same arms."""
        return (self.kind, self.before.done, self._direction, self.before.station, frozenset(self.way.arms))

    def again(self, context: Context, state: State) -> Iterator[DragStep]:
        """Yield drags as far in the same direction, by the same hands first, then by other hands."""
        x, y = self._move
        offset = (state.offset[0] + x, state.offset[1] + y)
        if state.held or not context.stays(state.done, offset):
            return
        for way in by_nearness(self.way, context.kept(DragWays).by_arms(state, self._move)):
            for stand in sorted(way.stands, key=lambda stand: abs(stand - self.first_stand)):
                after = State(state.done, offset, state.station, stand)
                yield from self._turned_alike(ArmDragStep(context, way, state, after, stand))

    @property
    def _move(self) -> Point2:
        (x0, y0), (x1, y1) = self.before.offset, self.after.offset
        return (x1 - x0, y1 - y0)

    @property
    def _direction(self) -> tuple[int, int]:
        """The displacement in steps of the grid."""
        return grid_key(self._move[0]), grid_key(self._move[1])


class ArmDrag:
    """Drags the garment in eight directions by two arm motions, to reach and to pull, and lets go."""

    kind = ArmDragStep.kind
    begins_with_driving = True

    def __init__(self, context: Context) -> None:
        self._context = context
        self._ways = context.kept(DragWays)
        self._longest = longest_drag(context)
        self._is_possible = context.is_fixed

    def successors(self, state: State) -> Iterable[ArmDragStep]:
        """Return drags in every direction, as far as the arms reach."""
        if state.held or not self._is_possible:
            return ()
        duration_s = 2 * self._context.scene.arm_motion_s
        return DeferredSteps((Deferred(duration_s, state, partial(self._every, state)),))

    def tools(self, step: PlanStep, taken: Mapping[int, Point2], before: State, after: State) -> HeldTools:
        """Return where the tools must be: they carry the cloth along."""
        move = (after.offset[0] - before.offset[0], after.offset[1] - before.offset[1])
        return dragged_tools(self._ways.by_arms(before, move), step, taken)

    def _every(self, state: State) -> Iterator[ArmDragStep]:
        for step in arm_drag_steps(self._context, state.station):
            yield from self._along(state, step)

    def _along(self, state: State, step: Point2) -> Iterator[ArmDragStep]:
        """Yield the drags in one direction; where the arms cannot follow, they cannot go farther either."""
        for count in range(1, self._longest + 1):
            ways = self._ways.by_arms(state, arm_dragged((0.0, 0.0), step, count))
            if not ways:
                break
            offset = arm_dragged(state.offset, step, count)
            if self._context.stays(state.done, offset):
                stand = ways[0].stands[0]
                yield ArmDragStep(self._context, ways[0], state, State(state.done, offset, state.station, stand), stand)
