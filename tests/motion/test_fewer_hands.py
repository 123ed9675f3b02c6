"""Hands are taken away from a plan where that makes it quicker, and only where it is worth it."""

from itertools import pairwise

import pytest

from planner import Scene, Task, load_garment
from planner.motion.fewer_hands import with_fewer_hands
from planner.motion.plan_segment import PlanSegment, duration_s
from planner.motion.search_limits import QUICK
from planner.planning.found_plan import FoundPlan
from planner.planning.problem import Problem
from planner.plans import find_plan, quick_plan


@pytest.fixture(scope="module")
def firm() -> FoundPlan:
    """Return a plan of the vest with the hands that hold it firmly, by arms whose paths take longer than a motion."""
    found = quick_plan(Task.of(load_garment("vest"), Scene(arm_motion_s=1.3)), like=())
    assert found is not None
    return found


def hands(plan_segments: tuple[PlanSegment, ...]) -> int:
    return sum(len(step.grips) for plan_segment in plan_segments for step in plan_segment.steps)


def test_a_second_hand_that_makes_a_plan_slower_is_taken_away(firm: FoundPlan):
    fewer = with_fewer_hands(firm.plan_segments, Problem.of(firm.plan.task).maker, QUICK, worth_s=0.0)
    assert hands(fewer) == hands(firm.plan_segments) - 1
    assert duration_s(fewer) < duration_s(firm.plan_segments) - 0.005
    steps = [step for plan_segment in fewer for step in plan_segment.steps]
    assert all(before.after.key == after.before.key for before, after in pairwise(steps))


def test_a_second_hand_that_costs_less_than_it_is_worth_stays(firm: FoundPlan):
    maker = Problem.of(firm.plan.task).maker
    saved_s = duration_s(firm.plan_segments) - duration_s(
        with_fewer_hands(firm.plan_segments, maker, QUICK, worth_s=0.0)
    )
    assert with_fewer_hands(firm.plan_segments, maker, QUICK, worth_s=saved_s + 0.01) == firm.plan_segments


def test_a_plan_that_takes_as_long_as_its_motions_keeps_its_hands():
    found = find_plan(Task.of(load_garment("vest"), Scene()))
    maker = Problem.of(found.plan.task).maker
    assert with_fewer_hands(found.plan_segments, maker, QUICK, worth_s=0.0) == found.plan_segments
    assert maker.path_requests == 0
