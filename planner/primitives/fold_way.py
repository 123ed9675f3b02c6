"""The ways to perform one fold from one station: grips, arms, paths, and the base's legs for each."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.cloth.grips import Cover, best_covers
from planner.folds.fold_path import FoldPath
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.segment import Segment
from planner.geometry.table_top import TableTop
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.base_legs import IMPOSSIBLE, travel
from planner.primitives.grasping import (
    GRIPS_APART_M,
    Strips,
    all_approaches,
    approaches_from_outside,
    arm_options,
    assignments,
    combined,
    nearest_pair_m,
)
from planner.primitives.obstacle import Code, Obstacle
from planner.primitives.state import Held, State
from planner.primitives.work import BACK_OFF_STEP_M, Work

_FEW = 4
"""So many approaches are tried first: mostly one of the best will do."""


@dataclass(frozen=True, eq=False)
class FoldWay:
    """One choice of grips and arms for a fold at one placement and station.

    Attributes:
        fold: the fold's index.
        grips: what is held, article frame (m).
        arms: the arm that holds each.
        path: the fold's path, table frame.
        points: the same grips in the table frame's unrolled plane, shape (grips, 2), m.
        sweeps: the waypoints.
        strips: back-offs for each combination of approaches.
        steps: least travel from the back-off at the first waypoint to that at the last, in grid steps.
        choice: the combination that needs so few.
    """

    fold: int
    grips: Cover
    arms: tuple[int, ...]
    path: FoldPath
    points: FloatArray
    sweeps: FloatArray
    strips: Strips
    steps: NDArray[np.int64]
    choice: NDArray[np.int64]

    @property
    def is_possible(self) -> bool:
        """Whether the base has any place to stand."""
        return bool((self.steps < IMPOSSIBLE).any())

    def ends(self, state: State) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """For each end back-off the least steps in all, and the back-off from which the path is begun.

        Free hands let the base drive to where the path begins; what is held keeps it where it is.
        """
        count = len(self.steps)
        if state.held:
            return self.steps[state.back_off], np.full(count, state.back_off)
        total = self.steps + np.abs(np.arange(count) - state.back_off)[:, None]
        return total.min(axis=0), total.argmin(axis=0)

    def straight_ends(self, state: State) -> list[int]:
        """The ends that cost no more than to drive straight to them."""
        steps, _ = self.ends(state)
        away = np.abs(np.arange(len(steps)) - state.back_off)
        return [int(end) for end in np.flatnonzero(steps == away)]


@dataclass(frozen=True, eq=False)
class _Trial:
    """Grips and arms that may do, before the robot is asked."""

    fold: int
    cover: Cover
    arms: tuple[int, ...]
    path: FoldPath
    points: FloatArray
    sweeps: FloatArray
    tools: FloatArray
    approaches: tuple[NDArray[np.int64], ...]

    def way(self, strips: Strips, back_offs: int) -> FoldWay:
        steps, choice = travel(strips.masks, back_offs)
        return FoldWay(self.fold, self.cover, self.arms, self.path, self.points, self.sweeps, strips, steps, choice)


class FoldWays:
    """Finds the ways to fold, and keeps them: many states of a search ask the same question."""

    def __init__(self, work: Work) -> None:
        self._work = work
        self._trials: dict[tuple[object, ...], tuple[_Trial, ...]] = {}
        self._found: dict[tuple[object, ...], tuple[FoldWay, ...]] = {}

    def to_every_end(self, state: State, fold: int) -> tuple[FoldWay, ...]:
        """All ways to perform a fold next, to whatever back-off."""
        return self._within(state, fold, (0, self._work.back_offs - 1), None)

    def to_unbeaten_ends(self, state: State, fold: int) -> tuple[FoldWay, ...]:
        """Ways to perform a fold, among them the quickest to each end that no other beats.

        An end is beaten if another end, and driving on from there, is as quick. To ask for all back-offs in all
        approaches is costly and mostly idle:

        1. If the base can stay where it is, that is all there is to know.
        2. The few best approaches mostly find an end, to either side, that costs no more than to drive straight to
           it. Whatever goes as far as that end could as well end there and drive on.
        3. So all approaches are asked only for the back-offs in between.
        """
        here, last = state.back_off, self._work.back_offs - 1
        staying = self._within(state, fold, (here, here), 1)
        if staying:
            return staying[:1]
        few = self._within(state, fold, (0, last), _FEW)
        straight = {end for way in few for end in way.straight_ends(state)}
        low = max((end + 1 for end in straight if end < here), default=0)
        high = min((end - 1 for end in straight if end > here), default=last)
        return few + self._within(state, fold, (low, high), None)

    def _within(self, state: State, fold: int, window: tuple[int, int], enough: int | None) -> tuple[FoldWay, ...]:
        """The ways that keep to a window of back-offs, with enough of the best approaches for each arm."""
        start = state.back_off if state.held else None
        key = (self._key(state, fold), window, enough, start)
        if key not in self._found:
            ways = (self._way(state, trial, window, enough) for trial in self._possible(state, fold))
            self._found[key] = tuple(way for way in ways if way is not None)
        return self._found[key]

    def _key(self, state: State, fold: int) -> tuple[object, ...]:
        _, x, y, station, _, held, is_dragged = state.key
        return (state.done, x, y, station, held, is_dragged, fold)

    def _possible(self, state: State, fold: int) -> tuple[_Trial, ...]:
        key = self._key(state, fold)
        if key not in self._trials:
            self._trials[key] = tuple(self._search(state, fold))
        return self._trials[key]

    def _search(self, state: State, fold: int) -> Iterator[_Trial]:
        obstacle = self._geometric_obstacle(state, fold)
        if obstacle is not None:
            self._work.obstacles.note(obstacle)
            return
        path = self._path(state, fold)
        for cover, arms in self._grips(state, fold):
            trial = self._trial(state, fold, path, cover, arms)
            if trial is not None:
                yield trial

    def _geometric_obstacle(self, state: State, fold: int) -> Obstacle | None:
        """What speaks against a fold before any arm is asked."""
        work, line = self._work, self._work.sequence.folds[fold].line
        label = work.sequence.folds[fold].label
        if not work.table_in_article(state.offset).region.overlaps_with(line):
            return Obstacle(fold, Code.LINE_OFF_TABLE, f"{label}: its line lies beyond the table's edge", 1.0)
        folded = work.sequence.folded(state.done, fold)
        behind = -float(line.left_distances(folded.moving.coordinates).min())
        if behind > LENGTH_M:
            message = f"{label}: the part that moves reaches {behind:.3f} m behind the line's extension"
            return Obstacle(fold, Code.NOT_A_G_STATE, message, behind)
        unrest = work.unrest(state.done | 1 << fold, state.offset)
        if unrest is not None:
            return Obstacle(fold, Code(unrest.code), f"{label}: afterwards {unrest.message}", 1.0)
        return None

    def _path(self, state: State, fold: int) -> FoldPath:
        work, line = self._work, self._work.sequence.folds[fold].line
        moving = work.sequence.folded(state.done, fold).moving
        depth = float(line.left_distances(moving.coordinates).max())
        ends = work.placed(state.offset).to_outer(np.array([line.start, line.end]))
        in_table = Segment(_plain(ends[0]), _plain(ends[1]))
        top = TableTop.of(work.scene.table)
        if not state.is_dragged:
            return FoldPath(in_table, depth, top, top)
        held = work.placed(state.offset).to_outer(np.array([h.point for h in state.held]))
        return FoldPath(in_table, depth, top, top.open_towards(held))

    def _grips(self, state: State, fold: int) -> Iterator[tuple[Cover, tuple[int, ...]]]:
        """Grips and their arms: those held that suffice, or the best new ones."""
        work = self._work
        arms = len(work.reach.arm_names)
        covers = work.sequence.covers(state.done, fold, work.scene.support_angle_rad, arms)
        label = work.sequence.folds[fold].label
        if state.held:
            yield from self._held_grips(state, fold)
            return
        if not covers.is_holdable:
            message = (
                f"{label}: {len(covers.vertices)} vertices must be held and {arms} grips do not cover them "
                f"with a grip radius of {work.sequence.folds[fold].grip_radius_m:g} m"
            )
            work.obstacles.note(Obstacle(fold, Code.TOO_MANY_GRIPS, message, float(len(covers.vertices))))
        for cover in covers.covers:
            points = work.placed(state.offset).to_outer(np.array(cover))
            if nearest_pair_m(points) < GRIPS_APART_M - LENGTH_M:
                apart = nearest_pair_m(points)
                message = f"{label}: its two grips are {apart:.3f} m apart, hands need {GRIPS_APART_M:g} m"
                work.obstacles.note(Obstacle(fold, Code.GRIPS_TOO_CLOSE, message, GRIPS_APART_M - apart))
                continue
            for order in assignments(work, state.station, points):
                yield cover, order

    def _held_grips(self, state: State, fold: int) -> Iterator[tuple[Cover, tuple[int, ...]]]:
        """The fewest of the grips held that hold all that must be held."""
        work, held = self._work, state.held
        covers = held_covers(work, state.done, fold, held)
        if not covers and not state.is_dragged:
            label = work.sequence.folds[fold].label
            message = f"{label}: the grips still held from the fold before do not hold all that must be held"
            work.obstacles.note(Obstacle(fold, Code.RED_NEEDS_HOLD, message, 1.0))
        for cover in covers:
            yield cover, tuple(next(h.arm for h in held if h.point == point) for point in cover)

    def _trial(self, state: State, fold: int, path: FoldPath, cover: Cover, arms: tuple[int, ...]) -> _Trial | None:
        work = self._work
        placement = work.placed(state.offset)
        points = placement.to_outer(np.array(cover))
        sweeps = path.sweeps(points)
        tools = path.tool_paths(points, sweeps)
        turn = placement.yaw_rad - work.station_pose(state.station).yaw_rad
        approaches = []
        for grip, arm, tool_path in zip(cover, arms, tools, strict=True):
            wanted = all_approaches(work) if state.held else approaches_from_outside(work, state.done, turn, grip)
            able = self._able(state.station, arm, tool_path, wanted)
            if not len(able):
                self._note_out_of_reach(state, fold, arm, tool_path)
                return None
            approaches.append(able)
        return _Trial(fold, cover, arms, path, points, sweeps, tools, tuple(approaches))

    def _able(self, station: int, arm: int, tools: FloatArray, approaches: NDArray[np.int64]) -> NDArray[np.int64]:
        """The approaches in which the path's two ends and its apex are in reach from somewhere."""
        work = self._work
        for extreme in work.in_base(station, tools[[len(tools) // 2, -1, 0]]):
            masks = work.reach.back_offs(arm, extreme[None], approaches, work.back_offs, BACK_OFF_STEP_M)
            approaches = approaches[masks[:, 0] > 0]
        return approaches

    def _way(self, state: State, trial: _Trial, window: tuple[int, int], enough: int | None) -> FoldWay | None:
        options = []
        start = state.back_off if state.held else None
        for arm, tools, approaches in zip(trial.arms, trial.tools, trial.approaches, strict=True):
            option = arm_options(self._work, state.station, arm, tools, approaches, window, enough, start)
            if not len(option.approaches):
                return None
            options.append(option)
        way = trial.way(combined(options), self._work.back_offs)
        return way if way.is_possible else None

    def _note_out_of_reach(self, state: State, fold: int, arm: int, tools: FloatArray) -> None:
        work = self._work
        station, _ = work.scene.stations[state.station]
        ahead = work.in_base(state.station, tools)
        apex = tools[len(tools) // 2]
        message = (
            f"{work.sequence.folds[fold].label}: from station {station} no back-off lets the "
            f"{work.reach.arm_names[arm]} arm follow its grip from ({tools[0][0]:.2f}, {tools[0][1]:.2f}) m over the "
            f"apex at ({apex[0]:.2f}, {apex[1]:.2f}) m, {apex[2]:.2f} m over the table"
        )
        severity = float(np.hypot(ahead[:, 1], tools[:, 2]).max() + np.clip(ahead[:, 0].max(), 0.0, None))
        work.obstacles.note(Obstacle(fold, Code.OUT_OF_REACH, message, severity))


def held_covers(work: Work, done: int, fold: int, held: tuple[Held, ...]) -> tuple[Cover, ...]:
    """The smallest sets of grips already held that hold all that a fold needs; empty if none does."""
    arms = len(work.reach.arm_names)
    vertices = work.sequence.covers(done, fold, work.scene.support_angle_rad, arms).vertices
    points: list[Point2] = [h.point for h in held]
    radius = work.sequence.folds[fold].grip_radius_m
    return best_covers(np.array(points), np.array(vertices), radius, len(held))


def _plain(row: FloatArray) -> Point2:
    return (float(row[0]), float(row[1]))
