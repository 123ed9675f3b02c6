"""A lower bound that knows of driving, for many folds that wait for nothing.

The arms' time alone cannot tell in which order loose folds had better be done: before the last drag or move is paid
for, every set of folds that can be done without it looks as good as any other, and of 40 folds there are 2^40 sets.

So the time for driving, dragging and moving that the remaining folds still need is bounded as well, in a relaxed
problem: folds are done from where they can be done at all (`FoldStands`), and drags and moves go wherever the table's
size allows. For each fold alone, and for a few together that are far from each other, the least time to visit such
places is found for every place within a horizon (`relaxed_sites`); beyond it nothing is left to be done. The bound is
the largest of these times, and the arms' time. It is the exact cost of a relaxed problem, hence consistent.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import takewhile

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.planning.heuristic import Heuristic, arm_time
from planner.primitives.context import Context
from planner.primitives.drag_service import Service
from planner.primitives.fold_stands import FoldStands
from planner.primitives.relaxed_sites import FREE, HELD, Sites, to_go
from planner.primitives.site_map import Site, SiteMap
from planner.primitives.state import ANYWHERE, State

_HORIZON_S, _GROWTH = 8.0, 1.6
"""How far the first horizon is (s), and by how much each next one is further."""

_BEYOND_S = 3.0
"""A horizon does when the bound is so much less (s): the search looks a little beyond what seems best."""

_SITES_MAX = 100
"""A horizon is no further than there are so many sites within: to ask for a fold from one takes a millisecond."""

_FOLDS_MAX = 12
"""Of more folds than this so many are asked for, far from each other."""

_TOGETHER_MAX = 4
"""So many folds are asked for together: each more doubles the time."""


class DrivingBound:
    """The arms' time for the remaining folds, and the least driving, dragging and moving."""

    def __init__(self, context: Context, start: State, is_over: Callable[[], bool] = lambda: False) -> None:
        """Look round the start of a planning problem, until it is over with the time for that."""
        self._context = context
        self._is_over = is_over
        self._start = start
        self._arms: Heuristic = arm_time(context)
        self._stands = context.kept(FoldStands)
        self._service = context.kept(Service)
        self._map = SiteMap(context, start, self._service)
        self._folds = _spread(context, _FOLDS_MAX)
        self._within, self._steps, alone = self._within_horizon()
        self._mask = sum(1 << fold for fold in self._folds)
        self._numbers = {site.key: number for number, site in enumerate(self._within)}
        self._alone = {False: alone}
        self._together = self._far_apart()
        self._joint: dict[bool, FloatArray] = {}
        self._known: dict[tuple[int, bool], FloatArray] = {}

    def __call__(self, state: State) -> float:
        """Return a lower bound on the time from a state to the end (s)."""
        return self._arms(state) + self._driving_s(state)

    def _driving_s(self, state: State) -> float:
        """What is needed besides the arms' time (s); anywhere at a site, where the state says so."""
        number = self._numbers.get((*state.place, state.station))
        if number is None:
            return 0.0
        least = self._left(state.done)
        if state.back_off == ANYWHERE:
            return float(least[FREE, number].min())
        if not state.is_dragged:
            return float(least[FREE, number, state.back_off])
        if self._service.is_possible(state.offset, state.station):
            return float(least[HELD, number, state.back_off])
        return float(least[FREE, number, state.back_off]) + self._context.scene.arm_motion_s

    def _left(self, done: int) -> FloatArray:
        """The bound for the folds left, shape (2, sites, back-offs), s."""
        is_over = not self._service.all_folds & ~done
        key = (done & self._mask, is_over)
        if key not in self._known:
            left = [number for number, fold in enumerate(self._folds) if not done >> fold & 1]
            rows = self._table(is_over)[left]
            together = sum(1 << bit for bit, number in enumerate(self._together) if number in left)
            self._known[key] = np.maximum(self._joint[is_over][together], rows.max(axis=0, initial=0.0))
        return self._known[key]

    def _table(self, is_over: bool) -> FloatArray:
        """The bound for each fold alone, shape (folds, 2, sites, back-offs); sees to that for some together."""
        if is_over not in self._joint:
            sites = self._map.sites(self._within, is_over)
            if is_over not in self._alone:
                self._alone[is_over] = self._each_alone(sites, self._steps)
            steps, is_served = self._steps[self._together], self._is_served[self._together]
            self._joint[is_over] = to_go(sites, steps, is_served)
        return self._alone[is_over]

    def _within_horizon(self) -> tuple[tuple[Site, ...], NDArray[np.int64], FloatArray]:
        """The sites looked at, the steps that each fold takes at each, and the bound for each fold alone."""
        horizon_s = _HORIZON_S
        while True:
            sites, are_all = self._map.within(horizon_s, _SITES_MAX)
            found = [(site, self._steps_at(site)) for site in self._in_time(sites)]
            within = tuple(site for site, _ in found)
            steps = np.array([of_site for _, of_site in found]).swapaxes(0, 1)
            self._is_served = self._served(within)
            alone = self._each_alone(self._map.sites(within, is_service_over=False), steps)
            needed_s = float(alone[:, FREE, 0, self._start.back_off].max())
            is_enough = needed_s < horizon_s - _BEYOND_S or are_all or len(within) >= _SITES_MAX
            if is_enough or self._is_over():
                return self._without_the_impossible(within, steps, alone)
            horizon_s *= _GROWTH

    def _without_the_impossible(
        self, within: tuple[Site, ...], steps: NDArray[np.int64], alone: FloatArray
    ) -> tuple[tuple[Site, ...], NDArray[np.int64], FloatArray]:
        """The same without the folds that can be done from nowhere: why not is for the search to find out."""
        is_possible = np.isfinite(alone[:, FREE, 0, self._start.back_off])
        self._folds = [fold for fold, is_kept in zip(self._folds, is_possible, strict=True) if is_kept]
        self._is_served = self._is_served[is_possible]
        return within, steps[is_possible], alone[is_possible]

    def _in_time(self, within: Sequence[Site]) -> Iterator[Site]:
        """The first site, and those after it for which there is time."""
        yield within[0]
        yield from takewhile(lambda _: not self._is_over(), within[1:])

    def _steps_at(self, site: Site) -> list[NDArray[np.int64]]:
        return [self._stands.least(fold, site.offset, site.station) for fold in self._folds]

    def _served(self, within: Sequence[Site]) -> BoolArray:
        """Whether grips left by a drag that ends at a site may serve a fold, shape (folds, sites)."""
        return np.array([[self._service.may_serve(f, s.offset, s.station) for s in within] for f in self._folds])

    def _each_alone(self, sites: Sites, steps: NDArray[np.int64]) -> FloatArray:
        rows = zip(steps, self._is_served, strict=True)
        return np.array([to_go(sites, of_fold[None], is_served[None])[1] for of_fold, is_served in rows])

    def _far_apart(self) -> list[int]:
        """The folds that together need most from the start, one after the other the one that adds most."""
        sites = self._map.sites(self._within, is_service_over=False)
        start = self._start.back_off
        chosen: list[int] = []
        needed_s = 0.0
        kinds = {self._steps[n].tobytes(): n for n in reversed(range(len(self._folds)))}
        while len(chosen) < _TOGETHER_MAX:
            sets = [[*chosen, n] for n in kinds.values() if n not in chosen]
            costs = [float(to_go(sites, self._steps[s], self._is_served[s])[-1, FREE, 0, start]) for s in sets]
            most_s = max((cost_s for cost_s in costs if np.isfinite(cost_s)), default=0.0)
            if most_s <= needed_s:
                break
            needed_s, chosen = most_s, sets[costs.index(most_s)]
        return chosen


def _spread(context: Context, most: int) -> list[int]:
    """The blue folds, or so many of them whose lines are far from each other."""
    blue = [fold.index for fold in context.sequence.folds if not fold.is_red]
    middles = np.array(
        [context.sequence.folds[fold].line.at(0.5 * context.sequence.folds[fold].line.length) for fold in blue]
    )
    chosen = [0]
    away = np.hypot(*(middles - middles[0]).T)
    while len(chosen) < min(most, len(blue)):
        chosen.append(int(away.argmax()))
        away = np.minimum(away, np.hypot(*(middles - middles[chosen[-1]]).T))
    return sorted(blue[number] for number in chosen)
