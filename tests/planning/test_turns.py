"""Turning over is planned as a fold of all the cloth whose edge stays on the table."""

import math

import numpy as np
import pytest

from planner import Plan, make_plan
from planner.cloth.garment import Garment
from planner.geometry.pose import Pose2
from planner.motion.timeline import Timeline
from planner.planning.plan_check import require_replay
from planner.planning.problem import Problem
from planner.primitives.fold_obstacles import geometric_obstacle
from planner.primitives.state import State
from planner.task.task import Task
from tests.area import require_drawn_whole
from tests.builders import fold, garment, rectangle_points
from tests.required import required


def towel(x_m: float = -0.5, y_m: float = 0.2) -> Garment:
    """A towel, .3 m deep, that is turned about its near edge, which lies at an x, from a y .4 m to the right."""
    turn = fold((0.0, 0.0), (0.4, 0.0), "turn")
    return garment(rectangle_points(0.4, 0.3), turn, placement=Pose2(x_m, y_m, -math.pi / 2))


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(towel(), time_limit_s=60.0)


def test_a_towel_is_turned_by_its_far_corners_over_the_edge_that_stays(plan: Plan) -> None:
    (step,) = (step for step in plan.steps if step.kind == "fold")
    # Reached, lifted and laid down: three arm motions, .3 m up at the apex, .3 m beyond the edge at the end.
    assert step.duration_s >= 9.0
    picks = sorted(grip.pick for grip in step.grips)
    assert picks == [pytest.approx((-0.2, -0.2, 0.02)), pytest.approx((-0.2, 0.2, 0.02))]
    assert [required(grip.apex)[0::2] for grip in step.grips] == [pytest.approx((-0.5, 0.32))] * 2
    assert [required(grip.place)[0] for grip in step.grips] == pytest.approx([-0.8, -0.8])
    require_replay(plan)


def test_what_is_drawn_stands_on_the_edge_and_keeps_its_area(plan: Plan) -> None:
    (step,) = (step for step in plan.steps if step.kind == "fold")
    for t_s in np.linspace(step.start_s, step.end_s, 25):
        cloth = Timeline.of(plan).at(float(t_s)).cloth
        require_drawn_whole(cloth, 0.12)
    assert cloth.vertices[:, 0].max() == pytest.approx(-0.5, abs=1e-6)


def obstacle_of(x_m: float, y_m: float = 0.2) -> str | None:
    problem = Problem.of(Task.of(towel(x_m, y_m)))
    found = geometric_obstacle(problem.context, State(0, (0.0, 0.0), 0, 0), 0)
    return None if found is None or found.says is None else found.says.text


def test_the_edge_about_which_cloth_is_turned_is_wholly_on_the_table() -> None:
    # The table's left edge is at y = .49, its near one at x = -.8.
    assert obstacle_of(-0.5) is None
    assert "the edge about which it turns reaches 0.06 m beyond the table's edge" in required(obstacle_of(-0.5, 0.55))
    assert "all of its line lies beyond the table's edge, by 0.03 m" in required(obstacle_of(-0.83))


def test_turned_cloth_must_stay_where_it_comes_to_lie() -> None:
    # With its edge at x = -.7, .2 m of .3 m would hang over the table's edge afterwards: it slips.
    assert "afterwards" in required(obstacle_of(-0.7))


def test_cloth_that_is_folded_turned_and_folded_again_is_planned() -> None:
    outline = rectangle_points(0.4, 0.3)
    folds = (
        fold((0.0, 0.15), (0.4, 0.15)),
        fold((0.0, 0.0), (0.4, 0.0), "turn"),
        fold((0.2, -0.15), (0.2, 0.0)),
    )
    plan = make_plan(garment(outline, *folds, placement=Pose2(-0.5, 0.2, -math.pi / 2)), time_limit_s=60.0)
    assert [step.fold for step in plan.steps if step.kind == "fold"] == [0, 1, 2]
    assert Plan.from_dict(plan.to_dict()) == plan
