"""Hands hold edges where that takes no longer, and where hands that open widely have no path."""

from dataclasses import replace

import pytest

from planner import Garment, Scene, load_garment
from planner.motion.transfer_planner import TransferPlanner
from planner.planning.warm_up import compile_kernels
from tests.planning.found import found_plan

AHEAD_M = {"hand-towel": 0.2, "t-shirt": 0.0, "vest": 0.0}
"""How far ahead of its usual place a garment lies (m).

Hands at edges point down at 45 degrees. Where the hand towel usually lies, joints would have to go beyond their soft
limits for that.
"""

EDGES = {"hand-towel": 8, "t-shirt": 8, "vest": 0}
"""How many grips of a plan hold edges."""


@pytest.fixture(autouse=True)
def _kernels() -> None:
    compile_kernels()  # plans for that are no part of what is counted here


def moved(name: str, ahead_m: float) -> Garment:
    one = load_garment(name)
    return replace(one, placement=one.placement.moved(ahead_m, 0.0))


@pytest.mark.parametrize("name", EDGES)
def test_hands_hold_edges_where_that_takes_no_longer(name: str) -> None:
    plan = found_plan(moved(name, AHEAD_M[name]), time_limit_s=60.0).plan
    assert plan.is_proven
    assert [grip.kind for step in plan.steps for grip in step.grips].count("edge") == EDGES[name]


def test_hands_that_come_late_to_an_edge_take_shortcuts_or_hold_otherwise() -> None:
    found = found_plan(moved("hand-towel", 0.2), Scene(arm_motion_s=2.2), time_limit_s=60.0)
    assert found.plan.is_proven and "edge" in {grip.kind for step in found.plan.steps for grip in step.grips}
    assert not any(plan_segment.late_s > 0.0 for plan_segment in found.plan_segments)


def test_where_hands_that_open_widely_have_no_path_others_at_edges_are_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(TransferPlanner, "first_valid", lambda *_: None)
    plan = found_plan(moved("hand-towel", 0.2), time_limit_s=60.0).plan
    assert plan.is_solved
    assert {grip.kind for step in plan.steps for grip in step.grips} == {"edge"}
