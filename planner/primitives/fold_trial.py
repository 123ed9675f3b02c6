"""Candidates for performing a fold, before the robot is queried: grips, arms, the path of the tools."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from planner.cloth.grips import Cover
from planner.folds.fold_path import FoldPath
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.segment import Segment
from planner.geometry.table_top import TableTop
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.context import STANDOFF_STEP_M, Context
from planner.primitives.fold_obstacles import Depths
from planner.primitives.grasping import (
    all_approaches,
    approaches_from_outside,
    assignments,
    hand_key,
    nearest_pair_m,
)
from planner.primitives.held_covers import held_covers
from planner.primitives.obstacle import Obstacle
from planner.primitives.reach import Following
from planner.primitives.state import State
from planner.primitives.surroundings import Surroundings
from planner.task.reason import Code


@dataclass(frozen=True, eq=False)
class FoldTrial:
    """Grips and arms that may perform a fold.

    Attributes:
        fold: the fold's index.
        cover: the points held, article frame (m).
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
        return (self.arms, np.round(self.tools / LENGTH_M).tobytes(), *(a.tobytes() for a in self.approaches))

    @cached_property
    def taken(self) -> dict[int, Point2]:
        """The point that each arm holds, article frame (m)."""
        return dict(zip(self.arms, self.cover, strict=True))

    def is_like(self, other: "FoldTrial") -> bool:
        """Return whether the same arms take the same grips, possibly elsewhere on the table."""
        return (self.cover, self.arms) == (other.cover, other.arms)

    def in_order(self, hands: list[int]) -> "FoldTrial":
        """Return the trial with its hands in another order."""
        return replace(
            self,
            cover=tuple(self.cover[hand] for hand in hands),
            arms=tuple(self.arms[hand] for hand in hands),
            points=self.points[hands],
            tools=self.tools[hands],
            approaches=tuple(self.approaches[hand] for hand in hands),
        )

    def in_base(self, context: Context, station: int) -> FloatArray:
        """Return the tool paths in the base frame at standoff 0, shape (grips, waypoints, 3), m."""
        return context.in_base(station, self.tools)

    def following(self, context: Context, station: int) -> Following:
        """Return the query about hands that follow the tool paths from a station."""
        return context.reach.following(self.arms, self.in_base(context, station), self.approaches, STANDOFF_STEP_M)


def fold_trials(context: Context, state: State, fold: int) -> list[FoldTrial]:
    """Return the grips and arms that may perform a fold in a state, with the grips held or with empty hands.

    The order of the trials and of their hands depends on where things are and not on how they were drawn; a mirror
    image of the task has the same order.
    """
    keyed = [(trial, _hand_keys(context, state, trial)) for trial in _trials(context, state, fold)]
    return [trial for trial, _ in sorted(keyed, key=lambda pair: pair[1])]


def _hand_keys(context: Context, state: State, trial: FoldTrial) -> list[tuple[int, ...]]:
    hands = zip(trial.arms, trial.tools, strict=True)
    return [hand_key(context, state.station, arm, tools) for arm, tools in hands]


def _trials(context: Context, state: State, fold: int) -> Iterator[FoldTrial]:
    path = _path(context, state, fold)
    for cover, arms in _grips(context, state, fold):
        points = context.placed(state.offset).to_outer(np.array(cover))
        if not path.is_continuous(points):
            continue
        sweeps = path.sweeps(points)
        tools = path.tool_paths(points, sweeps)
        approaches = tuple(_approaches(context, state, fold, *hand) for hand in zip(cover, arms, strict=True))
        trial = FoldTrial(fold, cover, arms, path, points, sweeps, tools, approaches)
        keys = _hand_keys(context, state, trial)
        yield trial.in_order(sorted(range(len(arms)), key=lambda hand: (keys[hand], arms[hand])))


def grips_obstacle(context: Context, state: State, fold: int) -> Obstacle | None:
    """Return why empty hands cannot hold what a fold needs; None if they can.

    There may be too many grips, or grips too close to each other.
    """
    arms = len(context.reach.arm_names)
    covers = context.sequence.covers(fold, context.scene.support_angle_rad, arms)
    if not covers.is_holdable:
        return Obstacle(fold, Code.TOO_MANY_GRIPS, None, float(len(covers.vertices)), state)
    apart = max(nearest_pair_m(np.array(cover)) for cover in covers.covers)
    if apart < context.grips_apart_m - LENGTH_M:
        return Obstacle(fold, Code.GRIPS_TOO_CLOSE, None, context.grips_apart_m - apart, state)
    return None


def _path(context: Context, state: State, fold: int) -> FoldPath:
    line = context.sequence.folds[fold].line
    _, depth = context.kept(Depths).of(fold)
    ends = context.placed(state.offset).to_outer(np.array([line.start, line.end]))
    in_table = Segment(_plain(ends[0]), _plain(ends[1]))
    top = TableTop.of(context.scene.table)
    if not state.is_dragged:
        return FoldPath(in_table, depth, top, top, context.scene.edge_clear_m)
    held = context.placed(state.offset).to_outer(np.array([h.point for h in state.held]))
    return FoldPath(in_table, depth, top, top.open_towards(held), context.scene.edge_clear_m)


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
    for cover in covers.covers:
        points = context.placed(state.offset).to_outer(np.array(cover))
        if nearest_pair_m(points) >= context.grips_apart_m - LENGTH_M:
            for arms in assignments(context, state.station, points):
                yield cover, arms


def _held_grips(context: Context, state: State, fold: int) -> Iterator[tuple[Cover, tuple[int, ...]]]:
    """Yield the smallest sets of held grips that hold all that must be held."""
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


def _plain(row: FloatArray) -> Point2:
    return (float(row[0]), float(row[1]))
