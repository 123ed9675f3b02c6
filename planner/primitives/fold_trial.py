"""Candidates for performing a fold, before the robot is queried: grips, arms, the path of the tools."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from planner.cloth.grips import Cover
from planner.folds.fold_path import FoldPath
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point2, point2
from planner.geometry.reach_query import ReachQuery
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.table import TableTop
from planner.geometry.tolerance import LENGTH_M, grid_keys
from planner.primitives.context import Context, Hands
from planner.primitives.fold_obstacles import depths
from planner.primitives.grasping import (
    all_approaches,
    approaches_from_outside,
    assignments,
    hand_keys,
    held_covers,
    nearest_pair_m,
    sides,
)
from planner.primitives.obstacle import Obstacle
from planner.primitives.reach import Following
from planner.primitives.state import UNDRAGGED, State
from planner.task.reason import Code


@dataclass(frozen=True, eq=False)
class FoldTrial:
    """Grips and arms that may perform a fold.

    Attributes:
        fold: the fold's index.
        cover: the points held, garment frame (m).
        arms: the arm that holds each point.
        path: the fold's path, table frame.
        points: the grips in the table frame's unrolled plane, shape (grips, 2), m.
        sweeps: the waypoints, as sweeps.
        tools: each grip's tool path in the table frame, shape (grips, waypoints, 3), m.
        approaches: for each grip the approaches allowed, best first.
    """

    fold: int
    cover: Cover
    arms: tuple[int, ...]
    path: FoldPath
    points: FloatArray
    sweeps: FloatArray
    tools: FloatArray
    approaches: tuple[NDArray[np.int64], ...]

    @cached_property
    def hands(self) -> tuple[object, ...]:
        """The key that identifies it: arms, tool paths and approaches."""
        return (*self.tracks, *(a.tobytes() for a in self.approaches))

    @cached_property
    def tracks(self) -> tuple[object, ...]:
        """The key of arms and tool paths, whatever approaches are allowed."""
        return (self.arms, grid_keys(self.tools).tobytes())

    @cached_property
    def taken(self) -> dict[int, Point2]:
        """The point that each arm holds, garment frame (m)."""
        return dict(zip(self.arms, self.cover, strict=True))

    def is_like(self, other: "FoldTrial") -> bool:
        """Return whether the same arms take the same grips, possibly elsewhere on the table."""
        return (self.cover, self.arms) == (other.cover, other.arms)

    def in_base(self, context: Context, station: int) -> FloatArray:
        """Return the tool paths in the base frame at standoff 0, shape (grips, waypoints, 3), m."""
        return context.in_base(station, self.tools)

    def following(self, context: Context, station: int) -> Following:
        """Return the query about hands that follow the tool paths from a station."""
        hands = zip(self.arms, self.in_base(context, station), self.approaches, strict=True)
        return context.reach.following([ReachQuery(*hand) for hand in hands])


def fold_trials(context: Context, state: State, fold: int) -> list[FoldTrial]:
    """Return the grips and arms that may perform a fold in a state, with the grips held or with empty hands.

    Those with more hands come first: they hold the cloth more firmly. Beyond that the order of the trials and of their
    hands depends on where things are and not on how they were drawn; a mirror image of the task has the same order.
    """
    return [
        FoldTrial(
            fold, *hands, tuple(_approaches(context, state, fold, *hand) for hand in zip(*hands[:2], strict=True))
        )
        for hands in _hands(context, state, fold)
    ]


def _hands(context: Context, state: State, fold: int) -> tuple[Hands, ...]:
    """Return the hands of all trials. They depend neither on the other folds done nor on reach, and are kept.

    Where there are none, the reason is noted each time.
    """
    scene, reach = context.scene, context.reach
    held = (state.is_dragged, tuple([(h.arm, h.point) for h in state.held]))
    robot = (
        reach.arm_names,
        context.kept(sides),
        context.station_pose(state.station),
        context.grips_apart_m,
        context.is_firm,
    )
    key, known = (fold, state.offset, held, robot, scene.edge_clear_m), context.cloth.hands
    found = known.get(key)
    if found is None:
        keyed = sorted(_searched(context, state, fold), key=lambda pair: (-len(pair[1].arms), pair[0]))
        found = tuple(hands for _, hands in keyed)
        if found:
            known[key] = found
    return found


def _searched(context: Context, state: State, fold: int) -> Iterator[tuple[list[tuple[int, ...]], Hands]]:
    """Yield the hands of each trial in order, each with their keys."""
    path, on_table = _path(context, state, fold), context.kept(_OnTable)
    for cover, arms in _grips(context, state, fold):
        flat = None if state.is_dragged else on_table.of(fold, cover, state.offset)
        if flat is None:
            points = context.placed(state.offset).to_outer(np.array(cover))
            if not path.is_continuous(points):
                continue
            sweeps = path.sweeps(points)
            flat = _Flat(points, sweeps, path.tool_paths(points, sweeps))
        keys = hand_keys(context, state.station, arms, flat.tools)
        order = sorted(range(len(arms)), key=lambda hand: (keys[hand], arms[hand]))
        ordered = tuple(cover[hand] for hand in order), tuple(arms[hand] for hand in order)
        yield (
            [keys[hand] for hand in order],
            Hands(*ordered, path, flat.points[order], flat.sweeps, flat.tools[order]),
        )


class _Flat(NamedTuple):
    """Grips and their paths.

    Attributes:
        points: the grips in the table frame's unrolled plane, shape (grips, 2), m.
        sweeps: the waypoints, as sweeps, shape (waypoints,).
        tools: each grip's tool path in the table frame, shape (grips, waypoints, 3), m.
    """

    points: FloatArray
    sweeps: FloatArray
    tools: FloatArray


class _OnTable:
    """The paths of folds whose grips stay above the table: wherever the garment lies, they are the same but moved."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._top = TableTop.of(context.scene.table)
        self._known: dict[tuple[int, Cover], tuple[_Flat, FloatArray]] = {}

    def of(self, fold: int, cover: Cover, offset: Point2) -> _Flat | None:
        """Return the paths after drags by an offset (m); None where a grip leaves the table on its way."""
        if (fold, cover) not in self._known:
            self._known[fold, cover] = self._undragged(fold, cover)
        (points, sweeps, tools), corners = self._known[fold, cover]
        if not self._top.covers(corners + offset):
            return None
        return _Flat(points + offset, sweeps, tools + np.array([*offset, 0.0]))

    def _undragged(self, fold: int, cover: Cover) -> tuple[_Flat, FloatArray]:
        """Return the paths over an endless table before any drag, and the corners of the rectangle that they cover."""
        context = self._context
        endless = TableTop((-math.inf, -math.inf), (math.inf, math.inf))
        path = _over(context, UNDRAGGED, fold, (endless, endless))
        points = context.placement.to_outer(np.array(cover))
        sweeps = path.sweeps(points)
        tools = path.tool_paths(points, sweeps)
        places = tools[..., :2].reshape(-1, 2)
        return _Flat(points, sweeps, tools), np.array([places.min(axis=0), places.max(axis=0)])


def grips_obstacle(context: Context, state: State, fold: int) -> Obstacle | None:
    """Return why empty hands cannot hold what a fold needs; None if they can.

    There may be too many grips, or grips too close to each other.
    """
    arms = len(context.reach.arm_names)
    covers = context.sequence.covers(fold, context.scene.support_angle_rad, arms)
    if not covers.is_holdable:
        return Obstacle(fold, Code.TOO_MANY_GRIPS, None, float(len(covers.vertices)), state)
    apart = max(nearest_pair_m(cover) for cover in context.allowed(covers))
    if apart < context.grips_apart_m - LENGTH_M:
        return Obstacle(fold, Code.GRIPS_TOO_CLOSE, None, context.grips_apart_m - apart, state)
    return None


def _path(context: Context, state: State, fold: int) -> FoldPath:
    top = TableTop.of(context.scene.table)
    if not state.is_dragged:
        return _over(context, state.offset, fold, (top, top))
    held = context.placed(state.offset).to_outer(np.array([h.point for h in state.held]))
    return _over(context, state.offset, fold, (top, top.open_towards(held)))


def _over(context: Context, offset: Point2, fold: int, tops: tuple[TableTop, TableTop]) -> FoldPath:
    """Return the path of a fold after drags by an offset (m), over the table's top and the one until the apex."""
    line, (_, depth_m) = _line(context, offset, fold), context.kept(depths)[fold]
    stacks = context.sequence.rests_of(fold)
    return FoldPath(line, depth_m, *tops, context.scene.edge_clear_m, context.placed(offset), stacks)


def _line(context: Context, offset: Point2, fold: int) -> Segment:
    """Return a fold's line after drags by an offset (m), table frame."""
    line = context.sequence.folds[fold].line
    ends = context.placed(offset).to_outer(np.array([line.start, line.end]))
    return Segment(point2(ends[0]), point2(ends[1]))


def _grips(context: Context, state: State, fold: int) -> Iterator[tuple[Cover, tuple[int, ...]]]:
    """Yield grips and their arms: those held that suffice, or the best new ones."""
    if state.held:
        yield from _held_grips(context, state, fold)
        return
    obstacle = grips_obstacle(context, state, fold)
    if obstacle is not None:
        context.obstacles.note(obstacle)
        return
    covers = context.sequence.covers(fold, context.scene.support_angle_rad, len(context.reach.arm_names))
    for cover in context.allowed(covers):
        points = context.placed(state.offset).to_outer(np.array(cover))
        if nearest_pair_m(cover) >= context.grips_apart_m - LENGTH_M:
            for arms in assignments(context, state.station, points):
                yield cover, arms


def _held_grips(context: Context, state: State, fold: int) -> Iterator[tuple[Cover, tuple[int, ...]]]:
    """Yield the sets of held grips that hold all that must be held."""
    covers = held_covers(context, fold, state.held)
    if not covers and not state.is_dragged:
        context.obstacles.note(Obstacle(fold, Code.RED_NEEDS_HOLD, None, 1.0, state))
    for cover in covers:
        yield tuple(h.point for h in cover), tuple(h.arm for h in cover)


def _approaches(context: Context, state: State, fold: int, grip: Point2, arm: int) -> NDArray[np.int64]:
    if state.held:
        return context.kept(all_approaches)[arm]
    turn = context.placement.yaw_rad - context.station_pose(state.station).yaw_rad
    done = (1 << fold) - 1 if context.kept(Surroundings).are_same(fold, grip) else state.done
    return approaches_from_outside(context, done, turn, grip, arm)


_BESIDE_M = 5e-3
"""The distance within which a part moved by another fold may change how a grip is approached (m)."""


class Surroundings:
    """For each grip of each fold, whether other folds change the cloth round it.

    Folds that must come before a fold are done whenever it is queried, and those that must come after it never are; all
    others may be done or not.
    """

    def __init__(self, context: Context) -> None:
        """Collect for each fold the folds that may be done or not; query no grip yet."""
        self._sequence = sequence = context.sequence
        self._known: dict[tuple[int, Point2], bool] = {}
        folds = range(len(sequence.folds))
        waits = nx.DiGraph(sequence.dag.edges)
        waits.add_nodes_from(folds)
        self._free = [set(folds) - nx.ancestors(waits, f) - nx.descendants(waits, f) - {f} for f in folds]

    def are_same(self, fold: int, grip: Point2) -> bool:
        """Return whether the cloth round a fold's grip, garment frame, is the same after all sets of other folds."""
        if (fold, grip) not in self._known:
            self._known[fold, grip] = not any(self._is_beside(other, grip) for other in self._free[fold])
        return self._known[fold, grip]

    def _is_beside(self, fold: int, point: Point2) -> bool:
        """Return whether a point is close to the part that a fold moves, or to where that part lands."""
        part, line = self._sequence.moving(fold), self._sequence.folds[fold].line
        return _is_near(part, point) or _is_near(part, Isometry.reflection(line).apply_point(point))


def _is_near(region: Region, point: Point2) -> bool:
    return region.contains(point) or region.boundary_distance(point) <= _BESIDE_M
