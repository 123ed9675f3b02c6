"""Other places on the table: which are tried, and how, for a base that drives and for one that does not; their map."""

import math

import numpy as np
import pytest

from planner import Scene, Task, make_plan
from planner.explain.room import Room, turned_in_place
from planner.explain.suggestion import SuggestionTrial
from planner.explain.suggestion_map import placement_map
from planner.explain.suggestion_placement import FINE_STEP_M, STEP_M, placements
from planner.geometry.pose import Pose2
from planner.planning.robot_task import task_for
from planner.task.task import TaskOptions
from tests.builders import fold, garment, rectangle_points
from tests.clocks import slow_machine
from tests.explain.proven_search import FRONT_ONLY, towel, tried_in_vain


def napkin(robot: str) -> Task:
    return task_for(garment(rectangle_points(0.3, 0.2), fold((0.15, 0.2), (0.15, 0.0))), robot=robot)


def places(trials: list[SuggestionTrial]) -> list[tuple[float, ...]]:
    return [tuple(round(value, 6) for value in trial.change["placement"].values()) for trial in trials]


def test_a_base_that_stands_has_folds_tried_on_a_finer_grid_and_then_drags_by_the_arms() -> None:
    trials = list(tried_in_vain(placements(napkin("so101-pair"), None)))
    alone = [trial for trial in trials if trial.by_folds_alone]
    dragged = [trial for trial in trials if not trial.by_folds_alone]
    assert trials == alone + dragged
    assert sorted(places(alone)) == sorted(places(dragged)) and len(set(places(alone))) == len(alone)
    here = napkin("so101-pair").start.placement
    steps = [(trial.change["placement"]["x_m"] - here.x_m) / FINE_STEP_M for trial in alone if trial.size < 0.3]
    is_coarse = [round(step) % round(STEP_M / FINE_STEP_M) == 0 for step in steps]
    assert all(is_coarse[: is_coarse.index(False)]) and not all(is_coarse)


def test_a_base_that_drives_has_whole_plans_tried_on_one_grid() -> None:
    trials = list(tried_in_vain(placements(napkin("pr2"), None)))
    assert trials and not any(trial.by_folds_alone for trial in trials)
    assert len(set(places(trials))) == len(trials)


def test_turned_in_place_the_middle_stays() -> None:
    cloth = towel()
    middle = np.array([0.15, 0.2])
    for quarters in range(4):
        turned = turned_in_place(cloth, cloth.placement, quarters)
        assert turned.to_outer(middle) == pytest.approx(cloth.placement.to_outer(middle))


def test_the_room_of_a_garment_ends_where_its_edge_meets_the_tables() -> None:
    # At yaw -90 degrees the towel reaches from x = -0.7 to -0.3 and from y = -0.15 to 0.15; the table is 1.6 x 0.98 m.
    room = Room.of(towel(), Pose2(-0.7, 0.15, -math.pi / 2), Scene().table)
    assert room.low == pytest.approx((-0.1, -0.34))
    assert room.high == pytest.approx((1.1, 0.34))
    assert room.nearest == (0.0, 0.0)
    assert len(list(room.moves(0.1))) == 13 * 7


def test_a_garment_larger_than_the_table_has_no_room() -> None:
    room = Room.of(garment(rectangle_points(2.0, 2.0)), Pose2(0.0, 0.0, 0.0), Scene().table)
    assert room.is_none
    assert not list(room.moves(0.1))


def test_a_map_has_a_cell_for_each_place_and_its_best_is_the_cheapest() -> None:
    found = placement_map(Task.of(towel(), FRONT_ONLY, time_limit_s=60.0), step_m=0.3)
    assert found.is_complete
    assert len(found.cells) == 4 * 3  # the room above, in steps of 0.3 m
    costs = [cell.cost_s for cell in found.cells if cell.cost_s is not None]
    assert found.best is not None
    assert found.best.cost_s == min(costs)
    assert len(costs) < len(found.cells)
    best = make_plan(towel(), FRONT_ONLY, placement=found.best.placement)
    assert best.cost_s == pytest.approx(found.best.cost_s, abs=1e-9)


def test_a_map_cut_short_says_so() -> None:
    for limits in (TaskOptions(work_limit_s=0.2), TaskOptions(time_limit_s=0.2)):
        found = placement_map(Task.of(towel(), **limits), step_m=0.02)
        assert not found.is_complete
        assert found.to_dict()["complete"] is False


def test_on_a_slow_machine_the_map_has_the_same_cells(monkeypatch: pytest.MonkeyPatch) -> None:
    limits = TaskOptions(work_limit_s=0.4, time_limit_s=60.0)
    quick, slowly = (
        placement_map(Task.of(towel(), FRONT_ONLY, **limits), should_stop=should_stop)
        for should_stop in (None, slow_machine(monkeypatch))
    )
    assert slowly == quick
    assert quick.cells and not quick.is_complete
