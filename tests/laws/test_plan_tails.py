"""The tail of a plan is a plan: planning from the world after a step costs the rest of the plan."""

from dataclasses import replace

import pytest
from hypothesis import settings

from planner import Plan, make_plan
from planner.task.world_state import HeldPoint
from tests.laws.law import LONG
from tests.replay.planned import SOLVABLE, shipped_plan
from tests.sweep import sweep


def left_s(plan: Plan, step: int) -> float:
    return (plan.cost_s or 0.0) - (0.0 if step < 0 else plan.steps[step].end_s)


@sweep("name", SOLVABLE, ("jeans", "hand-towel", "letter-towel"))
def test_planning_from_the_world_after_a_step_costs_what_is_left(name: str) -> None:
    plan = shipped_plan(name)
    steps = range(-1, len(plan.steps))
    for step in steps if settings.get_current_profile_name() == LONG else {steps[0], steps[len(steps) // 2], steps[-2]}:
        rest = make_plan(replace(plan.task, start=plan.state_after(step)))
        assert rest.status == "solved", f"after step {step}"
        # With cloth in the hands, what joints that are slower than the cost model need depends on how they came there.
        is_slower = bool(plan.state_after(step).held) and not plan.is_proven
        share, exact_s = (0.02, None) if is_slower else (None, 1e-6)
        assert rest.cost_s == pytest.approx(left_s(plan, step), rel=share, abs=exact_s), f"after step {step}"
        assert rest.end.folds_done[: len(plan.state_after(step).folds_done)] == plan.state_after(step).folds_done


def test_a_plan_that_begins_with_cloth_in_the_hands_is_played_from_there() -> None:
    """A red fold goes on where the blue fold before it holds the cloth: the fingers are closed from the beginning."""
    plan = shipped_plan("letter-towel")
    assert plan.state_after(0).held
    rest = make_plan(replace(plan.task, start=plan.state_after(0)))
    assert rest.trajectory is not None
    held = {point.arm for point in plan.state_after(0).held}
    closed = {track.arm for track in rest.trajectory.grippers if track.opening_at(0.0) < 0.01}
    assert closed == held


def test_what_is_held_for_nothing_is_let_go() -> None:
    """A grip from a drag that no fold needs: the plan is that of free hands."""
    plan = shipped_plan("hand-towel")
    held = replace(plan.task.start, held=(HeldPoint("left", plan.garment.outline[0]),), dragged_m=0.1)
    rest = make_plan(replace(plan.task, start=held))
    assert rest.cost_s == pytest.approx(plan.cost_s, abs=1e-6)
