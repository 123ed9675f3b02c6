"""Greedy plans: they can be executed, though others may be quicker."""

import math
from dataclasses import replace

import pytest

from planner import Scene, Task, load_garment, quick_plan
from planner.geometry.pose import Pose2
from planner.planning import greedy
from planner.planning.budget import Budget
from planner.planning.problem import Problem
from planner.planning.quick_plan import quickly_planned
from tests.replay.checker import check
from tests.replay.planned import SOLVABLE, shipped_plan
from tests.required import required

_FOUND_SOON = sorted({*SOLVABLE} - {"tie", "shirt"})


@pytest.mark.parametrize("name", _FOUND_SOON)
def test_what_is_found_at_one_go_can_be_done_and_none_is_quicker_than_the_quickest(name: str) -> None:
    cloth = load_garment(name)
    found = quick_plan(Task.of(cloth), like=[])
    assert found is not None
    plan = found.plan
    cost_s = required(plan.cost_s)
    assert cost_s >= required(shipped_plan(name).cost_s) - 1e-6
    assert required(plan.statistics.bound_s) <= cost_s


@pytest.mark.parametrize("name", ["hand-towel", "jeans", "letter-towel"])
def test_what_is_found_at_one_go_replays(name: str) -> None:
    cloth = load_garment(name)
    check(cloth.to_dict(), Scene().to_dict(), required(quick_plan(Task.of(cloth), like=[])).plan.to_dict())


def test_it_gives_up_where_the_arms_fail_too_often(monkeypatch: pytest.MonkeyPatch) -> None:
    assert quick_plan(Task.of(load_garment("tie")), like=[]) is not None, "after a run that was not real"
    monkeypatch.setattr(greedy, "_FAILURES_MAX", 1)
    assert quick_plan(Task.of(load_garment("tie")), like=[]) is None


def test_it_gives_up_where_too_many_states_would_have_to_be_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    assert quick_plan(Task.of(load_garment("vest")), like=[]) is not None
    monkeypatch.setattr(greedy, "_EXPANDED_MAX", 1)
    monkeypatch.setattr(greedy, "_EXPANDED_PER_FOLD", 0)
    assert quick_plan(Task.of(load_garment("vest")), like=[]) is None


def test_a_patient_one_finds_what_one_that_gives_up_early_does_not() -> None:
    # At the table's far end the T-shirt's sides are in reach from one station and its bottom from another.
    task = Task.of(replace(load_garment("t-shirt"), placement=Pose2(-0.75, 0.229, -math.pi / 2.0)))
    assert quickly_planned(Problem.of(task), (), Budget.endless()) is None
    found = quickly_planned(Problem.of(task), (), Budget.endless(), is_patient=True)
    assert found is not None
    check(found.plan.garment.to_dict(), Scene().to_dict(), found.plan.to_dict())
