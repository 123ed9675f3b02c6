"""Find the hands, the grips and the standoffs with which a garment can be dragged (paper, Theorem 2), and where to."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import product

import numpy as np
from numpy.typing import NDArray

from planner.cloth.grip_candidates import distinct_rows
from planner.cloth.grips import GripCovers, grip_covers
from planner.cloth.must_hold import must_hold
from planner.cloth.trailing_strips import are_lost, strip_tips
from planner.errors import RequestError
from planner.geometry.pose import BoolArray, FloatArray, Point2
from planner.geometry.reach_query import ReachQuery
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M, grid_key, grid_keys
from planner.primitives.context import DRAGS_PER_M, Context
from planner.primitives.grasping import approaches_from_outside, assignments, hand_keys, nearest_pair_m
from planner.primitives.primitive import HeldTools, is_taken_alike
from planner.primitives.state import State
from planner.task.plan import PlanStep
from planner.task.trajectory import Segment


def longest_drag(context: Context) -> int:
    """Return the length of the longest drag, in steps of the grid of drags.

    It is the garment's length: the longer side of its smallest enclosing rectangle.
    """
    return math.floor(context.sequence.garment.pattern.length * DRAGS_PER_M + LENGTH_M)


def dragged(context: Context, offset: Point2, station: int, steps: int) -> Point2:
    """Return the garment's offset from the start (m) after a drag from a station by `steps` of the grid of drags."""
    yaw = context.station_pose(station).yaw_rad
    distance = steps / DRAGS_PER_M
    return (offset[0] - distance * math.cos(yaw), offset[1] - distance * math.sin(yaw))


def arm_drag_steps(context: Context, station: int) -> tuple[Point2, ...]:
    """Return the garment's displacement in one step of a drag by the arms in each direction, table frame (m).

    They lead to the eight neighbours on a grid along the axes of the station.
    """
    yaw, step = context.station_pose(station).yaw_rad, 1 / DRAGS_PER_M
    ahead, aside = (step * math.cos(yaw), step * math.sin(yaw)), (-step * math.sin(yaw), step * math.cos(yaw))
    return tuple(
        (x * ahead[0] + y * aside[0], x * ahead[1] + y * aside[1]) for x, y in product((-1, 0, 1), repeat=2) if x or y
    )


def arm_dragged(offset: Point2, step: Point2, steps: int) -> Point2:
    """Return the garment's offset from the start (m) after a drag by the arms by some steps."""
    return (offset[0] + steps * step[0], offset[1] + steps * step[1])


def towards_robot(context: Context, station: int) -> Point2:
    """Return the direction of a drag from a station: a unit vector, garment frame."""
    heading = context.station_pose(station).yaw_rad + math.pi - context.placement.yaw_rad
    return (math.cos(heading), math.sin(heading))


def along(context: Context, move: Point2) -> Point2:
    """Return the direction of a displacement in the table frame: a unit vector, garment frame."""
    heading = math.atan2(move[1], move[0]) - context.placement.yaw_rad
    return (math.cos(heading), math.sin(heading))


def hangs_ahead(context: Context, done: int, offset: Point2, towards: Point2) -> bool:
    """Return whether cloth already hangs over an edge towards which a drag would go."""
    coordinates = context.sequence.cloth(done).silhouette.coordinates
    for edge in context.table_in_garment(offset).edges:
        outwards = -(edge.left[0] * towards[0] + edge.left[1] * towards[1])
        if outwards > ANGLE_RAD and edge.left_distances(coordinates).min() < -LENGTH_M:
            return True
    return False


def drag_covers(context: Context, done: int, offset: Point2, towards: Point2) -> GripCovers:
    """Return the grips for what must be held of the part on the table: by Theorem 2, and the tips of trailing strips.

    Where that is all of it, they are the same wherever it lies, and kept.
    """
    where = None if context.is_all_on_table(done, offset) else offset
    key, known = (done, where, towards, len(context.reach.arm_names)), context.cloth.drag_covers
    found = known.get(key)
    if found is None:
        found = known[key] = _drag_covers(context, done, offset, towards)
    return found


def _drag_covers(context: Context, done: int, offset: Point2, towards: Point2) -> GripCovers:
    silhouette = context.sequence.cloth(done).silhouette
    lying = silhouette.intersection(context.table_in_garment(offset).region)
    vertices, tips = must_hold(lying, towards, (), context.scene.support_angle_rad), strip_tips(lying, towards)
    vertices = distinct_rows(np.concatenate([vertices, tips]))
    radius_m, hands = context.sequence.garment.grip_radius_m, len(context.reach.arm_names)
    is_lost = partial(are_lost, vertices=vertices, tips=tips, up=towards) if len(tips) else None
    return grip_covers(lying, vertices, radius_m, hands, is_lost=is_lost)


def drag_offsets(context: Context, most: int) -> FloatArray:
    """Return the offsets to which drags can carry the garment with a part of it on the table, shape (n, 2), m.

    The search for offsets stops once there are more than `most`.
    """
    table, size = context.scene.table, context.sequence.garment.pattern.bounds
    corners = context.placement.to_outer(np.array([(size[i], size[j]) for i in (0, 2) for j in (1, 3)]))
    low, high = corners.min(axis=0), corners.max(axis=0)
    half = np.array([table.depth_m / 2, table.width_m / 2])
    (x0, y0), (x1, y1) = (-half - high).tolist(), (half - low).tolist()
    steps = [dragged(context, (0.0, 0.0), station, 1) for station in range(len(context.scene.stations))]
    if context.is_fixed:
        steps = list(arm_drag_steps(context, 0))
    found: dict[tuple[int, int], Point2] = {(0, 0): (0.0, 0.0)}
    front = [(0.0, 0.0)]
    while front and len(found) <= most:
        x, y = front.pop()
        for dx, dy in steps:
            after = (x + dx, y + dy)
            key = (grid_key(after[0]), grid_key(after[1]))
            if key not in found and x0 < after[0] < x1 and y0 < after[1] < y1:
                found[key] = after
                front.append(after)
    return np.array(list(found.values()))


_STILL: Point2 = (0.0, 0.0)

_WAYPOINT_M = 0.05
"""The largest distance between the points at which arms that drag must be within reach (m)."""


@dataclass(frozen=True, eq=False)
class DragWay:
    """An assignment of arms to the grips of a drag.

    Attributes:
        arms: the arm that holds each grip.
        grips: the points held, garment frame (m).
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
        """The point that each arm holds, garment frame (m)."""
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
        """Return all choices of arms and grips with which the base can drag the garment from where it lies."""
        return self._of(state, _STILL)

    def by_arms(self, state: State, move: Point2) -> tuple[DragWay, ...]:
        """Return all choices of arms and grips that can move the garment from where it lies (m), table frame.

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
        taken: the point that each arm holds, garment frame (m).

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
        grip: the point held, garment frame (m).
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
