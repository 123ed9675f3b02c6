"""Find the sites that drags and moves reach within a horizon; see `planner.primitives.relaxed_sites`."""

import heapq
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from planner.geometry.front import Front
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.tolerance import LENGTH_M, grid_key
from planner.primitives.base_move import BaseMove
from planner.primitives.context import Context
from planner.primitives.drag_way import dragged, longest_drag, towards_robot
from planner.primitives.fold_obstacles import is_line_on_table
from planner.primitives.holding_drags import STEPS_PER_DRAG
from planner.primitives.relaxed_sites import NOWHERE, OUTSIDE, Sites
from planner.primitives.state import UNDRAGGED, State


class Service:
    """The folds of a task that the grips left by drags may serve; all other folds are ruled out.

    A drag holds what lies at the cloth's front, towards the robot (Theorem 2). A fold that uses the same grips needs
    them on the part that it moves. The vertices to be held depend on all earlier folds, but every edge of the cloth is
    an edge of the pattern, an edge of a part that a fold moves (before or after it is moved), or a fold line. If cloth
    that no fold moves, or the fold's own part, lies just in front of every such edge near the part, then no drag ever
    holds a grip there.
    """

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


SiteKey = tuple[int, int, int]
"""A site on the grid: the garment's place (x, y) and the station."""


@dataclass(frozen=True, slots=True)
class Site:
    """A place of the garment and a station.

    Attributes:
        offset: how far the garment has been dragged (m).
        station: where the robot stands.
    """

    offset: Point2
    station: int

    @property
    def key(self) -> SiteKey:
        """The site on the grid."""
        return grid_key(self.offset[0]), grid_key(self.offset[1]), self.station


class SiteMap:
    """The sites and the ways between them, explored from the start."""

    def __init__(self, context: Context, start: State, service: Service) -> None:
        """Begin with the site of the start state."""
        self._context = context
        self._service = service
        self._start = Site(start.offset, start.station)
        self._moves = context.kept(BaseMove)
        self._longest = longest_drag(context)
        self._moves_s: dict[tuple[int, int], FloatArray] = {}

    def within(self, horizon_s: float, most: int) -> tuple[tuple[Site, ...], bool]:
        """Return up to `most` sites within a horizon of the start (s), nearest first, and whether these are all."""
        found: dict[SiteKey, Site] = {}
        queue: list[tuple[float, int, Site]] = [(0.0, 0, self._start)]
        count = 0
        while queue and len(found) < most:
            away_s, _, site = heapq.heappop(queue)
            if away_s >= horizon_s:
                return tuple(found.values()), False
            if site.key in found:
                continue
            found[site.key] = site
            for other, cost_s in self._beside(site):
                count += 1
                heapq.heappush(queue, (away_s + cost_s, count, other))
        return tuple(found.values()), not queue

    def sites(self, within: tuple[Site, ...], is_service_over: bool) -> Sites:
        """Return the relaxed problem of some sites; all other sites count as outside.

        Args:
            within: the sites.
            is_service_over: whether all folds that grips left by a drag might serve are done.
        """
        context = self._context
        numbers = {site.key: number for number, site in enumerate(within)}
        stations = len(context.scene.stations)
        drags = np.full((len(within), self._longest), NOWHERE)
        moves = np.full((len(within), stations), NOWHERE)
        move_s = np.zeros((len(within), stations, context.standoffs))
        may_hold = np.zeros(len(within), dtype=bool)
        for number, site in enumerate(within):
            may_hold[number] = not is_service_over and self._service.is_possible(site.offset, site.station)
            for count, goal in enumerate(self._dragged(site)):
                drags[number, count] = numbers.get(goal.key, OUTSIDE)
            for station in range(stations):
                if station != site.station:
                    moves[number, station] = numbers.get(Site(site.offset, station).key, OUTSIDE)
                    move_s[number, station] = self._move_s(site.station, station)
        drag_s = np.array([context.drag_s(count * STEPS_PER_DRAG) for count in range(1, self._longest + 1)])
        motion_s, step_s = context.scene.arm_motion_s, context.drive_s(1)
        return Sites(drags, drag_s, moves, move_s, may_hold, motion_s, step_s, STEPS_PER_DRAG)

    def _beside(self, site: Site) -> Iterator[tuple[Site, float]]:
        """Yield the neighbours of a site, with a lower bound on the time to get there (s)."""
        context = self._context
        for count, goal in enumerate(self._dragged(site), start=1):
            is_held = self._service.is_possible(goal.offset, goal.station)
            yield goal, context.drag_s(count * STEPS_PER_DRAG) + (0.0 if is_held else context.scene.arm_motion_s)
        for station in range(len(context.scene.stations)):
            if station != site.station:
                yield Site(site.offset, station), float(self._move_s(site.station, station).min())

    def _dragged(self, site: Site) -> Iterator[Site]:
        """Yield the sites to which drags lead, as long as some of the cloth may still lie on the table."""
        for count in range(1, self._longest + 1):
            offset = dragged(self._context, site.offset, site.station, count)
            if not self._context.may_be_on_table(offset):
                return
            yield Site(offset, site.station)

    def _move_s(self, station: int, goal: int) -> FloatArray:
        """Return the duration of a move from each standoff (s). Cached."""
        if (station, goal) not in self._moves_s:
            starts = (State(0, UNDRAGGED, station, standoff) for standoff in range(self._context.standoffs))
            steps = (step for start in starts for step in self._moves.to(start, goal))
            self._moves_s[station, goal] = np.array([step.duration_s for step in steps])
        return self._moves_s[station, goal]
