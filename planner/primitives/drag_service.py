"""Find the folds that can ever be done with the grips that a drag has left.

A drag holds what lies at the cloth's front, towards the robot (Theorem 2). A fold that uses the same grips needs them
on the part that it moves. The vertices to be held depend on all earlier folds, but every edge of the cloth is an edge
of the pattern, an edge of a part that a fold moves (before or after it is moved), or a fold line. If cloth that no fold
moves, or the fold's own part, lies just in front of every such edge near the part, then no drag ever holds a grip
there.
"""

from functools import cached_property

from planner.geometry.front import Front
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.context import Context
from planner.primitives.drag_grips import towards_robot
from planner.primitives.fold_obstacles import is_line_on_table


class Service:
    """The folds of a task that the grips left by drags may serve; all other folds are ruled out."""

    def __init__(self, context: Context) -> None:
        """Start without results; they are computed on request."""
        self._context = context

    @cached_property
    def folds(self) -> tuple[frozenset[int], ...]:
        """For each station, the folds that grips left by a drag from there may serve."""
        return tuple(self._served(station) for station in range(len(self._context.scene.stations)))

    @cached_property
    def all_folds(self) -> int:
        """The folds that a drag from any station may serve, as a bit mask."""
        return sum(1 << fold for fold in frozenset[int]().union(*self.folds))

    def is_possible(self, offset: Point2, station: int) -> bool:
        """Return whether a drag that ended at an offset (m) may serve any fold from that station."""
        return any(self.may_serve(fold, offset, station) for fold in self.folds[station])

    def may_serve(self, fold: int, offset: Point2, station: int) -> bool:
        """Return whether a drag that ended at an offset (m) may serve one fold from that station."""
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
        """The cloth that no fold moves, the part each fold moves, and all regions whose boundary may be the cloth's."""
        sequence = self._context.sequence
        moving = [sequence.moving(fold.index) for fold in sequence.folds]
        landed = [part.moved(Isometry.reflection(f.line)) for part, f in zip(moving, sequence.folds, strict=True)]
        pattern = sequence.garment.pattern
        return pattern.difference(Region.union(moving)), moving, [pattern, *moving, *landed]
