"""Thick cloth is taken and laid down higher, and cloth of usual thickness as if it had none."""

from dataclasses import replace

import numpy as np
import pytest

from planner import Plan, load_garment, make_plan
from planner.motion.timeline import Timeline
from planner.planning.plan_check import require_replay
from tests.required import required

FLEECE_M = 0.005


def planned(thickness_m: float) -> Plan:
    return make_plan(replace(load_garment("letter-towel"), thickness_m=thickness_m), time_limit_s=60.0)


def heights(plan: Plan) -> list[tuple[float, float]]:
    """Return the heights at which each fold takes and lays down the cloth (m)."""
    return [(step.grips[0].pick[2], required(step.grips[0].place)[2]) for step in plan.steps if step.kind == "fold"]


def test_fleece_is_laid_down_on_its_stack_and_taken_up_there() -> None:
    plan = planned(FLEECE_M)
    # The near half is taken where it is one layer, and laid onto the other: two layers of 5 mm and a finger of 12 mm.
    # The hands hold on, and lay the free edge back onto both: three layers.
    (first, laid), (taken, last) = heights(plan)
    assert (first, laid, taken, last) == pytest.approx((0.02, 0.022, 0.022, 0.027))
    require_replay(plan)


def test_a_stack_of_fleece_is_drawn_as_high_as_it_lies() -> None:
    plan = planned(FLEECE_M)
    end = Timeline.of(plan).at(required(plan.cost_s)).cloth
    # Nothing presses the three layers: each takes 5 mm and 1 mm of air.
    for layer, height_m in enumerate((0.006, 0.012, 0.018)):
        heights = end.vertices[end.triangles[end.layers == layer]][..., 2]
        assert heights == pytest.approx(np.full_like(heights, height_m), abs=1e-6)


def test_cloth_as_thin_as_usual_or_thinner_is_planned_alike() -> None:
    usual, thin = planned(0.001), planned(0.0001)
    assert usual.cost_s == thin.cost_s
    assert [step.to_dict() for step in usual.steps] == [step.to_dict() for step in thin.steps]
