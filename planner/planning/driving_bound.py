"""A lower bound that includes driving, for garments with many folds that depend on no others.

The arms' time alone cannot tell in which order to do loose folds: until the last drag or move is paid for, every set of
folds that can be done without it looks as good as any other, and 40 folds have 2^40 sets.

The bound therefore includes the time for driving, dragging and moving that the remaining folds still need, in a relaxed
problem: a fold can be done from wherever it can be done at all (`FoldStands`), and drags and moves lead anywhere that
the table's size allows. For each fold alone, and for a few folds together that are far from each other, the bound finds
the least time to visit such places from every place within a horizon (`relaxed_sites`); beyond the horizon it assumes
that nothing remains to be done. The bound is the largest of these times, plus the arms' time. It is the exact cost of a
relaxed problem, hence consistent.
"""

from collections.abc import Iterator, Sequence
from itertools import takewhile

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.planning.budget import Budget
from planner.planning.heuristic import Heuristic, arm_time
from planner.primitives.context import Context
from planner.primitives.fold_query import FoldStands
from planner.primitives.relaxed_sites import FREE, HELD, Sites, to_go
from planner.primitives.site_map import Service, Site, SiteMap
from planner.primitives.state import ANYWHERE, State

_HORIZON_S, _GROWTH = 8.0, 1.6
"""The distance of the first horizon (s), and the factor from each horizon to the next."""

_BEYOND_S = 3.0
"""Margin by which the bound must stay below the horizon (s): the search also looks a little beyond what seems best."""

_SITES_MAX = 100
"""Sites within a horizon at which it stops growing; checking a fold from one site takes a millisecond."""

_FOLDS_MAX = 12
"""Folds in the bound; of more folds, those far from each other are chosen."""

_TOGETHER_MAX = 4
"""Folds bounded together; each further fold doubles the time."""


class DrivingBound:
    """The arms' time for the remaining folds plus the least driving, dragging and moving."""

    def __init__(self, context: Context, start: State, budget: Budget | None = None) -> None:
        """Explore the surroundings of a problem's start, until the budget is over if there is one."""
        self._context = context
        self._budget = budget or Budget.endless()
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
        """Return the time needed besides the arms' time (s).

        Where the state leaves the standoff open, this is the least over all standoffs.
        """
        number = self._numbers.get((*state.place, state.station))
        if number is None:
            return 0.0
        least = self._left(state.done)
        if state.standoff == ANYWHERE:
            return float(least[FREE, number].min())
        if not state.is_dragged:
            return float(least[FREE, number, state.standoff])
        if self._service.is_possible(state.offset, state.station):
            return float(least[HELD, number, state.standoff])
        return float(least[FREE, number, state.standoff]) + self._context.scene.arm_motion_s

    def _left(self, done: int) -> FloatArray:
        """Return the bound for the folds left, shape (2, sites, standoffs), s."""
        are_served = not self._service.all_folds & ~done
        key = (done & self._mask, are_served)
        if key not in self._known:
            left = [number for number, fold in enumerate(self._folds) if not done >> fold & 1]
            rows = self._table(are_served)[left]
            together = sum(1 << bit for bit, number in enumerate(self._together) if number in left)
            self._known[key] = np.maximum(self._joint[are_served][together], rows.max(axis=0, initial=0.0))
        return self._known[key]

    def _table(self, are_served: bool) -> FloatArray:
        """Return the bound for each fold alone, shape (folds, 2, sites, standoffs).

        This also computes the bound for folds together.
        """
        if are_served not in self._joint:
            sites = self._map.sites(self._within, are_served)
            if are_served not in self._alone:
                self._alone[are_served] = self._each_alone(sites, self._steps)
            steps, is_served = self._steps[self._together], self._is_served[self._together]
            self._joint[are_served] = to_go(sites, steps, is_served)
        return self._alone[are_served]

    def _within_horizon(self) -> tuple[tuple[Site, ...], NDArray[np.int64], FloatArray]:
        """Return the sites, the steps of each fold at each site, and the bound for each fold alone."""
        horizon_s = _HORIZON_S
        while True:
            sites, are_all = self._map.within(horizon_s, _SITES_MAX)
            found = [(site, self._steps_at(site)) for site in self._in_time(sites)]
            within = tuple(site for site, _ in found)
            steps = np.array([of_site for _, of_site in found]).swapaxes(0, 1)
            self._is_served = self._served(within)
            alone = self._each_alone(self._map.sites(within, is_service_over=False), steps)
            needed_s = float(alone[:, FREE, 0, self._start.standoff].max())
            is_enough = needed_s < horizon_s - _BEYOND_S or are_all or len(within) >= _SITES_MAX
            if is_enough or self._budget.is_over:
                return self._without_the_impossible(within, steps, alone)
            horizon_s *= _GROWTH

    def _without_the_impossible(
        self, within: tuple[Site, ...], steps: NDArray[np.int64], alone: FloatArray
    ) -> tuple[tuple[Site, ...], NDArray[np.int64], FloatArray]:
        """Drop the folds that cannot be done from anywhere; finding out why is left to the search."""
        is_possible = np.isfinite(alone[:, FREE, 0, self._start.standoff])
        self._folds = [fold for fold, is_kept in zip(self._folds, is_possible, strict=True) if is_kept]
        self._is_served = self._is_served[is_possible]
        return within, steps[is_possible], alone[is_possible]

    def _in_time(self, within: Sequence[Site]) -> Iterator[Site]:
        """Yield the first site, and the sites after it while there is time."""
        yield within[0]
        yield from takewhile(lambda _: not self._budget.is_over, within[1:])

    def _steps_at(self, site: Site) -> list[NDArray[np.int64]]:
        return [self._stands.least(fold, site.offset, site.station) for fold in self._folds]

    def _served(self, within: Sequence[Site]) -> BoolArray:
        """Return whether grips left by a drag that ends at a site may serve a fold, shape (folds, sites)."""
        return np.array([[self._service.may_serve(f, s.offset, s.station) for s in within] for f in self._folds])

    def _each_alone(self, sites: Sites, steps: NDArray[np.int64]) -> FloatArray:
        rows = zip(steps, self._is_served, strict=True)
        return np.array([to_go(sites, of_fold[None], is_served[None])[1] for of_fold, is_served in rows])

    def _far_apart(self) -> list[int]:
        """Choose the folds that together need the most time from the start, greedily adding the fold that adds most."""
        sites = self._map.sites(self._within, is_service_over=False)
        start = self._start.standoff
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
    """Return the blue folds, or at most `most` of them whose lines are far from each other."""
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
