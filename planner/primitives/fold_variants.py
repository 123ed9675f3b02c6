"""Find all ways to perform a fold between two given states, and a selection of those from one state to any.

The search keeps one way for each end. Once arms must not collide, only ways that it left out may remain: other grips
that tie, the grips swapped between the arms, other orientations, a path begun or ended elsewhere.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from heapq import merge
from itertools import product, zip_longest
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.pose import BoolArray
from planner.geometry.reach_query import ReachQuery
from planner.primitives.base_legs import travel
from planner.primitives.context import Context
from planner.primitives.fold_trial import FoldTrial, fold_trials
from planner.primitives.fold_way import FoldWay
from planner.primitives.state import State

_COMBINATIONS_MAX = 240
"""The most combinations of orientations examined; of more, an evenly spaced selection is taken."""

Approaches: TypeAlias = tuple[NDArray[np.int64], ...]
"""For each hand the approaches that it may take, the most natural first."""


@dataclass(frozen=True, slots=True, eq=False)
class Variant:
    """A way to perform a fold.

    Attributes:
        way: grips, arms and path, in one orientation of each hand.
        first: the standoff from which the path is begun.
        end: the standoff at its end.
        steps: travel in all, in steps of the grid.
        driven: the part of it that is driven once the path is begun.
        rank: how far from natural the orientations are.
    """

    way: FoldWay
    first: int
    end: int
    steps: int
    driven: int
    rank: int


def fold_variants(context: Context, state: State, fold: int, end: int) -> Iterator[Variant]:
    """Yield the ways to do a fold in a state and end at a standoff: by rising travel, then more hands first.

    Args:
        context: the planning context.
        state: the state in which the fold starts.
        fold: the fold.
        end: the standoff at which the base ends.
    """
    trials = fold_trials(context, state, fold)
    yield from merge(*(_by_travel(context, state, trial, end) for trial in trials), key=_rank)


def _by_travel(context: Context, state: State, trial: FoldTrial, end: int) -> Iterator[Variant]:
    """Yield the ways of one trial that end at a standoff, sorted.

    Mostly only a few are wanted, and where arms reach from standoffs far back takes long to ask. So the standoffs are
    limited first: a way that drives further back than both its ends drives that far twice.
    """
    yielded, furthest = -1, max(state.standoff, end)
    for count in _counts(furthest + 1, context.standoffs):
        is_all = count == context.standoffs
        most = abs(state.standoff - end) + 2 * (count - 1 - furthest)
        found = (v for v in trial_variants(context, state, trial, end, count=count) if v.steps > yielded)
        yield from sorted((v for v in found if is_all or v.steps <= most), key=_rank)
        yielded = most


def _counts(least: int, most: int) -> Iterator[int]:
    """Yield numbers of standoffs: the least, and twice as many as long as there are more, up to the most."""
    count = least
    while count < most:
        yield count
        count *= 2
    yield most


def fold_spread(context: Context, state: State, fold: int, count: int) -> Iterator[Variant]:
    """Yield the best ways to do a fold in a state, in turns with an evenly spaced selection of the others.

    Where one of the best fails, mostly the next best fail too. The base may end anywhere. While the hands are empty,
    the ways do not depend on where the base stands before.
    """
    found = [v for trial in fold_trials(context, state, fold) for v in trial_variants(context, state, trial)]
    found.sort(key=lambda variant: (variant.driven, variant.rank))
    best = count // 2
    step = max(1, -(-(len(found) - best) // (count - best)))
    for pair in zip_longest(found[:best], found[best::step]):
        yield from (variant for variant in pair if variant is not None)


def _rank(variant: Variant) -> tuple[int, int, int]:
    return variant.steps, -len(variant.way.approaches), variant.rank


def trial_variants(
    context: Context,
    state: State,
    trial: FoldTrial,
    end: int | None = None,
    approaches: Approaches | None = None,
    count: int | None = None,
) -> Iterator[Variant]:
    """Yield the ways of one trial: for each combination of orientations, the one of least travel.

    Args:
        context: the planning context.
        state: the state in which the fold starts.
        trial: grips, arms and path.
        end: the standoff at which the base ends; None: any.
        approaches: the approaches to combine; None: all of the trial's.
        count: how many standoffs, from the first, the base may stand at; None: all.
    """
    count = context.standoffs if count is None else count
    masks, chosen, ranks = _all_strips(context, state, trial, approaches or trial.approaches, count, end)
    every = max(1, len(ranks) // _COMBINATIONS_MAX)
    masks, chosen, ranks = np.ascontiguousarray(masks[::every]), chosen[::every], ranks[::every]
    steps = np.where(_allowed(count, state, end), travel(masks, count), IMPOSSIBLE)
    begin = np.abs(np.arange(count) - state.standoff)
    total = steps if end is None else np.minimum(steps + begin[:, None], IMPOSSIBLE)
    total = total.reshape(len(steps), count**2)
    least = total.argmin(axis=1)
    for number in np.flatnonzero(total.min(axis=1) < IMPOSSIBLE):
        first, last = divmod(int(least[number]), count)
        way = FoldWay(trial, tuple(int(approach) for approach in chosen[number]))
        driven = int(steps[number, first, last])
        yield Variant(way, first, last, driven + int(begin[first]), driven, int(ranks[number]))


def _allowed(count: int, state: State, end: int | None) -> BoolArray:
    """Return at which of some standoffs a path may be begun and ended, shape (count, count)."""
    every = np.arange(count)
    is_first = every == state.standoff if state.held else np.ones(count, dtype=bool)
    is_last = every == end if end is not None else np.ones(count, dtype=bool)
    return np.asarray(is_first[:, None] & is_last)


def _all_strips(
    context: Context, state: State, trial: FoldTrial, approaches: Approaches, count: int, end: int | None
) -> tuple[NDArray[np.uint32], NDArray[np.int64], NDArray[np.int64]]:
    """Return every combination of approaches for which the base has one of some standoffs at every waypoint.

    A hand is queried only about the standoffs at which those before it can be.

    Returns:
        Bit masks of standoffs, shape (combinations, waypoints); each hand's approach, shape (combinations, hands); and
            ranks, how far from natural each combination is.
    """
    start = state.standoff if state.held else None
    masks, numbers = [], []
    among = None
    for arm, tools, allowed in zip(trial.arms, trial.tools, approaches, strict=True):
        path = ReachQuery(arm, context.in_base(state.station, tools), allowed, count)
        found = context.reach.standoffs(path, start=start, end=end, among=among)
        able = np.flatnonzero(found.all(axis=1))
        among = np.bitwise_or.reduce(found[able], axis=0)
        masks.append(found[able])
        numbers.append(able)
    choices = np.array([*product(*(range(len(n)) for n in numbers))], dtype=np.int64).reshape(-1, len(numbers))
    both = np.bitwise_and.reduce([m[choices[:, i]] for i, m in enumerate(masks)])
    is_able = both.all(axis=1)
    kept = choices[is_able]
    ranks = np.sum([n[kept[:, i]] for i, n in enumerate(numbers)], axis=0)
    columns = zip(approaches, numbers, strict=True)
    chosen = np.column_stack([allowed[n[kept[:, i]]] for i, (allowed, n) in enumerate(columns)])
    return both[is_able], chosen, np.asarray(ranks, dtype=np.int64)
