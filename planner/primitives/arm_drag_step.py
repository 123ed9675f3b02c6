"""A drag by the arms as a step of a plan."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from planner.geometry.pose import Point2
from planner.geometry.tolerance import grid_key
from planner.primitives.context import Context
from planner.primitives.drag_grips import along
from planner.primitives.drag_step import DragStep
from planner.primitives.drag_way import DragWays
from planner.primitives.grasping import by_nearness
from planner.primitives.state import State


@dataclass(frozen=True)
class ArmDragStep(DragStep):
    """A drag as a step of a plan in which the arms move the cloth while the base stands; the hands let go."""

    kind: str = "arm_drag"
    arm_motion: ClassVar[int | None] = 0

    @property
    def distance_m(self) -> float:
        """The distance over which the article is dragged (m)."""
        return math.hypot(*self._move)

    @property
    def dragging_s(self) -> float:
        """The time from the grips to where the cloth is let go (s)."""
        return self.context.scene.arm_motion_s

    @property
    def towards(self) -> Point2:
        """The direction of the drag: a unit vector, article frame."""
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
