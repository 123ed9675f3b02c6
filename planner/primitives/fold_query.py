"""Find where the base may stand while one fold is performed, as lazily as the search allows.

Testing every approach of every hand at every standoff takes tens of thousands of reach queries for one fold. The search
needs the cheapest final standoffs first, rarely asks for the others, and mostly the base need not drive at all. So the
query covers no driving first, then the least driving possible, and more only when nothing cheaper is left.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE, Driving
from planner.geometry.pose import Point2
from planner.geometry.tolerance import grid_key
from planner.primitives.base_legs import unbeaten
from planner.primitives.context import Context
from planner.primitives.fold_obstacles import geometric_obstacle, is_line_on_table
from planner.primitives.fold_trial import FoldTrial, Surroundings, fold_trials, grips_obstacle
from planner.primitives.fold_way import FoldWay, attempt_of
from planner.primitives.grasping import all_approaches
from planner.primitives.state import State


@dataclass(frozen=True, eq=False, slots=True)
class End:
    """A standoff at which the base may stand after a fold.

    Attributes:
        standoff: in grid steps (see `State`).
        steps: the least steps of driving in all.
        first: the standoff of the base when the hands begin, for that many steps.
        way: the way to fold with that many steps.
    """

    standoff: int
    steps: int
    first: int
    way: FoldWay


class FoldQuery:
    """The query about a fold from a station, with the garment in a place and with given grips held."""

    def __init__(self, context: Context, state: State, fold: int) -> None:
        """Collect the trials for a state, whatever its standoff, and note what rules the fold out."""
        self._context = context
        self._state = state
        self._trials = tuple(self._search(fold))
        self._hands = tuple(trial.following(context, state.station) for trial in self._trials)
        self._least = np.zeros(context.standoffs, dtype=np.int64)
        self._is_noted = False

    def _search(self, fold: int) -> Iterator[FoldTrial]:
        obstacle = geometric_obstacle(self._context, self._state, fold)
        if obstacle is None:
            yield from fold_trials(self._context, self._state, fold)
        else:
            self._context.obstacles.note(obstacle)

    def ends(self, begun: NDArray[np.int64], least: int, most: int) -> tuple[list[End], int]:
        """Return the ends that take `least` to `most` steps and that driving on does not reach as cheaply.

        Args:
            begun: for each standoff, the steps after which the base can be there when the hands begin.
            least: the fewest steps of an end.
            most: the most steps of an end.

        Returns:
            The ends, and the least steps that further ends may take; `IMPOSSIBLE` if there are none.
        """
        at_least = min(int((begun + self._least).min()), IMPOSSIBLE)
        if at_least > most:
            return [], at_least
        found = [hands(begun, most) for hands in self._hands]
        ends = [end for number, driving in enumerate(found) for end in self._ends(number, driving)]
        kept = [end for i, end in enumerate(ends) if not any(_beats(other, end, j < i) for j, other in enumerate(ends))]
        more = min((driving.more for driving in found), default=IMPOSSIBLE)
        if not ends and more == IMPOSSIBLE:
            self._note_out_of_reach()
        self._learn(begun, min((end.steps for end in ends), default=more))
        return [end for end in kept if end.steps >= least], more

    def _learn(self, begun: NDArray[np.int64], steps: int) -> None:
        """Raise the lower bound on the steps from each standoff to `steps`, less the steps to get there."""
        beyond = IMPOSSIBLE if steps == IMPOSSIBLE else steps - begun
        np.maximum(self._least, beyond, out=self._least, where=begun < IMPOSSIBLE)

    def every_end(self, begun: NDArray[np.int64]) -> list[End]:
        """Return all ends, for each choice of grips and arms; `begun` is as for `ends`."""
        found = (hands(begun, wanted="every") for hands in self._hands)
        ends = [end for number, driving in enumerate(found) for end in self._ends(number, driving)]
        if not ends:
            self._note_out_of_reach()
        return ends

    def ends_before_moves(self, begun: NDArray[np.int64], onward: NDArray[np.int64]) -> list[End]:
        """Return the ends that only a move can make worth their steps: driving on reaches them as cheaply.

        Args:
            begun: as for `ends`.
            onward: by how many steps one end must come before another to make it useless before a move, see
                `MoveTimes.onward`.
        """
        if int((begun + self._least).min()) >= IMPOSSIBLE:
            return []
        best: dict[int, End] = {}
        for end in self.every_end(begun):
            if end.standoff not in best or end.steps < best[end.standoff].steps:
                best[end.standoff] = end
        steps = np.full(self._context.standoffs, IMPOSSIBLE)
        steps[list(best)] = [end.steps for end in best.values()]
        return [best[standoff] for standoff in sorted({*unbeaten(steps, onward)} - {*unbeaten(steps)})]

    def _ends(self, number: int, driving: Driving) -> Iterator[End]:
        trial = self._trials[number]
        for end in driving.ends:
            way = FoldWay(trial, driving.approaches(end, trial.approaches))
            yield End(end, int(driving.steps[end]), int(driving.first[end]), way)

    def _note_out_of_reach(self) -> None:
        """Note once that the arms cannot follow."""
        if not self._is_noted:
            self._is_noted = True
            for trial in self._trials:
                self._context.obstacles.note_attempt(attempt_of(self._state, trial, np.array([self._state.offset])))


def _beats(one: End, other: End, is_before: bool) -> bool:
    """Return whether one end makes another useless: driving on from it is as cheap."""
    away = abs(one.standoff - other.standoff)
    return one is not other and one.steps + away <= other.steps and (away > 0 or one.steps < other.steps or is_before)


class FoldQueries:
    """The fold queries of a context; many states of a search share one, so they are kept."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._kept: dict[tuple[object, ...], FoldQuery] = {}
        places = np.arange(context.standoffs)
        away = np.abs(places[:, None] - places)
        self._driven = {False: away, True: np.where(away > 0, IMPOSSIBLE, 0)}

    def of(self, state: State, fold: int) -> FoldQuery:
        """Return the query about a fold in a state; states that differ in their standoff share it."""
        done, x, y, station, _, held, dragged = state.key
        key = (done, x, y, station, held, dragged > 0, fold)
        if key not in self._kept:
            self._kept[key] = FoldQuery(self._context, state, fold)
        return self._kept[key]

    def begun(self, state: State) -> NDArray[np.int64]:
        """Return the steps in which the base can be at each standoff when the hands begin.

        While the hands hold cloth, the base cannot drive first.
        """
        steps: NDArray[np.int64] = self._driven[bool(state.held)][state.standoff]
        return steps


class FoldStands:
    """The least driving that each fold takes, by the garment's place and the base's station, begun with empty hands.

    The search repeats the query for each state, since the cloth may have changed. But what a fold moves is the same
    after every set of folds, and so are its grips. Only the directions from which a grip may be approached depend on
    the cloth round it; where another fold may change that, every approach counts. So the result is a lower bound for
    every state, and mostly exact.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._known: dict[tuple[int, int, int, int], NDArray[np.int64]] = {}
        self._places = np.arange(context.standoffs)
        self._surroundings = context.kept(Surroundings)

    def least(self, fold: int, offset: Point2, station: int) -> NDArray[np.int64]:
        """Return for each standoff the least steps to drive in all when a fold is begun from there.

        Args:
            fold: the fold's index; a blue fold.
            offset: how far the garment has been dragged (m).
            station: where the robot stands.

        Returns:
            Steps of the grid of standoffs, `IMPOSSIBLE` where empty hands never can, shape (standoffs,).
        """
        key = (fold, grid_key(offset[0]), grid_key(offset[1]), station)
        if key not in self._known:
            self._known[key] = self._search(fold, offset, station)
        return self._known[key]

    def _search(self, fold: int, offset: Point2, station: int) -> NDArray[np.int64]:
        context = self._context
        state = State((1 << fold) - 1, offset, station, 0)
        driven = np.full(context.standoffs, IMPOSSIBLE)
        if is_line_on_table(context, fold, offset) and grips_obstacle(context, state, fold) is None:
            for trial in fold_trials(context, state, fold):
                np.minimum(driven, self._driven(trial, station), out=driven)
        away = np.abs(self._places[:, None] - self._places)
        return np.asarray(np.minimum((driven + away).min(axis=1), IMPOSSIBLE))

    def _driven(self, trial: FoldTrial, station: int) -> NDArray[np.int64]:
        """Return the steps driven from each standoff at which the path may be begun.

        The path is reversed, so that one query about its ends gives the steps for all beginnings.
        """
        context = self._context
        approaches = tuple(
            allowed if self._surroundings.are_same(trial.fold, grip) else context.kept(all_approaches)[arm]
            for grip, arm, allowed in zip(trial.cover, trial.arms, trial.approaches, strict=True)
        )
        back = replace(trial, tools=trial.tools[:, ::-1], approaches=approaches)
        anywhere = np.zeros(context.standoffs, dtype=np.int64)
        return np.asarray(back.following(context, station)(anywhere, wanted="every").steps)
