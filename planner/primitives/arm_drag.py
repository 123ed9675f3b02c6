"""The drag by the arms: where the base stays, they reach for the cloth and pull it along the table."""

from collections.abc import Iterable, Iterator, Mapping
from functools import partial

from planner.geometry.pose import Point2
from planner.primitives.arm_drag_step import ArmDragStep
from planner.primitives.context import Context
from planner.primitives.drag_grips import arm_drag_steps, arm_dragged, longest_drag
from planner.primitives.drag_way import DragWays, dragged_tools
from planner.primitives.primitive import Deferred, DeferredSteps, HeldTools
from planner.primitives.state import State
from planner.task.plan_step import PlanStep


class ArmDrag:
    """Drags the article in eight directions by two arm motions, to reach and to pull, and lets go."""

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
