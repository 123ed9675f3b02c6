"""Variants of a fold between two states: the least travel first, and the base only where the hands can follow."""

import math
from itertools import islice
from typing import Any

import numpy as np
import pytest

from planner import Scene, load_garment
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.driving import STANDOFF_STEP_M
from planner.geometry.reach_query import ReachQuery
from planner.primitives import fold_variants as variants_module
from planner.primitives.base_legs import legs
from planner.primitives.context import Context
from planner.primitives.fold_step import FoldStep, fold_step
from planner.primitives.fold_trial import fold_trials
from planner.primitives.fold_variants import Variant, fold_spread, fold_variants, trial_variants
from planner.primitives.g_fold import GFold
from planner.primitives.state import State
from planner.robots.load_robot import load_robot
from tests.builders import CIRCLE_M

START = State(0, (0.0, 0.0), 0, 0)
BACKED_OFF = State(0, (0.0, 0.0), 0, 5)
COUNT = 16


def problem(name: str) -> Context:
    garment = load_garment(name)
    reach = load_robot("pr2").reach(Scene().torso_m, 0.03)
    return Context(FoldSequence.of(garment), Scene(), reach, garment.placement, CIRCLE_M)


@pytest.fixture(scope="module")
def context() -> Context:
    return problem("hand-towel")


def step_of(context: Context, state: State, variant: Variant) -> FoldStep:
    return fold_step(context, variant.way, state, variant.first, variant.end, variant.steps)


def masks(context: Context, station: int, variant: Variant) -> np.ndarray:
    """Return from where each waypoint is in reach of both hands in a variant's orientations, by single queries."""
    trial, found = variant.way.trial, np.full(len(variant.way.trial.sweeps), -1)
    for arm, tools, approach in zip(trial.arms, trial.tools, variant.way.approaches, strict=True):
        points = context.in_base(station, tools)
        for number, point in enumerate(points):
            row = context.reach.standoffs(ReachQuery(arm, point[None], np.array([approach]), context.standoffs))
            found[number] &= int(row[0, 0])
    return found


def travel_m(step: FoldStep) -> float:
    """Return how far the base drives in a step's phases (m)."""
    drives = [(phase.base[0], phase.base[1]) for phase in step.phases]
    return sum(math.dist((a.x_m, a.y_m), (b.x_m, b.y_m)) for a, b in drives)


def test_the_ways_to_one_end_come_by_rising_travel_and_none_is_shorter_than_the_searchs(context: Context) -> None:
    for step in GFold(context).successors(START):
        fold, end = step.way.trial.fold, step.after.standoff
        found = list(fold_variants(context, START, fold, end))
        durations = [step_of(context, START, v).duration_s for v in found]
        assert len(found) > 1 and durations == sorted(durations)
        assert durations[0] == pytest.approx(step.duration_s)
        assert {v.end for v in found} == {end}


def test_each_way_is_another_one(context: Context) -> None:
    (step, *_) = GFold(context).successors(START)
    found = list(fold_variants(context, START, step.way.trial.fold, step.after.standoff))
    looks = {(v.way.trial.cover, v.way.trial.arms, v.way.approaches) for v in found}
    assert len(looks) == len(found)


def test_the_base_stands_only_where_both_hands_reach_their_waypoint(context: Context) -> None:
    for variant in list(fold_spread(context, BACKED_OFF, 0, COUNT))[::4]:
        seen, at = masks(context, START.station, variant), variant.first
        for mask, stand in zip(seen, legs(seen, variant.first, variant.end, context.standoffs), strict=True):
            between = range(min(at, stand), max(at, stand) + 1)
            assert all(int(mask) >> standoff & 1 for standoff in between)
            at = stand
        assert at == variant.end


def test_the_travel_told_is_what_the_phases_drive(context: Context) -> None:
    for variant in fold_spread(context, BACKED_OFF, 0, COUNT):
        step = step_of(context, BACKED_OFF, variant)
        assert travel_m(step) == pytest.approx(variant.steps * STANDOFF_STEP_M)
        assert sum(phase.duration_s for phase in step.phases) == pytest.approx(step.duration_s)


@pytest.mark.parametrize("count", [1, 3, COUNT, 100_000])
def test_a_spread_has_the_best_in_turns_with_others_or_all_there_are(context: Context, count: int) -> None:
    every = list(fold_spread(context, START, 0, 1_000_000))
    some = list(fold_spread(context, START, 0, count))
    assert min(count, len(every)) <= len(some) < 2 * count
    ranks, best = [(v.driven, v.rank) for v in some], min(count // 2, len(every))
    in_turns = ranks[: 2 * best : 2] if count < len(every) else ranks
    assert in_turns == sorted((v.driven, v.rank) for v in every)[: len(in_turns)]
    assert ranks[1 : 2 * best : 2] == sorted(ranks[1 : 2 * best : 2])


def test_with_grips_held_the_base_begins_where_it_stands() -> None:
    context = problem("letter-towel")
    held = max(GFold(context).successors(START), key=lambda s: len(s.after.held)).after
    assert held.held and held.standoff < context.standoffs
    found = list(fold_spread(context, held, 1, COUNT))
    assert found and {v.first for v in found} == {held.standoff}


def test_ways_that_need_no_driving_are_found_without_a_look_from_further_back(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    (step, *_) = GFold(context).successors(START)
    fold, end = step.way.trial.fold, step.after.standoff
    standoffs, counts = context.reach.standoffs, set()

    def noting(path: ReachQuery, **more: Any) -> Any:
        counts.add(path.count)
        return standoffs(path, **more)

    monkeypatch.setattr(context.reach, "standoffs", noting)
    few = islice(fold_variants(context, START, fold, end), 3)
    assert [v.steps for v in few] == [end - START.standoff] * 3
    assert counts == {end + 1} and end + 1 < context.standoffs


def test_all_ways_are_those_of_a_look_from_everywhere(context: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(variants_module, "_COMBINATIONS_MAX", 100_000)
    (step, *_) = GFold(context).successors(START)
    fold, end = step.way.trial.fold, step.after.standoff
    every = [v for trial in fold_trials(context, START, fold) for v in trial_variants(context, START, trial, end)]
    found = list(fold_variants(context, START, fold, end))
    assert [v.steps for v in found] == sorted(v.steps for v in every)
    assert {(v.way.trial.arms, v.way.approaches) for v in found} == {
        (v.way.trial.arms, v.way.approaches) for v in every
    }
