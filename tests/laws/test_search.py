"""A* finds the cost of an exhaustive search, and its bounds are never too high."""

import math

import pytest
from hypothesis import given

from planner.planning.budget import Budget
from planner.planning.single_fold import SingleFold
from planner.primitives.primitive_set import PRIMITIVES
from tests.laws.exhaustive import Exhaustive
from tests.laws.law import law
from tests.laws.scenes import BOUNDS, Problem, bound_of, problems
from tests.required import required

SECOND = 1e-6


@given(problems(most_folds=3, most_stations=2, standoffs=6))
@law("planning", short=6, long=50)
def test_the_search_finds_what_trying_everything_finds(problem: Problem) -> None:
    found, tried = problem.cost_s(), Exhaustive(problem.context).cost_s(problem.first_state)
    assert found == pytest.approx(tried, abs=SECOND)


@given(problems(most_stations=3))
@law("planning", short=6, long=100)
def test_what_is_no_cheaper_than_from_elsewhere_is_left_out_without_loss(problem: Problem) -> None:
    assert problem.lean_cost_s() == pytest.approx(problem.cost_s(), abs=SECOND)


@given(problems())
@law("planning", short=6, long=50)
def test_a_fold_that_is_called_impossible_alone_is_done_by_no_sequence_of_primitives(problem: Problem) -> None:
    alone = SingleFold(problem.context, problem.first_state.station, Budget.endless())
    folds = range(len(problem.garment.folds))
    assert not any(alone.is_impossible(fold) for fold in folds) or problem.cost_s() == math.inf


@given(problems())
@law("planning", short=4, long=30)
def test_a_plan_is_never_cheaper_than_the_cheapest_primitives_nor_is_there_one_without_them(problem: Problem) -> None:
    # Joint paths may take longer than the model's motions, and some cannot be had; they never make anything quicker.
    plan = problem.plan(with_reasons=True)
    cheapest = problem.cost_s()
    assert plan.status != "solved" or required(plan.cost_s) >= cheapest - SECOND
    assert plan.status != "infeasible" or plan.reasons
    assert math.isfinite(cheapest) or plan.status != "solved"


@given(problems())
@law("planning", short=6, long=50)
def test_every_heuristic_finds_the_same_cost(problem: Problem) -> None:
    costs = [problem.cost_s(name) for name in BOUNDS]
    assert costs == pytest.approx([costs[0]] * len(costs), abs=SECOND)


@given(problems())
@law("planning", short=6, long=50)
def test_no_heuristic_falls_by_more_than_a_step_costs_and_each_is_nothing_at_the_goal(problem: Problem) -> None:
    context = problem.context
    everything = (1 << len(problem.garment.folds)) - 1
    kinds = [kind(context) for kind in PRIMITIVES]
    bounds = [bound_of(name, context, problem.first_state) for name in BOUNDS]
    front, seen = [problem.first_state], {problem.first_state}
    while front and len(seen) < 2000:
        state = front.pop()
        if state.done == everything:
            assert all(bound(state) == 0.0 for bound in bounds)
            continue
        for step in (step for kind in kinds for step in kind.successors(state)):
            for bound in bounds:
                falls_by = bound(state) - bound(step.after)
                assert falls_by <= step.duration_s + SECOND or math.isinf(bound(state))
            if step.after not in seen:
                seen.add(step.after)
                front.append(step.after)
