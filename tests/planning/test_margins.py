"""The margins of plans, against hand calculations and against what still has a plan."""

from dataclasses import replace

import numpy as np
import pytest

from planner import Scene, Task, load_garment, make_plan
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.planning.margins import margins_of
from planner.task.task import COMFORT_MAX_M
from tests.builders import fold, garment, rectangle_points
from tests.replay.planned import SOLVABLE, shipped_plan

TO_M = 0.001


@pytest.mark.parametrize("name", SOLVABLE)
def test_a_plan_reaches_no_less_than_the_comfort_radius_it_was_made_for(name: str) -> None:
    plan = shipped_plan(name)
    margins = margins_of(plan)
    assert margins is not None and margins.reach_m is not None
    assert plan.task.limits.comfort_radius_m - TO_M <= margins.reach_m <= COMFORT_MAX_M
    assert (margins.reach_step is None) == (margins.reach_m == COMFORT_MAX_M)
    assert plan.task.limits.comfort_radius_m > 0.0


def test_a_plan_made_without_comfort_has_the_margin_of_its_tightest_step() -> None:
    # Planned with comfort up to that margin, the same steps are still possible; the plan can only be as quick.
    task = Task.of(load_garment("scarf")).within(0.0)
    plan = make_plan(task)
    margins = margins_of(plan)
    assert margins is not None and margins.reach_m is not None and margins.reach_step is not None
    assert margins.reach_m < COMFORT_MAX_M
    assert plan.steps[margins.reach_step].grips
    tighter = make_plan(task.within(max(margins.reach_m - TO_M, 0.0)))
    assert tighter.cost_s == pytest.approx(plan.cost_s, abs=1e-6)


def test_friction_and_edge_margins_are_those_of_the_cloth_as_it_lies() -> None:
    # A towel of 0.4 m by 0.3 m hangs 0.1 m over the front edge: a quarter, so that a third is pulled by each that lies.
    halving = fold((0.4, 0.15), (0.0, 0.15), name="half")
    table = Table()
    cloth = garment(rectangle_points(0.4, 0.3), halving, placement=Pose2(-table.depth_m / 2 - 0.1, -0.15, 0.0))
    plan = make_plan(Task.of(cloth, Scene(friction=0.8)))
    assert plan.is_solved
    margins = margins_of(plan)
    assert margins is not None
    assert margins.friction == pytest.approx(0.8 - 1.0 / 3.0, abs=1e-3)
    assert margins.edge_m == pytest.approx(-0.1, abs=1e-6)


def test_grips_are_apart_by_more_than_they_must_be() -> None:
    plan = shipped_plan("hand-towel")
    margins = margins_of(plan)
    pairs = [[np.array(held.point) for held in step.holdings] for step in plan.steps if len(step.holdings) == 2]
    assert margins is not None and pairs
    assert margins.grips_m == pytest.approx(min(np.linalg.norm(a - b) for a, b in pairs) - 0.1)


@pytest.mark.long
def test_where_there_is_no_plan_there_are_no_margins() -> None:
    plan = shipped_plan("tie-halved")
    assert not plan.is_solved and margins_of(plan) is None
    assert margins_of(replace(plan, status="budget_exceeded")) is None
