"""Which folds may ever be done with the grips that a drag has left.

A drag holds what lies at the cloth's front, towards the robot (Theorem 2), and a fold with the same grips needs them on
the part that it moves. Which vertices must be held depends on all folds done before. But whatever was done: cloth ends
only where a part that a fold moves, before it or after it, or the pattern itself ends, or along a fold line. Where the
cloth that no fold moves, or the fold's own part, lies just ahead of all such places near the part, nothing there is
ever held by a drag.
"""

from functools import cached_property

from planner.geometry.front import Front
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.context import Context
from planner.primitives.drag_grips import towards_robot
from planner.primitives.fold_trial import is_line_on_table


class Service:
    """Knows which folds of a planning problem grips left by drags may serve; they serve no others."""

    def __init__(self, context: Context) -> None:
        """Ask nothing yet."""
        self._context = context

    @cached_property
    def folds(self) -> tuple[frozenset[int], ...]:
        """For each station the folds that grips left by a drag from there may serve."""
        return tuple(self._served(station) for station in range(len(self._context.scene.stations)))

    @cached_property
    def all_folds(self) -> int:
        """The folds that a drag from any station may serve, as a bit mask."""
        return sum(1 << fold for fold in frozenset[int]().union(*self.folds))

    def is_possible(self, offset: Point2, station: int) -> bool:
        """Return whether any fold may be done where a drag from a station has ended, at an offset (m)."""
        return any(self.may_serve(fold, offset, station) for fold in self.folds[station])

    def may_serve(self, fold: int, offset: Point2, station: int) -> bool:
        """Return whether one fold may be done there with the grips that the drag has left."""
        return fold in self.folds[station] and is_line_on_table(self._context, fold, offset)

    def _served(self, station: int) -> frozenset[int]:
        sequence = self._context.sequence
        always, moving, ends = self._cloth
        front = Front.of(ends, [fold.line for fold in sequence.folds], always, towards_robot(self._context, station))
        radius = sequence.garment.grip_radius_m + LENGTH_M
        blue = (fold.index for fold in sequence.folds if not fold.is_red)
        return frozenset(fold for fold in blue if front.is_near(moving[fold], radius))

    @cached_property
    def _cloth(self) -> tuple[Region, list[Region], list[Region]]:
        """The cloth that no fold moves, what each fold moves, and all whose boundary may be the cloth's."""
        sequence = self._context.sequence
        moving = [sequence.moving(fold.index) for fold in sequence.folds]
        landed = [part.moved(Isometry.reflection(f.line)) for part, f in zip(moving, sequence.folds, strict=True)]
        pattern = sequence.garment.pattern
        return pattern.difference(Region.union(moving)), moving, [pattern, *moving, *landed]
