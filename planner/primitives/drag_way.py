"""Find the hands, the grips and the standoffs with which an article can be dragged."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from planner.errors import RequestError
from planner.geometry.pose import BoolArray, FloatArray, Point2
from planner.geometry.reach_query import ReachQuery
from planner.geometry.tolerance import LENGTH_M, grid_key, grid_keys
from planner.primitives.context import Context
from planner.primitives.drag_grips import along, drag_covers, hangs_ahead, towards_robot
from planner.primitives.grasping import approaches_from_outside, assignments, hand_keys, nearest_pair_m
from planner.primitives.primitive import HeldTools, is_taken_alike
from planner.primitives.state import State
from planner.task.plan import PlanStep
from planner.task.trajectory import Segment

_STILL: Point2 = (0.0, 0.0)

_WAYPOINT_M = 0.05
"""The largest distance between the points at which arms that drag must be within reach (m)."""


@dataclass(frozen=True, eq=False)
class DragWay:
    """An assignment of arms to the grips of a drag.

    Attributes:
        arms: the arm that holds each grip.
        grips: the points held, article frame (m).
        picks: the grips as tool points in the table frame, shape (grips, 3), m.
        approaches: for each standoff each arm's approach, shape (standoffs, grips); -1 where out of reach.
        move: what the arms move the cloth by (m), table frame; (0, 0) where the base drags it.
    """

    arms: tuple[int, ...]
    grips: tuple[Point2, ...]
    picks: FloatArray
    approaches: NDArray[np.int64]
    move: Point2 = _STILL

    @cached_property
    def hands(self) -> tuple[object, ...]:
        """The key that identifies it: arms, picks and approaches."""
        return (*self.tracks, self.approaches.tobytes())

    @cached_property
    def tracks(self) -> tuple[object, ...]:
        """The key of arms and picks, whatever the approaches."""
        return (self.arms, grid_keys(self.picks).tobytes())

    @cached_property
    def taken(self) -> dict[int, Point2]:
        """The point that each arm holds, article frame (m)."""
        return dict(zip(self.arms, self.grips, strict=True))

    @cached_property
    def stands(self) -> list[int]:
        """The standoffs from which all grips are within reach."""
        return [int(b) for b in np.flatnonzero((self.approaches >= 0).all(axis=1))]


class DragWays:
    """The ways to drag in each state; states with the same cloth in the same place share them."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._found: dict[tuple[object, ...], tuple[DragWay, ...]] = {}

    def of(self, state: State) -> tuple[DragWay, ...]:
        """Return all choices of arms and grips with which the base can drag the article from where it lies."""
        return self._of(state, _STILL)

    def by_arms(self, state: State, move: Point2) -> tuple[DragWay, ...]:
        """Return all choices of arms and grips that can move the article from where it lies (m), table frame.

        The hands keep their orientation, and the base stands still.
        """
        return self._of(state, move)

    def _of(self, state: State, move: Point2) -> tuple[DragWay, ...]:
        _, x, y, station, *_ = state.key
        key = (state.done, x, y, station, grid_key(move[0]), grid_key(move[1]))
        if key not in self._found:
            ways = ((self._order(state, way.arms, way.picks), way) for way in self._search(state, move) if way.stands)
            firmest_first = sorted(ways, key=lambda pair: (-len(pair[1].arms), pair[0]))
            self._found[key] = tuple(way for _, way in firmest_first)
        return self._found[key]

    def _search(self, state: State, move: Point2) -> Iterator[DragWay]:
        context = self._context
        placement = context.placed(state.offset)
        towards = towards_robot(context, state.station) if move == _STILL else along(context, move)
        if hangs_ahead(context, state.done, state.offset, towards):
            return
        for cover in context.allowed(drag_covers(context, state.done, state.offset, towards)):
            points = placement.to_outer(np.array(cover).reshape(-1, 2))
            if cover and nearest_pair_m(cover) >= context.grips_apart_m - LENGTH_M:
                picks = np.column_stack([points, context.sequence.rests(state.done).at(np.array(cover))])
                for arms in assignments(context, state.station, points):
                    order = [hand for *_, hand in self._order(state, arms, picks)]
                    grips, hands = tuple(cover[hand] for hand in order), tuple(arms[hand] for hand in order)
                    yield self._way(state, grips, hands, picks[order], move)

    def _order(self, state: State, arms: tuple[int, ...], picks: FloatArray) -> list[tuple[tuple[int, ...], int, int]]:
        """Return each hand's key, arm and number, sorted."""
        keys = hand_keys(self._context, state.station, arms, picks[:, None])
        return sorted(zip(keys, arms, range(len(arms)), strict=True))

    def _way(
        self, state: State, cover: tuple[Point2, ...], arms: tuple[int, ...], picks: FloatArray, move: Point2
    ) -> DragWay:
        context = self._context
        chosen = np.full((context.standoffs, len(cover)), -1, dtype=np.int64)
        for i, (grip, arm) in enumerate(zip(cover, arms, strict=True)):
            allowed, is_able = hands_at(context, state, grip, arm, picks[i], move)
            chosen[:, i] = np.where(is_able.any(axis=0), allowed[is_able.argmax(axis=0)], -1)
        return DragWay(arms, cover, picks, chosen, move)


def dragged_tools(ways: Sequence[DragWay], step: PlanStep, taken: Mapping[int, Point2]) -> HeldTools:
    """Return where a drag from elsewhere must have its tools: as far from their picks as the cloth has come.

    Args:
        ways: the ways in which it can be done.
        step: the drag.
        taken: the point that each arm holds, article frame (m).

    Raises:
        RequestError: these grips hold in none of the ways.
    """
    way = next((way for way in ways if is_taken_alike(way.taken, taken)), None)
    if way is None:
        raise RequestError("holdings", "these grips do not hold what the drag needs")
    picks, start = dict(zip(way.arms, way.picks, strict=True)), step.before.placement

    def at(segment: Segment, t_s: float) -> Mapping[int, FloatArray]:
        now = segment.placement_at(t_s)
        shift = np.array([now.x_m - start.x_m, now.y_m - start.y_m, 0.0])
        return {arm: pick + shift for arm, pick in picks.items()}

    return at


def hands_at(
    context: Context, state: State, grip: Point2, arm: int, pick: FloatArray, move: Point2
) -> tuple[NDArray[np.int64], BoolArray]:
    """Return the approaches with which an arm may drag, best first, and the standoffs at which it can, (k, standoffs).

    Args:
        context: the planning context.
        state: the state before the drag.
        grip: the point held, article frame (m).
        arm: the arm that takes it.
        pick: the grip as a tool point in the table frame, shape (3,), m.
        move: what the arm moves it by, table frame (m).
    """
    turn = context.placed(state.offset).yaw_rad - context.station_pose(state.station).yaw_rad
    allowed = approaches_from_outside(context, state.done, turn, grip, arm)
    shares = np.linspace(0.0, 1.0, math.ceil(math.hypot(*move) / _WAYPOINT_M) + 1)
    points = context.in_base(state.station, pick + shares[:, None] * np.array([*move, 0.0]))
    masks = context.reach.standoffs(ReachQuery(arm, points, allowed, context.standoffs))
    everywhere = np.bitwise_and.reduce(masks, axis=1)
    is_able = (everywhere[:, None] >> np.arange(context.standoffs, dtype=np.uint32) & 1).astype(bool)
    return allowed, is_able
