"""The cheapest way by trying everything: obviously right rather than quick, and independent of `planner.search`.

What a fold or a drag must hold, which arm may take it and along which path is asked of the planner; whether the cloth
stays where it is, too. What makes the planner quick is left out: every approach of every arm is combined with every
other, the base may stand at every waypoint wherever the hands allow, every standoff is an end, hands may hold on after
every drag, and no state is ever passed over.
"""

import heapq
import math
from collections.abc import Iterator
from itertools import count

import numpy as np
from numpy.typing import NDArray

from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray
from planner.geometry.reach_query import ReachQuery
from planner.primitives.base_move import BaseMove
from planner.primitives.context import Context
from planner.primitives.drag_way import drag_covers, dragged, hangs_ahead, longest_drag, towards_robot
from planner.primitives.fold_obstacles import geometric_obstacle
from planner.primitives.fold_trial import FoldTrial, fold_trials
from planner.primitives.grasping import approaches_from_outside, assignments, nearest_pair_m
from planner.primitives.state import Held, State

Way = tuple[float, State]


class Exhaustive:
    """A search through everything that a robot may do in one planning problem."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._moves = BaseMove(context)
        self._masks: dict[tuple[object, ...], NDArray[np.uint32]] = {}
        self._strips: dict[tuple[object, ...], list[tuple[int, ...]]] = {}

    def cost_s(self, start: State) -> float:
        """Return the least time until every fold is done (s), by Dijkstra's algorithm; infinite if impossible."""
        everything = (1 << len(self._context.sequence.folds)) - 1
        if self._context.stability_violation(start.done, start.offset) is not None:
            return math.inf
        numbers, left = count(), set()
        queue = [(0.0, next(numbers), start)]
        while queue:
            cost, _, state = heapq.heappop(queue)
            if state.done == everything:
                return cost
            if state not in left:
                left.add(state)
                for seconds, after in (*self._folds(state), *self._drags(state), *self._drives(state)):
                    heapq.heappush(queue, (cost + seconds, next(numbers), after))
        return math.inf

    def _drives(self, state: State) -> Iterator[Way]:
        for step in self._moves.successors(state):
            yield step.duration_s, step.after

    def _folds(self, state: State) -> Iterator[Way]:
        context = self._context
        for fold in context.sequence.dag.available(state.done):
            if geometric_obstacle(context, state, fold) is not None:
                continue
            for trial in fold_trials(context, state, fold):
                held = self._held_after(trial) if context.sequence.dag.follows_at_once(fold) else ()
                motions = 2 if state.held else 3
                for strip in self._strips_of(state, trial):
                    for end, steps in enumerate(self._travel(strip, state)):
                        if math.isfinite(steps):
                            after = State(state.done | 1 << fold, state.offset, state.station, end, held)
                            yield motions * context.scene.arm_motion_s + context.drive_s(steps), after

    def _held_after(self, trial: FoldTrial) -> tuple[Held, ...]:
        over = Isometry.reflection(self._context.sequence.folds[trial.fold].line)
        pairs = sorted(zip(trial.arms, trial.cover, strict=True))
        return tuple(Held(arm, over.apply_point(grip)) for arm, grip in pairs)

    def _strips_of(self, state: State, trial: FoldTrial) -> list[tuple[int, ...]]:
        """Return for each combination of approaches the standoffs that suit all hands at each waypoint, as bits."""
        key = (state.done, state.offset, state.station, state.held, trial.fold, trial.cover, trial.arms)
        if key not in self._strips:
            whole = np.full((1, len(trial.sweeps)), (1 << self._context.standoffs) - 1, dtype=np.uint32)
            for arm, tools, approaches in zip(trial.arms, trial.tools, trial.approaches, strict=True):
                rows = np.array([self._able(state.station, arm, tool, approaches) for tool in tools]).T
                both = whole[:, None, :] & rows[None, :, :]
                whole = np.unique(both[both.all(axis=2)], axis=0)
            self._strips[key] = [tuple(int(mask) for mask in row) for row in whole]
        return self._strips[key]

    def _able(self, station: int, arm: int, tool: FloatArray, approaches: NDArray[np.int64]) -> NDArray[np.uint32]:
        """Return for each approach the standoffs from which one tool point is within the comfort radius, as bits."""
        key = (station, arm, tool.tobytes(), approaches.tobytes())
        if key not in self._masks:
            context = self._context
            point = context.in_base(station, tool[None])
            self._masks[key] = context.reach.standoffs(ReachQuery(arm, point, approaches, context.standoffs))[:, 0]
        return self._masks[key]

    def _travel(self, strip: tuple[int, ...], state: State) -> list[float]:
        """Return the fewest steps of the base until it stands at each standoff at the end of a path."""
        stands = range(self._context.standoffs)
        if state.held:
            steps = [0.0 if stand == state.standoff else math.inf for stand in stands]
        else:
            steps = [float(abs(stand - state.standoff)) for stand in stands]
        for mask in strip:
            steps = [s if mask >> stand & 1 else math.inf for stand, s in enumerate(steps)]
            for _ in stands:
                beside = [min(steps[max(j - 1, 0)], steps[min(j + 1, len(steps) - 1)]) + 1.0 for j in stands]
                steps = [
                    min(s, b) if mask >> j & 1 else math.inf for j, (s, b) in enumerate(zip(steps, beside, strict=True))
                ]
        return steps

    def _drags(self, state: State) -> Iterator[Way]:
        context = self._context
        towards = towards_robot(context, state.station)
        if state.held or hangs_ahead(context, state.done, state.offset, towards):
            return
        placement = context.placed(state.offset)
        turn = placement.yaw_rad - context.station_pose(state.station).yaw_rad
        for cover in context.allowed(drag_covers(context, state.done, state.offset, towards)):
            points = placement.to_outer(np.array(cover).reshape(-1, 2))
            if not cover or nearest_pair_m(points) < context.grips_apart_m - 1e-5:
                continue
            picks = np.column_stack([points, np.full(len(points), REST_HEIGHT_M)])
            for arms in assignments(context, state.station, points):
                hands_at = zip(cover, arms, strict=True)
                allowed = [approaches_from_outside(context, state.done, turn, grip, arm) for grip, arm in hands_at]
                hands = zip(arms, picks, allowed, strict=True)
                able = [self._able(state.station, *hand) for hand in hands]
                held = tuple(Held(arm, grip) for arm, grip in sorted(zip(arms, cover, strict=True)))
                for stand in range(context.standoffs):
                    if all(any(int(mask) >> stand & 1 for mask in masks) for masks in able):
                        yield from self._carried(state, stand, held)

    def _carried(self, state: State, stand: int, held: tuple[Held, ...]) -> Iterator[Way]:
        """Return the drags of every length that begin at a standoff, with hands that hold on or let go."""
        context = self._context
        for tenths in range(1, longest_drag(context) + 1):
            end, offset = stand + 2 * tenths, dragged(context, state.offset, state.station, tenths)
            if end < context.standoffs and context.stability_violation(state.done, offset) is None:
                driven_s = context.drive_s(abs(stand - state.standoff)) + context.drag_s(end - stand)
                seconds = context.scene.arm_motion_s + driven_s
                yield seconds, State(state.done, offset, state.station, end)
                yield seconds, State(state.done, offset, state.station, end, held, dragged=1)
