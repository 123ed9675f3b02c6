"""Drags by the arms of a robot whose base stays: two arm motions, in eight directions, as far as the arms reach."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from planner import Plan, Scene
from planner.cloth.garment import Garment
from planner.geometry.pose import Pose2
from planner.planning import problem
from planner.planning.heuristic import arm_time
from planner.planning.plan_check import require_replay
from planner.plans import find_plan
from planner.primitives.arm_drag import ArmDrag, ArmDragStep
from planner.primitives.context import Context
from planner.primitives.drag_way import drag_offsets
from planner.primitives.state import Held, State
from planner.task.task import Task
from tests.builders import context, fold, garment, rectangle_points
from tests.required import required
from tests.robots.remade import BOLTED
from tests.wide_reach import WideReach

STAYS = Scene(stations=(("", Scene().stations[0][1]),), back_off_max_m=0.0)
START = State(0, (0.0, 0.0), 0, 0)
FRONT = Scene(stations=Scene().stations[:1])
TOWEL = (0.4, 0.3)


def towel(x_m: float = -0.2, y_m: float = 0.2) -> Garment:
    """Return a towel whose fold moves its near half; garment (x, y) is at table (x_m + y, y_m - x)."""
    near_half = fold((TOWEL[0], 0.15), (0.0, 0.15))
    return garment(rectangle_points(*TOWEL), near_half, placement=Pose2(x_m, y_m, -math.pi / 2))


def bolted(what: Garment, reach: WideReach | None = None) -> Context:
    return replace(context(what, STAYS, reach), is_fixed=True)


def drags(of: Context, state: State = START) -> list[ArmDragStep]:
    return list(ArmDrag(of).successors(state))


def test_a_base_that_drives_drags_itself() -> None:
    assert drags(context(towel())) == []


def headings_deg(what: Garment) -> set[int]:
    return {round(math.degrees(step.details["heading_rad"])) % 360 for step in drags(bolted(what))}


def test_there_are_eight_directions_in_each_of_which_two_hands_hold_what_goes_ahead() -> None:
    turned = replace(towel(), placement=Pose2(-0.2, 0.0, -0.25 * math.pi))
    assert headings_deg(towel()) == {0, 90, 180, 270}
    assert headings_deg(turned) == {45, 135, 225, 315}


def test_each_drag_takes_two_arm_motions_and_ends_on_a_grid() -> None:
    found = drags(bolted(towel()))
    assert {step.duration_s for step in found} == {6.0}
    assert {step.kind for step in found} == {"arm_drag"}
    for step in found:
        x, y = step.after.offset
        assert 10.0 * x == pytest.approx(round(10.0 * x)) and 10.0 * y == pytest.approx(round(10.0 * y))
        assert step.distance_m == pytest.approx(math.hypot(x, y))
        assert not step.after.held and step.after.done == 0
        assert sum(phase.duration_s for phase in step.phases) == pytest.approx(step.duration_s)


def test_the_hands_take_the_side_that_goes_ahead_and_end_with_the_cloth() -> None:
    found = drags(bolted(towel()))
    step = next(s for s in found if s.after.offset == pytest.approx((-0.1, 0.0)))
    assert [grip.arm for grip in step.grips] == ["left", "right"]
    for grip in step.grips:
        assert grip.pick[0] == pytest.approx(-0.2), "the near edge"
        np.testing.assert_allclose(np.subtract(grip.place, grip.pick), [-0.1, 0.0, 0.0], atol=1e-9)


def test_the_arms_drag_no_farther_than_they_reach() -> None:
    scene_x_m = STAYS.stations[0][1].x_m
    case = bolted(towel(), WideReach([(0.0, 0.2 + TOWEL[1] - 0.2 - scene_x_m + 0.05)]))
    farthest = max(step.after.offset[0] for step in drags(case))
    assert farthest == pytest.approx(0.2)


def test_hands_that_hold_cloth_do_not_drag() -> None:
    assert drags(bolted(towel()), State(0, (0.0, 0.0), 0, 0, (Held(0, (0.0, 0.0)),))) == []


def test_no_drag_lowers_the_bound_by_more_than_it_costs() -> None:
    case = bolted(towel())
    bound = arm_time(case)
    for step in drags(case):
        assert bound(step.before) <= step.duration_s + bound(step.after)


def test_the_places_that_drags_can_lead_to_are_a_grid_over_the_table() -> None:
    offsets = drag_offsets(bolted(towel()), 2000)
    assert (10.0 * offsets == pytest.approx(np.round(10.0 * offsets))) and len(offsets) > 100


@pytest.fixture
def answered(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Plan]:
    """Return what plans a towel that lies too far away for a robot whose base stays."""
    monkeypatch.setattr(problem, "load_robot", lambda name: BOLTED)

    def answered(**limits: Any) -> Plan:
        return find_plan(Task.of(towel(x_m=-0.3), FRONT, time_limit_s=60.0, **limits)).plan

    return answered


def test_a_towel_that_lies_too_far_away_is_dragged_and_folded_also_without_a_heuristic(
    answered: Callable[..., Plan],
) -> None:
    plan = answered()
    assert plan.is_solved and [step.kind for step in plan.steps] == ["arm_drag", "fold"]
    assert 15.0 - 1e-6 <= required(plan.cost_s) <= 18.0
    again = Plan.from_dict(plan.to_dict())
    assert again == plan
    require_replay(again)
    assert answered(heuristic="zero").cost_s == pytest.approx(plan.cost_s, abs=1e-6)
