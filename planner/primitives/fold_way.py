"""The ways to perform one fold from one station: what could be tried, and the base's legs for each.

Many states of a search ask the same question, so answers are kept.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.primitives.base_legs import IMPOSSIBLE, travel
from planner.primitives.fold_trial import FoldTrial, fold_trials, geometric_obstacle
from planner.primitives.grasping import Strips, arm_options, combined
from planner.primitives.obstacle import Attempt, Code, Obstacle
from planner.primitives.state import State
from planner.primitives.work import BACK_OFF_STEP_M, Work

AHEAD_M = 0.7
"""About as far ahead of its shoulder a hand works on a table (m)."""

_FEW = 6
"""So many approaches are tried first: mostly one of the best will do."""


@dataclass(frozen=True, eq=False)
class FoldWay:
    """One choice of grips and arms for a fold at one placement and station that the robot can follow.

    Attributes:
        trial: the grips, the arms, the path.
        strips: back-offs for each combination of approaches.
        steps: least travel from the back-off at the first waypoint to that at the last, in grid steps.
        choice: the combination that needs so few.
    """

    trial: FoldTrial
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


class FoldWays:
    """Finds the ways to fold, and keeps them: many states of a search ask the same question."""

    def __init__(self, work: Work) -> None:
        self._work = work
        self._trials: dict[tuple[object, ...], tuple[FoldTrial, ...]] = {}
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
        if state.held and self._is_hopeless(state, fold):
            return ()
        staying = self._within(state, fold, (here, here), 1)
        if staying:
            return staying[:1]
        few = self._few(state, fold)
        straight = {end for way in few for end in way.straight_ends(state)}
        low = max((end + 1 for end in straight if end < here), default=0)
        high = min((end - 1 for end in straight if end > here), default=last)
        found = few + self._within(state, fold, (low, high), None)
        if not found:
            self._note_all_out_of_reach(state, fold)
        return found

    def _few(self, state: State, fold: int) -> tuple[FoldWay, ...]:
        """The ways in a few of the best approaches, begun wherever the base stands best."""
        return self._within(state, fold, (0, self._work.back_offs - 1), _FEW, is_from_anywhere=True)

    def _is_hopeless(self, state: State, fold: int) -> bool:
        """Whether one hand alone cannot follow the path wherever the base stands: that holds for all back-offs."""
        is_for_one_hand = all(len(trial.arms) == 1 for trial in self._possible(state, fold))
        if not is_for_one_hand or self._few(state, fold):
            return False
        self._note_all_out_of_reach(state, fold)
        return True

    def _note_all_out_of_reach(self, state: State, fold: int) -> None:
        for trial in self._possible(state, fold):
            self._note_out_of_reach(state, trial)

    def _within(
        self,
        state: State,
        fold: int,
        window: tuple[int, int],
        enough: int | None,
        *,
        is_from_anywhere: bool = False,
    ) -> tuple[FoldWay, ...]:
        """The ways that keep to a window of back-offs, with enough of the best approaches for each arm.

        With grips held they begin where the base stands; asked from anywhere, one answer serves every back-off.
        """
        start = state.back_off if state.held and not is_from_anywhere else None
        key = (self._key(state, fold), window, enough, start)
        if key not in self._found:
            trials = self._possible(state, fold)
            ways = (follow(self._work, state.station, trial, window, enough, start) for trial in trials)
            self._found[key] = tuple(way for way in ways if way is not None)
        return self._found[key]

    def _key(self, state: State, fold: int) -> tuple[object, ...]:
        _, x, y, station, _, held, is_dragged = state.key
        return (state.done, x, y, station, held, is_dragged, fold)

    def _possible(self, state: State, fold: int) -> tuple[FoldTrial, ...]:
        key = self._key(state, fold)
        if key not in self._trials:
            self._trials[key] = tuple(self._search(state, fold))
        return self._trials[key]

    def _search(self, state: State, fold: int) -> Iterator[FoldTrial]:
        obstacle = geometric_obstacle(self._work, state, fold)
        if obstacle is not None:
            self._work.obstacles.note(obstacle)
            return
        for trial in fold_trials(self._work, state, fold):
            able = self._able(state, trial)
            if able is None:
                self._note_out_of_reach(state, trial)
            else:
                yield able

    def _able(self, state: State, trial: FoldTrial) -> FoldTrial | None:
        """The trial with those approaches in which apex and both ends are in reach from somewhere."""
        work = self._work
        approaches = []
        for arm, tools, wanted in zip(trial.arms, trial.tools, trial.approaches, strict=True):
            able = wanted
            for extreme in work.in_base(state.station, tools[[len(tools) // 2, -1, 0]]):
                masks = work.reach.back_offs(arm, extreme[None], able, work.back_offs, BACK_OFF_STEP_M)
                able = able[masks[:, 0] > 0]
            if not len(able):
                return None
            approaches.append(able)
        return replace(trial, approaches=tuple(approaches))

    def _note_out_of_reach(self, state: State, trial: FoldTrial) -> None:
        """Remember what was tried, and roughly how far out of the arms' way it is."""
        work = self._work
        away = away_from_shoulders(work, state.station, trial.arms, trial.tools)
        attempt = Attempt(state.station, state.offset, trial.arms, trial.tools, trial.approaches)
        work.obstacles.note(Obstacle(trial.fold, Code.OUT_OF_REACH, "", float(away), attempt))


def away_from_shoulders(work: Work, station: int, arms: tuple[int, ...], tools: FloatArray) -> FloatArray:
    """How far the hands must go from their shoulders at most (m), sideways, up or down, and too far ahead.

    The base can back off but not go nearer, so what lies ahead counts as far as it is beyond `AHEAD_M`. Only for
    comparing what could not be reached.

    Args:
        work: the problem.
        station: where the robot stands.
        arms: the arm of each grip.
        tools: each grip's tool points in the table frame, shape (grips, n, ..., 3), m.

    Returns:
        The largest distance over grips and points, shape (...).
    """
    found = []
    for arm, points in zip(arms, tools, strict=True):
        away = work.in_base(station, points) - np.array(work.reach.shoulders[arm])
        away[..., 0] = np.maximum(away[..., 0] - AHEAD_M, 0.0)
        found.append(np.sqrt((away**2).sum(axis=-1)).max(axis=0))
    return np.asarray(np.max(found, axis=0))


def follow(
    work: Work,
    station: int,
    trial: FoldTrial,
    window: tuple[int, int],
    enough: int | None = None,
    start: int | None = None,
) -> FoldWay | None:
    """The way to perform a trial within a window of back-offs; None if the arms cannot follow its path.

    Args:
        work: the problem.
        station: where the robot stands.
        trial: grips, arms and path.
        window: the first and last back-off allowed.
        enough: how many approaches of each arm are enough; None: all are wanted.
        start: the back-off at which what is held is held; None: the hands are free.
    """
    options = []
    for arm, tools, approaches in zip(trial.arms, trial.tools, trial.approaches, strict=True):
        option = arm_options(work, station, arm, tools, approaches, window, enough, start)
        if not len(option.approaches):
            return None
        options.append(option)
    strips = combined(options)
    way = FoldWay(trial, strips, *travel(strips.masks, work.back_offs))
    return way if way.is_possible else None
