"""Drive the base from one station to another, round the table (paper, section 6, Move).

The base backs out until the circle round it is clear of the table and turns in place. It then drives the shortest
polyline outside the table grown by that circle (with square corners), turning at each bend. Finally it turns to the
station's heading and drives in. Each of these legs goes from rest to rest.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

from planner.errors import RequestError
from planner.geometry.pose import Approach, Point2, wrapped_angle
from planner.geometry.table_top import TableTop
from planner.primitives.context import Context
from planner.primitives.primitive import Deferred, DeferredSteps, HeldTools
from planner.primitives.route import Route, place_of, route_round
from planner.primitives.state import State
from planner.task.grip import Grip, Holding
from planner.task.phase import ClothMotion, Hand, Phase
from planner.task.plan_step import PlanStep


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

    def phases(self) -> tuple[Phase, ...]:
        """Return one phase for each leg, with empty hands."""
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
