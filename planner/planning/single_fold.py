"""Single-fold relaxation: decide whether a fold can be done at all, wherever the garment lies and the robot stands.

To prove that no plan exists, A* must exhaust its states, and there are many: every placement that drags can bring
about, every standoff, every hold. But usually one fold is to blame, and it can be checked by itself with everything
else relaxed: the garment lies wherever drags could carry it, the robot stands at any station and standoff, and it holds
whatever a drag could have left it with. If the fold cannot be done even then, no plan exists.

Most of these cases do not differ in anything that matters. A drag or a standoff along the base's x axis only shifts a
path along that axis. So all cases with the same lateral place and height share one query for each of the path's apex,
end and start: can the point be reached from anywhere along that line? The few cases that survive are checked in full.
The relaxation drops constraints and adds none, so it never denies what can be done.
"""

from dataclasses import dataclass
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import STANDOFF_STEP_M
from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.geometry.reach_query import ReachQuery
from planner.geometry.tolerance import LENGTH_M, grid_key, grid_keys
from planner.planning.budget import Budget
from planner.planning.single_fold_cases import Case, Cases
from planner.primitives.context import Context
from planner.primitives.drag_way import drag_offsets, dragged, longest_drag
from planner.primitives.fold_obstacles import geometric_obstacle, geometric_obstacles
from planner.primitives.fold_trial import FoldTrial, fold_trials
from planner.primitives.fold_way import attempt_of, can_follow
from planner.primitives.state import UNDRAGGED, State

_SETS_MAX = 64
"""Sets of folds that may precede a fold; a fold with more sets is left to the search."""

OFFSETS_MAX = 2000
"""Placements that drags can lead to; where there are more, the search decides."""

_BITS = 32
"""Standoffs in one reach query."""

_GUESSES, _GUESSED_DRAGS = 2, 6
"""Cases, and drags in each, that are tried first, before all cases are checked."""

_EXTREMES = (1.0, 2.0, 0.0)
"""The sweeps of a fold's path that fail first: the apex, the end, the start."""


@dataclass(frozen=True, slots=True)
class _ReachKey:
    """The key of a reach query: a tool point of a fold's path, with all that decides whether it is in reach."""

    done: int
    is_held_out: bool
    station: int
    arm: int
    sweep: float
    point: tuple[int, ...]


class SingleFold:
    """Decides for each fold of a planning problem whether it could be done alone."""

    def __init__(self, context: Context, station: int, budget: Budget) -> None:
        """Prepare the check of folds begun at a station; once the budget is over, folds count as possible."""
        self._budget = budget
        self._context = context
        self._station = station
        self._offsets = drag_offsets(context, OFFSETS_MAX)
        self._places = self._offsets
        self._cases = Cases(context, station, self._offsets, budget)
        self._answers: dict[_ReachKey, BoolArray] = {}

    def is_impossible(self, fold: int) -> bool:
        """Return whether a fold can never be done; if so, leave what stopped it as its only obstacles."""
        context = self._context
        sets = context.sequence.dag.sets_before(fold, _SETS_MAX)
        if sets is None or len(self._offsets) > OFFSETS_MAX or context.sequence.folds[fold].is_red:
            return False
        before = context.obstacles.taken_away(fold)
        guesses = (case for done in sets for case in islice(self._cases.of(done, fold), _GUESSES))
        if any(self._is_possible_nearby(case, fold) for case in guesses):
            context.obstacles.put_back(before)
            return False
        context.obstacles.taken_away(fold)
        self._places = self._with_line_on_table(fold)
        self._answers.clear()
        if not len(self._places):
            self._note_lines_off(fold, sets)
            context.obstacles.put_back(before)
            return True
        is_impossible = not any(self._is_possible_after(done, fold) for done in sets) and not self._budget.is_over
        context.obstacles.put_back(before)
        return is_impossible

    def _is_possible_after(self, done: int, fold: int) -> bool:
        return any(
            self._is_possible(case, fold, station)
            for case in self._cases.of(done, fold)
            for station in (range(len(self._context.scene.stations)) if case.station is None else (case.station,))
        )

    def _is_possible_nearby(self, case: Case, fold: int) -> bool:
        """Return whether a fold can be done from the station of the start where a few drags may bring the garment.

        A quick check before all cases are checked.
        """
        steps = min(longest_drag(self._context), _GUESSED_DRAGS)
        places = [dragged(self._context, UNDRAGGED, self._station, count) for count in range(steps + 1)]
        station = self._station if case.station is None else case.station
        states = [case.state(station, np.array(place)) for place in places]
        return any(
            self._can_follow(state, fold, trial)
            for state in states
            for trial in fold_trials(self._context, state, fold)
        )

    def _with_line_on_table(self, fold: int) -> FloatArray:
        line = self._context.sequence.folds[fold].line
        moves = Pose2(0.0, 0.0, self._context.placement.yaw_rad).to_inner(self._offsets)
        lines = np.array([line.start, line.end]) + moves[:, None]
        return np.asarray(self._offsets[self._context.table_in_garment(UNDRAGGED).region.touches(lines)])

    def _note_lines_off(self, fold: int, sets: tuple[int, ...]) -> None:
        """Note the place at which a fold line that is never on the table is nearest to it."""
        context = self._context
        line = context.sequence.folds[fold].line
        offsets = [(float(x), float(y)) for x, y in self._offsets]
        nearest = min(offsets, key=lambda offset: context.table_in_garment(offset).region.distance_to(line))
        for done in sets:
            for obstacle in geometric_obstacles(context, State(done, nearest, self._station, 0), fold):
                context.obstacles.note(obstacle)

    def _is_possible(self, case: Case, fold: int, station: int) -> bool:
        anywhere = case.state(station, np.zeros(2))
        for trial in fold_trials(self._context, anywhere, fold):
            stages = self._stages(case, trial, station)
            for index in np.flatnonzero(stages == len(_EXTREMES)):
                if self._budget.is_over:
                    return True
                state = case.state(station, self._places[index])
                here = (t for t in fold_trials(self._context, state, fold) if t.is_like(trial))
                if any(self._can_follow(state, fold, same) for same in here):
                    return True
            self._context.obstacles.note_attempt(attempt_of(anywhere, trial, self._places))
        return False

    def _stages(self, case: Case, trial: FoldTrial, station: int) -> NDArray[np.int64]:
        """Return how many of apex, end and start can be reached, one after the other, at each place."""
        unrolled = trial.path.tools_unrolled(trial.points, np.array(_EXTREMES))
        stages = np.zeros(len(self._places), dtype=np.int64)
        alive = [np.ones((len(a), len(self._places)), dtype=bool) for a in trial.approaches]
        left = np.arange(len(self._places))
        for sweep, points in zip(_EXTREMES, unrolled, strict=True):
            for grip, arm in enumerate(trial.arms):
                if self._budget.is_over:
                    return stages
                rows = np.flatnonzero(alive[grip][:, left].any(axis=1))
                key = _ReachKey(case.done, bool(case.held) and sweep < 1.0, station, arm, sweep, _key(points[grip]))
                found = self._found(key, trial, points[grip], trial.approaches[grip][rows], left)
                alive[grip][np.ix_(rows, left)] &= found
                left = left[alive[grip][:, left].any(axis=0)]
                if not len(left):
                    return stages
            stages[left] += 1
        return stages

    def _found(
        self,
        key: _ReachKey,
        trial: FoldTrial,
        point: FloatArray,
        approaches: NDArray[np.int64],
        places: NDArray[np.int64],
    ) -> BoolArray:
        """Return with which approaches one unrolled tool point can be reached at which places, shape (k, n).

        Many trials share a point, so the answers are kept.
        """
        if key not in self._answers:
            shape = (2, len(self._context.reach.approaches), len(self._places))
            self._answers[key] = np.zeros(shape, dtype=bool)
        is_known, is_found = self._answers[key]
        missing = ~is_known[np.ix_(approaches, places)]
        if missing.any():
            block = np.ix_(approaches[missing.any(axis=1)], places[missing.any(axis=0)])
            raised = point + np.column_stack([self._places[block[1][0]], np.zeros(block[1].size)])
            tools = raised if key.is_held_out else trial.path.over_edge(raised, trial.path.top)
            is_found[block] = self._from_anywhere(key.station, key.arm, tools, block[0][:, 0])
            is_known[block] = True
        return np.asarray(is_found[np.ix_(approaches, places)])

    def _from_anywhere(self, station: int, arm: int, tools: FloatArray, approaches: NDArray[np.int64]) -> BoolArray:
        """Return with which approaches points can be reached from somewhere along the base's x axis, shape (k, n).

        Points must be within the comfort radius.
        """
        context = self._context
        points = context.in_base(station, tools)
        steps = np.floor(points[:, 0] / STANDOFF_STEP_M + LENGTH_M)
        phases = np.column_stack([points[:, 0] - steps * STANDOFF_STEP_M, points[:, 1:]])
        _, first, group = np.unique(grid_keys(phases), axis=0, return_index=True, return_inverse=True)
        lowest, highest = int(steps.min()), int(steps.max()) + context.standoffs
        found = np.zeros((len(approaches), len(first)), dtype=bool)
        for start in range(lowest, highest, _BITS):
            if self._budget.is_over:
                break
            lines = phases[first] + np.array([start * STANDOFF_STEP_M, 0.0, 0.0])
            count = min(_BITS, highest - start)
            found |= context.reach.from_anywhere(ReachQuery(arm, lines, approaches, count))
        return found[:, group.ravel()]

    def _can_follow(self, state: State, fold: int, trial: FoldTrial) -> bool:
        """Return whether a fold has no obstacle in a state and its whole path can be followed."""
        context = self._context
        obstacle = geometric_obstacle(context, state, fold)
        if obstacle is not None:
            context.obstacles.note(obstacle)
            return False
        return can_follow(context, state.station, trial)


def _key(point: FloatArray) -> tuple[int, ...]:
    return tuple(grid_key(float(c)) for c in point)
