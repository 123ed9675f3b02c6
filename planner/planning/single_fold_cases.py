"""Enumerate what the hands may hold when a fold begins, wherever drags have carried the garment."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import permutations

import numpy as np

from planner.cloth.grips import Cover
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.tolerance import LENGTH_M
from planner.planning.budget import Budget
from planner.primitives.context import Context
from planner.primitives.drag_way import drag_covers, hangs_ahead, towards_robot
from planner.primitives.fold_trial import grips_obstacle
from planner.primitives.grasping import held_covers
from planner.primitives.state import UNDRAGGED, Held, State


@dataclass(frozen=True, eq=False)
class Case:
    """A set of folds done, and what is held for the next fold (empty: free hands).

    Attributes:
        done: the folds done, as a bit mask.
        held: what is held.
        station: the station of the drag that left it held, where hands that hold on stay; None for any station.
    """

    done: int
    held: tuple[Held, ...] = ()
    station: int | None = None

    def state(self, station: int, offset: FloatArray) -> State:
        """Return this case as a state with the robot at a station and the garment dragged by an offset (m)."""
        place = (float(offset[0]), float(offset[1]))
        return State(self.done, place, station, 0, self.held, dragged=1 if self.held else 0)


class Cases:
    """Finds the cases of one planning problem."""

    def __init__(self, context: Context, station: int, offsets: FloatArray, budget: Budget) -> None:
        """Prepare cases that begin at a station, with the offsets that drags can lead to, shape (n, 2), m."""
        self._context = context
        self._station = station
        self._offsets = offsets
        self._budget = budget

    def of(self, done: int, fold: int) -> Iterator[Case]:
        """Yield free hands, then whatever a drag that starts anywhere may leave held."""
        obstacle = grips_obstacle(self._context, State(done, UNDRAGGED, self._station, 0), fold)
        if obstacle is None:
            yield Case(done)
        else:
            self._context.obstacles.note(obstacle)
        if self._context.is_fixed:  # hands let go after drags by the arms
            return
        seen: set[tuple[object, ...]] = set()
        for offset in self._offsets_that_matter(done, fold):
            for station in range(len(self._context.scene.stations)):
                for cover in self._covers(done, offset, station):
                    key = (station, *(Held(0, point).key for point in cover))
                    if key not in seen:
                        seen.add(key)
                        yield from (Case(done, held, station) for held in self._serving(fold, cover))

    def _offsets_that_matter(self, done: int, fold: int) -> Iterator[Point2]:
        """Yield the offsets from which a drag may leave held what serves a fold, without equivalent ones.

        All offsets at which the whole garment lies on the table are equivalent. Where a part hangs, only the edge can
        be gripped, so what must be held in the fold has to be within a grip's radius of the table.
        """
        context = self._context
        silhouette = context.sequence.cloth(done).silhouette
        is_whole_seen = False
        for offset in ((float(x), float(y)) for x, y in self._offsets):
            if self._budget.is_over:
                return
            is_whole = context.table_in_garment(offset).contains(silhouette)
            if (is_whole and is_whole_seen) or not (is_whole or self._is_near(fold, offset)):
                continue
            is_whole_seen |= is_whole
            yield offset

    def _covers(self, done: int, offset: Point2, station: int) -> tuple[Cover, ...]:
        """Return the grips with which the garment may be dragged."""
        context = self._context
        towards = towards_robot(context, station)
        if hangs_ahead(context, done, offset, towards):
            return ()
        return tuple(cover for cover in context.allowed(drag_covers(context, done, offset, towards)) if cover)

    def _serving(self, fold: int, cover: Cover) -> Iterator[tuple[Held, ...]]:
        """Yield what the arms may hold with some grips, if these hold what a fold needs."""
        context = self._context
        held = tuple(Held(arm, point) for arm, point in enumerate(cover))
        if held_covers(context, fold, held):
            for arms in permutations(range(len(context.reach.arm_names)), len(cover)):
                yield tuple(Held(arm, point) for arm, point in zip(arms, cover, strict=True))

    def _is_near(self, fold: int, offset: Point2) -> bool:
        """Return whether all that must be held in a fold lies within a grip's radius of the table."""
        context = self._context
        arms = len(context.reach.arm_names)
        vertices = np.array(context.sequence.covers(fold, context.scene.support_angle_rad, arms).vertices)
        radius = context.sequence.folds[fold].grip_radius_m + LENGTH_M
        edges = context.table_in_garment(offset).edges
        return all(float(e.left_distances(vertices.reshape(-1, 2)).min(initial=0.0)) >= -radius for e in edges)
