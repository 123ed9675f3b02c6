"""Which places are tried, and how, for a base that drives and for one that does not."""

from types import SimpleNamespace
from typing import cast

from planner import Task
from planner.explain.suggestion_placement import FINE_STEP_M, STEP_M, placements
from planner.explain.suggestion_trial import SuggestionTrial
from planner.planning.robot_task import task_for
from planner.task.plan import Plan
from tests.builders import fold, garment, rectangle_points

IN_VAIN = cast(Plan, SimpleNamespace(cost_s=None))


def napkin(robot: str) -> Task:
    return task_for(garment(rectangle_points(0.3, 0.2), fold((0.15, 0.2), (0.15, 0.0))), robot=robot)


def tried_in_vain(task: Task) -> list[SuggestionTrial]:
    """Return all trials of a search in which none gives a plan."""
    search, found = placements(task, None), []
    trial = next(search, None)
    while isinstance(trial, SuggestionTrial):
        found.append(trial)
        try:
            trial = search.send(IN_VAIN)
        except StopIteration:
            break
    return found


def places(trials: list[SuggestionTrial]) -> list[tuple[float, ...]]:
    return [tuple(round(value, 6) for value in trial.change["placement"].values()) for trial in trials]


def test_a_base_that_stands_has_folds_tried_on_a_finer_grid_and_then_drags_by_the_arms() -> None:
    trials = tried_in_vain(napkin("so101-pair"))
    alone = [trial for trial in trials if trial.by_folds_alone]
    dragged = [trial for trial in trials if not trial.by_folds_alone]
    assert trials == alone + dragged
    assert sorted(places(alone)) == sorted(places(dragged)) and len(set(places(alone))) == len(alone)
    here = napkin("so101-pair").start.placement
    steps = [(trial.change["placement"]["x_m"] - here.x_m) / FINE_STEP_M for trial in alone if trial.size < 0.3]
    is_coarse = [round(step) % round(STEP_M / FINE_STEP_M) == 0 for step in steps]
    assert all(is_coarse[: is_coarse.index(False)]) and not all(is_coarse)


def test_a_base_that_drives_has_whole_plans_tried_on_one_grid() -> None:
    trials = tried_in_vain(napkin("pr2"))
    assert trials and not any(trial.by_folds_alone for trial in trials)
    assert len(set(places(trials))) == len(trials)
