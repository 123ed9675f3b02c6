"""Changes to a task: the request that asks for each, and the least amount that is enough."""

import math
import random
from dataclasses import replace

import pytest

from planner import Scene, Task
from planner.errors import SceneError
from planner.explain.change import (
    COMFORT,
    CONE,
    FRICTION,
    STIFFNESS,
    Bisection,
    Change,
    blue,
    cloth_moved,
    grip_radius,
    request_fields,
    station_moved,
    table_lifted,
    torso_lifted,
)
from planner.explain.relaxation_trials import RelaxedProblem
from planner.explain.suggestion import SuggestionTrial
from planner.geometry.pose import Pose2
from planner.planning.problem import Problem
from planner.planning.robot_task import task_for
from tests.builders import fold, garment, rectangle_points
from tests.planning.provoked import requested

AWAY = (1.0, 0.0, 0.0)
CLOTH = garment(
    rectangle_points(0.3, 0.6),
    fold((0.3, 0.4), (0.0, 0.4), radius_m=0.1),
    fold((0.0, 0.6), (0.3, 0.6), "red", radius_m=0.05),
    placement=Pose2(-0.7, 0.15, -math.pi / 2),
)
TASK = Task.of(CLOTH, Scene(friction=0.5))
CHANGES = {
    "friction": (FRICTION, 0.1, "scene"),
    "comfort": (COMFORT, 0.01, "comfort_radius_m"),
    "cone": (CONE, 0.2, "scene"),
    "stiffness": (STIFFNESS, 0.2, "scene"),
    "grips": (grip_radius((0, 1), in_drags=True), 0.06, "garment"),
    "blue": (blue(1), 0.0, "garment"),
    "cloth": (cloth_moved(AWAY), 0.05, "placement"),
    "station": (station_moved("front", AWAY), 0.05, "scene"),
    "table": (table_lifted(1.0), 0.05, "scene"),
    "torso": (torso_lifted(1.0), 0.05, "scene"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_the_fields_of_a_change_ask_for_the_task_that_it_makes(name: str) -> None:
    change, amount, field = CHANGES[name]
    changed = change.applied(TASK, amount)
    fields = request_fields(TASK, changed)
    assert list(fields) == [field]
    asked = requested(fields, CLOTH, TASK.scene)
    assert (asked.garment, asked.scene, asked.start, asked.limits) == (
        changed.garment,
        changed.scene,
        changed.start,
        changed.limits,
    )
    assert request_fields(TASK, TASK) == {}


@pytest.mark.parametrize("name", CHANGES)
def test_a_relaxed_problem_is_that_of_the_changed_task(name: str) -> None:
    change, amount, _ = CHANGES[name]
    base = RelaxedProblem(Problem.of(TASK))
    relaxed, afresh = base.changed(change, amount), Problem.of(change.applied(TASK, amount))
    assert relaxed.problem.task == afresh.task
    assert relaxed.context.scene == afresh.context.scene
    assert relaxed.context.placement == afresh.context.placement
    assert relaxed.context.reach.comfort_m == afresh.context.reach.comfort_m
    assert relaxed.change_from(base) == request_fields(TASK, afresh.task)


def test_a_changed_scene_keeps_the_stations_of_a_base_that_never_drives() -> None:
    task = task_for(garment(rectangle_points(0.2, 0.2), fold((0.2, 0.1), (0.0, 0.1))), robot="so101-pair")
    base = RelaxedProblem(Problem.of(task))
    fields = base.changed(FRICTION, 0.1).change_from(base)
    assert fields is not None
    assert Scene.from_dict(fields["scene"]).stations == task.scene.stations


def test_a_grip_radius_is_widened_from_the_least_and_none_gets_narrower() -> None:
    changed = grip_radius((0, 1), in_drags=False).applied(TASK, 0.02).garment
    assert [one.grip_radius_m for one in changed.folds] == [0.1, 0.07]
    assert changed.grip_radius_m == CLOTH.grip_radius_m


def test_what_no_request_can_ask_for_has_no_fields() -> None:
    base = RelaxedProblem(Problem.of(TASK))
    free = Change("collision", frees=lambda free, _: replace(free, may_collide=True))
    relaxed = base.changed(FRICTION, 0.1).changed(free)
    assert relaxed.may_collide and relaxed.change_from(base) is None


def test_a_change_that_gives_no_valid_task_has_no_trial() -> None:
    with pytest.raises(SceneError):
        torso_lifted(1.0).applied(TASK, 2.0)
    assert SuggestionTrial.of(torso_lifted(1.0), TASK, 2.0) is None


def least(search: Bisection, enough: float) -> tuple[float, int]:
    """Return the least amount found where all from `enough` on are enough, and the number of amounts tried."""
    tried = 0
    while (amount := search.amount) is not None:
        assert search.fails < amount < search.works
        search.note(amount, amount if amount >= enough else None)
        tried += 1
    return search.works, tried


def test_bisection_finds_the_least_amount_to_within_a_step() -> None:
    rng = random.Random(5)
    for _ in range(200):
        fails, width, step = rng.uniform(0.0, 1.0), rng.uniform(0.01, 2.0), rng.choice([0.001, 0.01])
        enough = rng.uniform(fails, fails + width)
        found, tried = least(Bisection(fails, fails + width, step, is_near=rng.random() < 0.5), enough)
        assert enough <= found <= enough + step + 1e-4
        assert tried <= 2 + math.ceil(math.log2(max(width / step, 1.0)))


def test_bisection_of_whole_amounts_finds_the_least_as_a_search_of_all_does() -> None:
    for enough in range(1, 40):
        for is_near in (False, True):
            assert least(Bisection(0, 40, 1, is_whole=True, is_near=is_near), enough)[0] == enough


def test_an_amount_that_was_measured_takes_one_trial_to_be_known_as_the_least() -> None:
    assert least(Bisection(0.0, 0.5, 0.001, is_near=True), 0.5) == (0.5, 1)
    assert least(Bisection(0.0, 0.5, 0.001), 0.5)[1] > 5
