"""Robots with one arm, with arms that differ in their joints, and with three arms, planned for like any other."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import pytest

from planner import Plan, Scene, load_garment
from planner.cloth.garment import Garment
from planner.motion.timeline import Timeline
from planner.planning import problem
from planner.planning.found_plan import FoundPlan
from planner.planning.plan_check import require_replay
from planner.planning.warm_up import compile_kernels
from planner.plans import find_plan, quick_plan
from planner.task.reason import Code
from planner.task.task import Task
from tests.builders import fold, garment
from tests.replay.planned import shipped_plan
from tests.required import required
from tests.robots.remade import BOLTED, ONE_ARM, THREE_ARMS, UNLIKE, RemadeRobot

FRONT_ONLY = Scene(stations=Scene().stations[:1])

Planning = Callable[[RemadeRobot, Garment], FoundPlan]


@pytest.fixture
def found_for(monkeypatch: pytest.MonkeyPatch) -> Iterator[Planning]:
    compile_kernels()

    def found(robot: RemadeRobot, what: Garment) -> FoundPlan:
        monkeypatch.setattr(problem, "load_robot", lambda name: robot)
        return find_plan(Task.of(what, FRONT_ONLY, time_limit_s=60.0))

    yield found


def arms_of(plan: Plan) -> list[list[str]]:
    return [[grip.arm for grip in step.grips] for step in plan.steps if step.kind == "fold"]


def require_performed(plan: Plan, robot: RemadeRobot) -> None:
    """The plan can be performed, joint paths and all, and is told in the joints and arms of this robot alone."""
    assert plan.is_solved and plan.trajectory is not None
    assert plan.trajectory.arms.names == tuple(name for arm in robot.card.arms for name in arm.joint_names)
    assert [track.arm for track in plan.trajectory.grippers] == [arm.name for arm in robot.card.arms]
    again = Plan.from_dict(plan.to_dict())
    assert again == plan
    require_replay(again)


@pytest.mark.parametrize("name", ["tie", "scarf"])
def test_one_arm_folds_what_one_grip_can_hold(found_for: Planning, name: str) -> None:
    plan = found_for(ONE_ARM, load_garment(name)).plan
    require_performed(plan, ONE_ARM)
    assert {arm for arms in arms_of(plan) for arm in arms} == {"single"}


def test_one_arm_is_told_that_a_towel_takes_two_hands(found_for: Planning) -> None:
    plan = found_for(ONE_ARM, load_garment("hand-towel")).plan
    first, *_ = plan.reasons
    assert (first.fold, first.code) == (0, Code.TOO_MANY_GRIPS)
    assert "more than one hand can" in first.message


def test_arms_of_eight_and_of_seven_joints_do_what_those_of_a_pr2_do(found_for: Planning) -> None:
    usual, plan = shipped_plan("hand-towel"), found_for(UNLIKE, load_garment("hand-towel")).plan
    require_performed(plan, UNLIKE)
    assert len(required(plan.trajectory).arms.names) == 15
    assert plan.cost_s == pytest.approx(usual.cost_s)
    assert arms_of(plan) == arms_of(usual)


def test_of_three_arms_those_two_fold_that_are_nearest(found_for: Planning) -> None:
    towel = load_garment("hand-towel")
    beside = replace(towel, folds=towel.folds[:1], placement=towel.placement.moved(0.0, 0.3))
    plan = found_for(THREE_ARMS, beside).plan
    require_performed(plan, THREE_ARMS)
    assert arms_of(plan)[0] == ["outer", "left"]


def test_three_arms_hold_what_takes_three_grips(found_for: Planning) -> None:
    # Corners 35 cm from each other, along the robot's front.
    outline = [(0.0, 0.0), (0.7, 0.0), (0.7, 0.14), (0.35, 0.2), (0.0, 0.14)]
    up = fold((0.0, 0.05), (0.7, 0.05), radius_m=0.08)
    tab = garment(outline, up, placement=replace(load_garment("hand-towel").placement, x_m=-0.65, y_m=0.4))
    plan = found_for(THREE_ARMS, tab).plan
    require_performed(plan, THREE_ARMS)
    assert arms_of(plan) == [["outer", "left", "right"]]


def test_a_plan_of_one_arm_is_adapted_to_cloth_that_lies_a_little_elsewhere(found_for: Planning) -> None:
    scarf = load_garment("scarf")
    known = found_for(ONE_ARM, scarf)
    moved = replace(scarf, placement=scarf.placement.moved(0.02, 0.01))
    quick = quick_plan(Task.of(moved, FRONT_ONLY), like=[known])
    assert quick is not None
    require_performed(quick.plan, ONE_ARM)


def test_a_robot_without_lift_whose_base_is_fixed_folds_where_it_stands(found_for: Planning) -> None:
    # A vest lies so near that joints would have to go beyond their soft limits; a base that drives backs off for it.
    found = found_for(BOLTED, load_garment("hand-towel"))
    require_performed(found.plan, BOLTED)
    start = found.plan.task.start.base
    assert {step.kind for step in found.plan.steps} == {"fold"}
    assert {(step.after.base.x_m, step.after.base.y_m, step.after.base.station) for step in found.plan.steps} == {
        (start.x_m, start.y_m, None)
    }
    still = Timeline.of(found.plan).at(1.0)
    assert "torso_lift_joint" not in still.joints and still.torso_m == 0.0


def test_a_fixed_base_has_no_plan_where_it_would_have_to_drive(found_for: Planning) -> None:
    assert not found_for(BOLTED, load_garment("scarf")).plan.is_solved


def test_a_fixed_base_drags_with_its_arms_what_lies_too_far_away(found_for: Planning) -> None:
    towel = load_garment("hand-towel")
    away = replace(towel, placement=towel.placement.moved(0.25, 0.0))
    usual, plan = found_for(BOLTED, towel).plan, found_for(BOLTED, away).plan
    require_performed(plan, BOLTED)
    assert [step.kind for step in plan.steps] == ["arm_drag", *(step.kind for step in usual.steps)]
    assert plan.cost_s == pytest.approx((usual.cost_s or 0.0) + 6.0, abs=1.0)


def test_a_fixed_base_is_told_to_have_the_cloth_brought_nearer(found_for: Planning) -> None:
    towel = load_garment("hand-towel")
    away = replace(towel, placement=towel.placement.moved(0.75, 0.0))
    reason = found_for(BOLTED, away).plan.reasons[0]
    assert reason.code is Code.OUT_OF_REACH and reason.change is not None
    nearer = reason.change["placement"]
    assert nearer["x_m"] < away.placement.x_m
    there = replace(towel, placement=replace(towel.placement, **nearer))
    assert Code.OUT_OF_REACH not in {
        told.code for told in found_for(BOLTED, there).plan.reasons if told.fold == reason.fold
    }
