"""Hands at edges are looked for when the search validates a path, before others."""

import math
from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace

import pytest

from planner import Garment, Plan, Scene, Task, load_garment
from planner.motion.edge_hands import EdgeHands
from planner.motion.plan_segment import PlanSegment, duration_s
from planner.motion.transfer_planner import TransferPlanner
from planner.planning.budget import Budget
from planner.planning.edge_path import EdgePath
from planner.planning.motion_validator import MotionValidator
from planner.planning.path_search import PathSearch
from planner.planning.plan_search import Hints, _PlanSearch
from planner.planning.problem import Problem
from planner.planning.restricted_tasks import with_narrower_cones
from planner.planning.warm_up import compile_kernels
from planner.plans import plan
from planner.primitives.primitive import Step
from tests.planning.found import found_plan
from tests.required import required

AHEAD_M = {"hand-towel": 0.2, "t-shirt": 0.0, "vest": 0.0}
"""How far ahead of its usual place a garment lies (m).

Hands at edges point down at 45 degrees. Where the hand towel usually lies, joints would have to go beyond their soft
limits for that.
"""

EDGES = {"hand-towel": 8, "t-shirt": 7, "vest": 0}
"""How many grips of a plan hold edges."""


@pytest.fixture(autouse=True)
def _kernels() -> None:
    compile_kernels()  # plans for that are no part of what is counted here


def moved(name: str, ahead_m: float) -> Garment:
    one = load_garment(name)
    return replace(one, placement=one.placement.moved(ahead_m, 0.0))


@pytest.mark.parametrize("name", EDGES)
def test_the_search_itself_finds_hands_at_edges(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.setattr(EdgeHands, "held", lambda self, plan_segments, deadline: plan_segments)
    found = found_plan(moved(name, AHEAD_M[name]), time_limit_s=60.0).plan
    assert found.is_proven
    assert [grip.kind for step in found.steps for grip in step.grips].count("edge") == EDGES[name]


def test_where_hands_hold_edges_no_others_are_led_along_the_path(monkeypatch: pytest.MonkeyPatch) -> None:
    def unwanted(*_: object) -> None:
        raise AssertionError("a path for hands that open widely was looked for")

    monkeypatch.setattr(TransferPlanner, "first_valid", unwanted)
    assert found_plan(moved("hand-towel", 0.2), time_limit_s=60.0).plan.is_proven


def test_hands_that_come_late_to_an_edge_hold_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(EdgeHands, "held", lambda self, plan_segments, deadline: plan_segments)
    rounds: list[float | None] = []
    late: list[bool] = []
    validated, is_late = MotionValidator.plan_segments, EdgePath.is_late

    def noted(
        self: MotionValidator, steps: Sequence[Step], at_edges: tuple[PlanSegment, ...]
    ) -> tuple[PlanSegment, ...] | None:
        plan_segments = validated(self, steps, at_edges)
        rounds.append(None if plan_segments is None else duration_s(plan_segments))
        return plan_segments

    def noted_late(self: EdgePath, validator: MotionValidator) -> bool:
        late.append(is_late(self, validator))
        return late[-1]

    monkeypatch.setattr(MotionValidator, "plan_segments", noted)
    monkeypatch.setattr(EdgePath, "is_late", noted_late)
    found = found_plan(moved("hand-towel", 0.2), Scene(arm_motion_s=2.2), time_limit_s=60.0)
    assert found.plan.is_proven and any(late)
    assert rounds == [pytest.approx(found.plan.cost_s)], "the first path is taken, as quick as it seemed"
    assert not any(plan_segment.late_s > 0.0 for plan_segment in found.plan_segments)


def test_hands_that_come_late_to_edges_are_shown_before_others_are_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    class OthersLookedForError(Exception):
        pass

    def look(*_: object) -> None:
        raise OthersLookedForError

    monkeypatch.setattr(TransferPlanner, "first_valid", look)
    shown: list[Plan] = []
    with pytest.raises(OthersLookedForError):
        for event in plan(Task.of(moved("hand-towel", 0.2), Scene(arm_motion_s=1.5))):
            shown.append(event.found.plan)
    assert shown and shown[0].is_solved and not shown[0].is_proven


def test_in_restricted_tasks_hands_hold_edges_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PathSearch, "has_doubts", True)  # else they are not searched
    problem = Problem.of(Task.of(moved("hand-towel", 0.2)))
    search = _PlanSearch(problem, Budget.endless(), Hints(), is_patient=True)
    search.restrict(next(with_narrower_cones(problem)), math.inf)
    found = required(search.exact.found)
    assert any(one.transfer is not None and one.transfer.edges for one in found)


def test_of_what_is_validated_only_what_beats_the_known_plan_is_kept() -> None:
    search = PathSearch(Problem.of(Task.of(load_garment("vest"))), Budget.endless(), 1000)
    search.known_s = 5.0

    def lasting(lasts_s: float) -> tuple[PlanSegment, ...]:
        return (PlanSegment(0, (SimpleNamespace(duration_s=lasts_s),), None),)

    for lasts_s, kept_s in ((6.0, None), (5.0, None), (4.0, 4.0), (4.5, 4.0), (3.0, 3.0)):
        search.keep(lasting(lasts_s))
        assert (None if search.found is None else duration_s(search.found)) == kept_s
