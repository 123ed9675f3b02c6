"""Find the standoffs from which a fold can be begun with empty hands, whatever other folds are done.

The search repeats this query for each state, since the cloth may have changed. But what a fold moves is the same after
every set of folds, and so are its grips. Only the directions from which a grip may be approached depend on the cloth
round it; where another fold may change that, every approach counts. So the result is a lower bound for every state, and
mostly exact.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.pose import Point2
from planner.geometry.tolerance import grid_key
from planner.primitives.context import Context
from planner.primitives.fold_obstacles import is_line_on_table
from planner.primitives.fold_trial import FoldTrial, Surroundings, fold_trials, grips_obstacle
from planner.primitives.grasping import all_approaches
from planner.primitives.state import State


class FoldStands:
    """The least driving that each fold takes, by the article's place and the base's station."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._known: dict[tuple[int, int, int, int], NDArray[np.int64]] = {}
        self._places = np.arange(context.standoffs)
        self._surroundings = context.kept(Surroundings)

    def least(self, fold: int, offset: Point2, station: int) -> NDArray[np.int64]:
        """Return for each standoff the least steps to drive in all when a fold is begun from there.

        Args:
            fold: the fold's index; a blue fold.
            offset: how far the article has been dragged (m).
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
        return np.asarray(back.following(context, station).least_driving(anywhere, wanted="every").steps)
