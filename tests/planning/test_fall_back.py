"""A long search falls back on a greedy plan, and tells it while it goes on."""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import pytest

from planner import Plan, Scene, Task, load_garment, make_plan
from planner.geometry.pose import Pose2
from planner.planning import plan_search
from planner.planning.plan_search import Hints
from planner.plans import plan
from tests.builders import fold, garment, rectangle_points
from tests.replay.planned import planned, shipped_plan
from tests.required import required

TOO_FEW = 10
"""Too few states to find the T-shirt's quickest plan."""


@pytest.fixture
def _falls_back_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan_search, "GREEDY_AFTER_S", 0.0)


def told(task: Task, hints: Hints | None = None) -> tuple[Plan, Sequence[Plan]]:
    """Return the answer to a task, and the plans told before it."""
    *found, answer = (event.found.plan for event in plan(task, hints))
    return answer, found


@pytest.mark.usefixtures("_falls_back_at_once")
def test_when_its_budget_runs_out_a_search_has_a_plan_though_maybe_not_the_quickest() -> None:
    answer, (first, *_) = told(Task.of(load_garment("t-shirt"), max_expanded=TOO_FEW))
    assert answer.is_solved and not answer.is_proven
    cost_s = required(answer.cost_s)
    assert required(answer.statistics.bound_s) < cost_s == first.cost_s
    assert cost_s >= required(shipped_plan("t-shirt").cost_s) - 1e-9


def test_without_that_it_has_none() -> None:
    assert make_plan(load_garment("t-shirt"), max_expanded=TOO_FEW).status == "budget_exceeded"


@pytest.mark.usefixtures("_falls_back_at_once")
def test_the_quickest_plan_takes_its_place_once_it_is_found() -> None:
    # What is found soon for a shirt that lies here drives round the table.
    shirt = load_garment("shirt")
    moved = replace(shirt, placement=shirt.placement.moved(0.06, 0.02))
    answer, found = told(Task.of(moved))
    assert answer.cost_s == pytest.approx(make_plan(moved).cost_s) and answer.is_proven
    costs_s = [required(one.cost_s) for one in found]
    assert costs_s == sorted(costs_s, reverse=True) and costs_s[0] > required(answer.cost_s) + 20.0
    assert not found[0].is_proven


@pytest.mark.usefixtures("_falls_back_at_once")
def test_what_is_the_quickest_already_is_proven_to_be() -> None:
    answer, found = told(Task.of(load_garment("vest")))
    assert [one.cost_s for one in found] == [answer.cost_s] and answer.is_proven


@pytest.mark.usefixtures("_falls_back_at_once")
def test_a_plan_that_is_known_needs_nothing_to_fall_back_on() -> None:
    answer, found = told(Task.of(load_garment("jeans")), Hints(planned("jeans").found))
    assert answer.is_proven and answer.task == Task.of(load_garment("jeans"))
    assert found == []


@pytest.mark.usefixtures("_falls_back_at_once")
def test_where_there_is_no_plan_that_is_told_before_its_reasons_are_tried() -> None:
    alone = Scene(stations=Scene().stations[:1])
    towel = garment(rectangle_points(0.4, 0.5), fold((0.4, 0.25), (0.0, 0.25)), placement=Pose2(0.2, 0.4, -math.pi / 2))
    answer, (first,) = told(Task.of(towel, alone))
    assert answer.status == first.status == "infeasible"
    assert {reason.set for reason in first.reasons} == {None}
    assert any(reason.set is not None for reason in answer.reasons)


def test_a_plan_slower_than_assumed_is_shown_while_a_quicker_one_is_looked_for() -> None:
    # Where an arm motion takes little time, hands come late from one fold to the next: the search goes on with a plan.
    answer, shown = told(Task.of(load_garment("scarf"), Scene(arm_motion_s=2.0), work_limit_s=2.0))
    assert shown and all(one.is_solved and not one.is_proven for one in shown)
    costs_s = [required(one.cost_s) for one in shown]
    assert costs_s == sorted(costs_s, reverse=True) and costs_s[-1] >= required(answer.cost_s) - 1e-9
    assert all(before_s - after_s > 0.1 for before_s, after_s in pairwise(costs_s))


def test_who_has_enough_closes_the_stream_and_nothing_more_is_searched(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan_search, "GREEDY_AFTER_S", 0.0)
    stream = plan(Task.of(load_garment("t-shirt")))
    first = next(stream).found
    assert first.plan.is_solved
    queries = first.context.reach.memory.queries
    stream.close()
    assert list(stream) == [] and first.context.reach.memory.queries == queries


@pytest.mark.parametrize("spare_s", [-0.5, 0.5])
def test_where_no_plan_beats_a_cost_none_is_told_and_nothing_is_proven(spare_s: float) -> None:
    quickest = shipped_plan("vest")
    answer, found = told(Task.of(load_garment("vest")), Hints(below_s=required(quickest.cost_s) + spare_s))
    if spare_s > 0.0:
        assert answer.cost_s == quickest.cost_s
    else:
        assert (answer.status, answer.is_proven, found) == ("budget_exceeded", False, [])
