"""What a plan may cost: more stations, an arm that is not at home, folds given in another order, the rest of a plan."""

import math
from dataclasses import replace

import pytest

from planner import Garment, Plan, Scene, load_garment, make_plan
from planner.geometry.pose import Point2, Pose2
from planner.geometry.table import Table
from planner.planning.problem import Problem
from planner.planning.restricted_tasks import with_arms_apart
from planner.primitives.fold_trial import fold_trials
from planner.primitives.fold_variants import trial_variants
from planner.task.reason import Code
from planner.task.scene import DEFAULT_STATIONS
from planner.task.task import Task
from tests.builders import fold, garment
from tests.replay.planned import shipped_plan
from tests.required import required
from tests.robots.remade import RemadeRobot

WORK_S = 10.0


def planned(what: Garment, scene: Scene | None = None) -> Plan:
    return make_plan(what, scene, time_limit_s=60.0, work_limit_s=WORK_S)


def hood(wide: float, low: float, high: float, out: float, side: float, half: float) -> Garment:
    """Return a hooded top with its sleeves down: sleeves, both sides, and the lower half up."""
    neck, shoulder = 0.3 * wide, high + 0.026
    right: list[Point2] = [
        (wide, 0.0),
        (wide, low),
        (wide + out - 0.05, low - 0.26 * out),
        (wide + out, low - 0.26 * out + 0.083),
        (wide, high),
        (wide - neck, shoulder),
        (wide - neck - 0.007, shoulder + 0.16),
    ]
    outline = (*right, *((wide - x, y) for x, y in reversed(right)))
    over = high + side / neck * (shoulder - high)
    return garment(
        outline,
        fold((0.0, low), (0.0, high)),
        fold((wide, high), (wide, low)),
        fold((side, 0.0), (side, over)),
        fold((wide - side, over), (wide - side, 0.0)),
        fold((wide - side, half), (side, half)),
    )


def least_travel(problem: Problem, fold_index: int, done: int) -> int:
    """Return the least steps of driving from the first standoff for a fold."""
    state = replace(problem.start, done=done)
    trials = fold_trials(problem.context, state, fold_index)
    return min(way.steps for trial in trials for way in trial_variants(problem.context, state, trial))


def tall_hood() -> Garment:
    """Return a hood whose second side is out of the hands' way only after a drag, or from another station."""
    one = hood(0.33647, 0.32179, 0.49307, 0.19663, 0.09956, 0.25493)
    return replace(one, placement=Pose2(-0.69325, 0.13007, -math.pi / 2))


@pytest.mark.long
def test_more_stations_never_cost_more() -> None:
    front = Scene(stations=(("front", DEFAULT_STATIONS["front"]),))
    many, one = planned(tall_hood()), planned(tall_hood(), front)
    assert many.is_solved and one.is_solved
    assert required(many.cost_s) <= required(one.cost_s) + 1e-5
    assert all(step.kind != "move" for step in many.steps), "a drag does without the drive round the table"


@pytest.mark.long
def test_independent_folds_given_in_another_order_cost_the_same() -> None:
    one = hood(0.367, 0.2609, 0.3997, 0.248, 0.088, 0.1884)
    one = replace(one, placement=Pose2(-0.63198, 0.17753, -math.pi / 2))
    left, right, side, other_side, half = one.folds
    other = replace(one, folds=(right, left, other_side, side, half))
    assert planned(other).cost_s == pytest.approx(planned(one).cost_s, abs=1e-5)


def test_the_rest_of_a_plan_after_a_drag_that_holds_costs_what_is_left() -> None:
    # A poncho a tenth larger, here, is folded from another station: the arms' soft limits leave no room for a drag.
    wide, cut, low, side = 0.518, 0.096, 0.2477, 0.3233
    right: list[Point2] = [(wide - cut, 0.0), (wide, cut), (wide, wide - cut), (wide - cut, wide)]
    poncho = garment(
        (*right, *((wide - x, y) for x, y in reversed(right))),
        fold((wide, low), (0.0, low)),
        fold((side, wide), (side, low)),
    )
    plan = planned(replace(poncho, placement=Pose2(-0.6138, 0.26188, -1.63851)))
    assert plan.is_proven and plan.state_after(0).held
    rest = make_plan(replace(plan.task, start=plan.state_after(0)))
    assert rest.cost_s == pytest.approx(required(plan.cost_s) - plan.steps[0].end_s, abs=1e-5)


def test_where_the_rest_of_a_plan_cannot_be_done_with_what_is_held_nor_without_it_there_are_reasons() -> None:
    task = Task.of(load_garment("big-towel"))
    held = shipped_plan("big-towel").state_after(0)
    assert held.held
    plan = make_plan(replace(task, start=held).in_scene(Scene(table=Table(height_m=1.15))))
    assert plan.status == "infeasible" and plan.reasons[0].code is Code.OUT_OF_REACH


def test_a_bound_minds_no_arm_that_may_be_elsewhere() -> None:
    # 10 cm nearer, the shirt's third fold at standoff 0 brings the right arm where the left one is at home, not in that
    # fold. Without the folds after that one all four can be done there, in three arm motions each.
    shirt = load_garment("shirt")
    sleeves = replace(shirt, folds=shirt.folds[:4], placement=shirt.placement.moved(-0.1, 0.0))
    problem = Problem.of(Task.of(sleeves))
    (apart,) = with_arms_apart(problem)
    assert (least_travel(problem, 2, done=0b1011), least_travel(apart, 2, done=0b1011)) == (0, 1)
    plan = planned(sleeves)
    assert plan.statistics.bound_s == pytest.approx(36.0)
    assert not plan.is_proven or plan.cost_s == pytest.approx(36.0)


def test_with_arms_apart_a_place_beside_the_other_arm_at_home_is_out_of_reach() -> None:
    problem = Problem.of(Task.of(load_garment("shirt")))
    (apart,) = with_arms_apart(problem)
    assert apart.context.reach is not problem.context.reach
    assert apart.context.reach.comfort_m == problem.context.reach.comfort_m


def test_a_robot_that_minds_no_arms_has_no_task_with_arms_apart() -> None:
    problem = Problem.of(Task.of(load_garment("hand-towel")))
    assert not list(with_arms_apart(replace(problem, robot=RemadeRobot())))  # type: ignore[arg-type]
