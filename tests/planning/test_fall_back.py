"""A long search falls back on a greedy plan, and reports it while it goes on."""

from dataclasses import replace
from itertools import pairwise

import pytest

from planner import Scene, Task, find_plan, load_garment, make_plan
from planner.planning import plan_search
from planner.planning.found_plan import FoundPlan
from tests.replay.planned import planned
from tests.required import required

TOO_FEW = 10
"""Too few states to find the T-shirt's quickest plan."""


@pytest.fixture
def found(monkeypatch: pytest.MonkeyPatch) -> list[FoundPlan]:
    """Return the plans that searches report which fall back at once."""
    monkeypatch.setattr(plan_search, "GREEDY_AFTER_S", 0.0)
    return []


def test_when_its_budget_runs_out_a_search_has_a_plan_though_maybe_not_the_quickest(found: list[FoundPlan]) -> None:
    answer = find_plan(Task.of(load_garment("t-shirt"), max_expanded=TOO_FEW), on_found=found.append).plan
    assert answer.is_solved and not answer.is_proven
    cost_s = required(answer.cost_s)
    assert required(answer.statistics.bound_s) < cost_s == found[0].plan.cost_s
    assert cost_s >= required(planned("t-shirt").answer.cost_s) - 1e-9


def test_without_that_it_has_none() -> None:
    assert make_plan(load_garment("t-shirt"), max_expanded=TOO_FEW).status == "budget_exceeded"


def test_the_quickest_plan_takes_its_place_once_it_is_found(found: list[FoundPlan]) -> None:
    # What is found soon for a shirt that lies here drives round the table.
    shirt = load_garment("shirt")
    moved = replace(shirt, placement=shirt.placement.moved(0.06, 0.02))
    answer = find_plan(Task.of(moved), on_found=found.append).plan
    assert answer.cost_s == pytest.approx(make_plan(moved).cost_s) and answer.is_proven
    costs_s = [required(one.plan.cost_s) for one in found]
    assert costs_s == sorted(costs_s, reverse=True) and costs_s[0] > required(answer.cost_s) + 20.0
    assert not found[0].plan.is_proven


def test_what_is_the_quickest_already_is_proven_to_be(found: list[FoundPlan]) -> None:
    answer = find_plan(Task.of(load_garment("vest")), on_found=found.append).plan
    assert [one.plan.cost_s for one in found] == [answer.cost_s] and answer.is_proven


def test_a_plan_that_is_known_needs_nothing_to_fall_back_on(found: list[FoundPlan]) -> None:
    known = planned("jeans").found
    answer = find_plan(Task.of(load_garment("jeans")), known=known, on_found=found.append).plan
    assert answer.is_proven and answer.task == Task.of(load_garment("jeans"))
    assert found == []


def test_where_there_is_no_plan_that_is_told_before_its_reasons_are_tried(found: list[FoundPlan]) -> None:
    answer = find_plan(Task.of(load_garment("scarf-halved")), on_found=found.append)
    (first,) = (one.plan for one in found)
    assert answer.plan.status == first.status == "infeasible"
    assert {reason.set for reason in first.reasons} == {None}
    assert any(reason.set is not None for reason in answer.plan.reasons)


def test_a_plan_slower_than_assumed_is_shown_while_a_quicker_one_is_looked_for() -> None:
    # Where an arm motion takes little time, hands come late from one fold to the next: the search goes on with a plan.
    shown: list[FoundPlan] = []
    answer = find_plan(Task.of(load_garment("scarf"), Scene(arm_motion_s=2.0)), on_found=shown.append).plan
    assert shown and all(one.plan.is_solved and not one.plan.is_proven for one in shown)
    costs_s = [required(one.plan.cost_s) for one in shown]
    assert costs_s == sorted(costs_s, reverse=True) and costs_s[-1] >= required(answer.cost_s) - 1e-9
    assert all(before_s - after_s > 0.1 for before_s, after_s in pairwise(costs_s))
