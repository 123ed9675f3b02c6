"""Drive the base from one station to another, round the table (paper, section 6, Move).

The base backs out until the circle round it is clear of the table and turns in place. It then drives the shortest
polyline outside the table grown by that circle (with square corners), turning at each bend. Finally it turns to the
station's heading and drives in. Each of these legs goes from rest to rest.
"""

import itertools
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from planner.errors import RequestError
from planner.geometry.pose import Approach, FloatArray, Point2, Pose2, wrapped_angle
from planner.geometry.table import Table, TableTop
from planner.geometry.tolerance import LENGTH_M, TIME_S
from planner.primitives.context import Context
from planner.primitives.drive_time import DriveTime
from planner.primitives.primitive import Deferred, DeferredSteps, HeldTools
from planner.primitives.state import State
from planner.task.plan import PlanStep
from planner.task.trajectory import ClothMotion, Hand, Phase
from planner.task.world_state import Grip, Holding

_ROUTES_KEPT = 4096
"""Routes that are remembered, some 1 kB each: all plans at a table drive between the same places."""


@dataclass(frozen=True, slots=True)
class Route:
    """A route of the base.

    Attributes:
        waypoints: base poses from start to end, table frame; between two waypoints the base either drives straight or
            turns in place, from rest to rest.
    """

    waypoints: tuple[Pose2, ...]

    def durations_s(self, time: DriveTime) -> tuple[float, ...]:
        """Return the time that each leg takes (s)."""
        legs = zip(self.waypoints[:-1], self.waypoints[1:], strict=True)
        return tuple(
            time.driving_s(math.dist((a.x_m, a.y_m), (b.x_m, b.y_m)))
            + time.turning_s(abs(wrapped_angle(b.yaw_rad - a.yaw_rad)))
            for a, b in legs
        )


@lru_cache(_ROUTES_KEPT)
def route_round(start: Pose2, goal: Pose2, table: Table, circle_m: float) -> Route:
    """Return the route of a base from one pose to another, its circle clear of the table between the two."""
    out, outside = clear_of_table(start, table, circle_m), clear_of_table(goal, table, circle_m)
    return route_along(start, out, shortest_way(place_of(out), place_of(outside), table, circle_m), outside, goal)


def clear_of_table(pose: Pose2, table: Table, circle_m: float) -> Pose2:
    """Return the pose backed out, no further than needed, until its circle is clear of the table.

    A pose whose heading is such that backing out never clears the table is returned unchanged.
    """
    half_x, half_y = table.depth_m / 2 + circle_m, table.width_m / 2 + circle_m
    if abs(pose.x_m) >= half_x - LENGTH_M or abs(pose.y_m) >= half_y - LENGTH_M:
        return pose
    dx, dy = -math.cos(pose.yaw_rad), -math.sin(pose.yaw_rad)
    ways = [
        (math.copysign(half, step) - place) / step
        for place, step, half in ((pose.x_m, dx, half_x), (pose.y_m, dy, half_y))
        if abs(step) > LENGTH_M
    ]
    return pose.ahead(-min(ways))


def shortest_way(start: Point2, goal: Point2, table: Table, circle_m: float) -> tuple[Point2, ...]:
    """Return the bends of the shortest polyline between two points outside the grown table, ends included."""
    half_x, half_y = table.depth_m / 2 + circle_m, table.width_m / 2 + circle_m
    corners = [(-half_x, -half_y), (half_x, -half_y), (half_x, half_y), (-half_x, half_y)]
    graph: nx.Graph[Point2] = nx.Graph()
    places = [start, goal, *corners]
    for i, a in enumerate(places):
        for b in places[i + 1 :]:
            if a != b and not _crosses(a, b, half_x, half_y):
                graph.add_edge(a, b, weight=math.dist(a, b))
    if start == goal:
        return (start,)
    ways: list[list[Point2]] = list(nx.all_shortest_paths(graph, start, goal, weight="weight"))
    return tuple(min(ways, key=_turning))


def route_along(start: Pose2, out: Pose2, bends: tuple[Point2, ...], outside: Pose2, goal: Pose2) -> Route:
    """Return the route that backs out, drives from bend to bend, turns to the goal's heading and drives in."""
    poses = [start, out]
    for a, b in itertools.pairwise(bends):
        if math.dist(a, b) > LENGTH_M:
            heading = math.atan2(b[1] - a[1], b[0] - a[0])
            poses += [Pose2(*a, heading), Pose2(*b, heading)]
    poses += [Pose2(outside.x_m, outside.y_m, goal.yaw_rad), goal]
    distinct = [poses[0]]
    for pose in poses[1:]:
        if not _is_same(pose, distinct[-1]):
            distinct.append(pose)
    return Route(tuple(distinct) if len(distinct) > 1 else (start, goal))


def place_of(pose: Pose2) -> Point2:
    """Return the place of a pose."""
    return (pose.x_m, pose.y_m)


def _is_same(a: Pose2, b: Pose2) -> bool:
    is_same_place = math.dist(place_of(a), place_of(b)) <= LENGTH_M
    return is_same_place and abs(wrapped_angle(a.yaw_rad - b.yaw_rad)) <= LENGTH_M


def _turning(way: Iterable[Point2]) -> float:
    """Return the sum of the turns at the bends of a polyline (rad)."""
    headings = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in itertools.pairwise(way)]
    return sum(abs(wrapped_angle(b - a)) for a, b in itertools.pairwise(headings))


def _crosses(a: Point2, b: Point2, half_x: float, half_y: float) -> bool:
    """Return whether a segment passes through the interior of the rectangle (Liang-Barsky)."""
    low, high = 0.0, 1.0
    for place, step, half in ((a[0], b[0] - a[0], half_x), (a[1], b[1] - a[1], half_y)):
        inner = half - LENGTH_M
        if abs(step) <= LENGTH_M:
            if abs(place) >= inner:
                return False
            continue
        first, second = sorted(((-inner - place) / step, (inner - place) / step))
        low, high = max(low, first), min(high, second)
    return low < high


@dataclass(frozen=True)
class MoveStep:
    """A move as a step of a plan.

    Attributes:
        context: the planning context.
        route: the route.
        before: the state it starts in.
        after: the state it leads to.
    """

    context: Context
    route: Route
    before: State
    after: State
    kind: str = "move"
    grips: tuple[Grip, ...] = ()

    @cached_property
    def _durations_s(self) -> tuple[float, ...]:
        return self.route.durations_s(self.context.drive_time)

    @cached_property
    def duration_s(self) -> float:
        """The time to drive and turn (s)."""
        return sum(self._durations_s)

    @property
    def details(self) -> dict[str, Any]:
        """The names of the two stations, and the waypoints."""
        names = [name or None for name, _ in self.context.scene.stations]
        waypoints = [[p.x_m, p.y_m, p.yaw_rad] for p in self.route.waypoints]
        return {
            "from": names[self.before.station],
            "to": names[self.after.station],
            "waypoints": waypoints,
        }

    def holdings(self) -> tuple[Holding, ...]:
        """Return nothing: the hands are empty."""
        return ()

    @property
    def phases(self) -> tuple[Phase, ...]:
        """One phase for each leg, with empty hands."""
        placement = self.context.placed(self.before.offset)
        still = ClothMotion(self.before.done, placement, placement, TableTop.of(self.context.scene.table))
        free: tuple[Hand | None, ...] = (None,) * len(self.context.reach.arm_names)
        legs = zip(self.route.waypoints[:-1], self.route.waypoints[1:], strict=True)
        return tuple(Phase(duration, leg, free, still) for duration, leg in zip(self._durations_s, legs, strict=True))

    def extremes(self) -> tuple[Phase, ...]:
        """Return nothing: no cloth is held."""
        return ()

    @property
    def hands(self) -> dict[int, Approach]:
        """Nothing: a move takes no hands."""
        return {}

    def variants(self) -> Iterable["MoveStep"]:
        """Return this step alone: there is no other route."""
        return (self,)

    @property
    def turns(self) -> Mapping[int, int]:
        """Nothing: the hands are empty."""
        return {}

    def turned(self, _turns: Mapping[int, int]) -> Iterable["MoveStep"]:
        """Return nothing: the hands are empty."""
        return ()

    @property
    def motion(self) -> tuple[object, ...]:
        """The key that identifies it: kind, state before and state after."""
        return (self.kind, self.before, self.after)

    @property
    def situation(self) -> tuple[object, ...]:
        """The key of its validation: a move is always validated by itself."""
        return (self.kind, self.before.key, self.after.key)

    @property
    def task(self) -> tuple[object, ...]:
        """The kind alone: a move takes no hands."""
        return (self.kind,)

    def begun_in(self, _state: State) -> "MoveStep":
        """Return the move unchanged."""
        return self

    def elsewhere(self, _count: int) -> Iterable["MoveStep"]:
        """Return nothing: there is no other route."""
        return ()

    def again(self, context: Context, state: State) -> Iterable["MoveStep"]:
        """Return a move to the station of the same name, if there is one."""
        wanted, _ = self.context.scene.stations[self.after.station]
        named = (number for number, (name, _) in enumerate(context.scene.stations) if name == wanted)
        return (step for number in named for step in context.kept(BaseMove).to(state, number))


class BaseMove:
    """Drives from station to station with empty hands."""

    kind = MoveStep.kind
    begins_with_driving = False

    def __init__(self, context: Context) -> None:
        self._context = context

    def successors(self, state: State) -> Iterable[MoveStep]:
        """Return one step for each other station."""
        stations = () if state.held else range(len(self._context.scene.stations))
        return DeferredSteps(tuple(self._later(state, station) for station in stations if station != state.station))

    def tools(self, _step: PlanStep, _taken: Mapping[int, Point2], _before: State, _after: State) -> HeldTools:
        """Raise `RequestError`: a move holds no cloth."""
        raise RequestError("grips", "a move holds no cloth")

    def _later(self, state: State, station: int) -> Deferred[MoveStep]:
        after = State(state.done, state.offset, station, 0)
        at_least_s = self.at_least_s(state.station, state.standoff, station)
        return Deferred(at_least_s, after, partial(self.to, state, station), is_there=True)

    def at_least_s(self, station: int, standoff: int, goal: int) -> float:
        """Return a lower bound on the time of a move that ignores all obstacles: the straight drive and the turn."""
        time, start = self._context.drive_time, self._context.base_pose(station, standoff)
        end = self._context.station_pose(goal)
        drive_s = time.driving_s(math.dist(place_of(start), place_of(end)))
        return drive_s + time.turning_s(abs(wrapped_angle(end.yaw_rad - start.yaw_rad)))

    def to(self, state: State, station: int) -> tuple[MoveStep, ...]:
        """Return the move to a station."""
        after = State(state.done, state.offset, station, 0)
        return (MoveStep(self._context, self._route(state, station), state, after),)

    def _route(self, state: State, station: int) -> Route:
        context = self._context
        start, goal = context.base_pose(state.station, state.standoff), context.station_pose(station)
        return route_round(start, goal, context.scene.table, context.circle_m)


class MoveTimes:
    """How long the moves of one task take by station and standoff, and where the base should stand before one.

    Folds and drags begin with driving to where they are done, so before them a standoff to which the base can drive on
    in time is no worse than one where it stands already. Before a move it may be worse: the leg that backs out goes
    from rest to rest, and the base turns where that ends. So a standoff that leaves no such leg, or a shorter way round
    the table, may save more than the driving there takes.
    """

    def __init__(self, context: Context) -> None:
        """Start with nothing computed: most plans never ask."""
        self._context = context
        self._moves = context.kept(BaseMove)
        self._all_done = (1 << len(context.sequence.folds)) - 1
        self._known: dict[int, FloatArray] = {}
        self._at_least_s: dict[int, float] = {}

    def may_follow(self, done: int) -> bool:
        """Return whether a move may be of use after some folds (bit mask) are done."""
        return done != self._all_done and len(self._context.scene.stations) > 1

    def at_least_s(self, station: int) -> float:
        """Return a lower bound on the time of any move from a station (s); it is found much sooner than `least_s`."""
        if station not in self._at_least_s:
            goals = [goal for goal in range(len(self._context.scene.stations)) if goal != station]
            starts = range(self._context.standoffs)
            self._at_least_s[station] = min(
                self._moves.at_least_s(station, start, g) for g in goals for start in starts
            )
        return self._at_least_s[station]

    def least_s(self, station: int) -> FloatArray:
        """Return the time of the quickest move from each standoff of a station (s), shape (standoffs,)."""
        return np.asarray(self._durations_s(station).min(axis=0))

    def onward(self, station: int) -> NDArray[np.int64]:
        """Return by how many steps of driving one standoff must come before another to make it useless before a move.

        That is as many as the base drives from one to the other, and more where each of these is worth more than its
        time: shape (standoffs, standoffs).
        """
        context, durations_s = self._context, self._durations_s(station)
        places = np.arange(context.standoffs)
        saved_s = (durations_s[:, :, None] - durations_s[:, None, :]).max(axis=0)
        saved = np.ceil((saved_s - TIME_S) / context.drive_s(1)).astype(np.int64)
        return np.asarray(np.maximum(np.abs(places[:, None] - places), saved))

    def _durations_s(self, station: int) -> FloatArray:
        """Return the duration of the move to each other station from each standoff, shape (stations - 1, standoffs)."""
        if station not in self._known:
            starts = [State(0, (0.0, 0.0), station, standoff) for standoff in range(self._context.standoffs)]
            goals = [goal for goal in range(len(self._context.scene.stations)) if goal != station]
            durations_s = [[self._moves.to(start, goal)[0].duration_s for start in starts] for goal in goals]
            self._known[station] = np.array(durations_s)
        return self._known[station]
