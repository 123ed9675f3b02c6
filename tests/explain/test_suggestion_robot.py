"""The robot stands elsewhere, or another is offered: where few kinds of change help, the quickest that can."""

import math
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from planner import Scene, Task, load_garment, make_plan
from planner.explain import suggestions as searching
from planner.explain.suggestion import Suggestion, SuggestionTrial
from planner.explain.suggestion_robot import robots, stations
from planner.explain.suggestions import suggestions
from planner.geometry.pose import Pose2
from planner.planning.robot_task import default_scene, task_for
from planner.task.plan import Plan
from tests.builders import fold, garment, rectangle_points
from tests.clocks import FastClock
from tests.explain.proven_search import asked, towel

SMALL = garment(rectangle_points(0.24, 0.2), fold((0.24, 0.1), (0.0, 0.1)))
"""A napkin that a robot with short arms can fold."""

LONG = garment(rectangle_points(0.6, 0.9), fold((0.6, 0.45), (0.0, 0.45)))
"""A towel that is too long for short arms."""

SHORT = "so101-pair"


def ignore(_: float) -> None:
    """Ignore how far a map is."""


def first_trial(task: Task, names: tuple[str, ...]) -> SuggestionTrial:
    wish = next(robots(task, names, ignore))
    assert isinstance(wish, SuggestionTrial)
    return wish


def test_a_towel_too_long_for_short_arms_is_given_to_another_robot_with_its_plan() -> None:
    task = task_for(LONG, robot=SHORT, work_limit_s=2.0, time_limit_s=60.0)
    found = [one for one in suggestions(task, other_robots=(SHORT, "pr2")) if one.kind == "robot"]
    assert found
    change = found[-1].change
    assert change["robot"] == "pr2" and "PR2" in found[-1].message and not found[-1].is_assumption
    again = task_for(
        LONG,
        default_scene("pr2"),
        placement=Pose2(**change["placement"]),
        start_station=change["start_station"],
        time_limit_s=60.0,
    )
    assert make_plan(again).cost_s == pytest.approx(found[-1].cost_s, abs=1e-9)


def test_the_tasks_own_robot_and_one_that_is_not_there_are_left_out() -> None:
    trial = first_trial(task_for(SMALL, robot=SHORT), (SHORT, "nobody", "pr2"))
    assert trial.says.values["robot"] == "pr2"
    with pytest.raises(StopIteration):
        next(robots(task_for(SMALL, robot=SHORT), (SHORT, "nobody"), ignore))


def test_cloth_that_is_folded_in_part_is_not_carried_to_another_table() -> None:
    task = task_for(SMALL)
    begun = replace(task, start=replace(task.start, folds_done=(0,)))
    with pytest.raises(StopIteration):
        next(robots(begun, (SHORT,), ignore))


@pytest.mark.parametrize(("second_s", "offered"), [(29.5, ["pr2"]), (20.0, ["pr2", SHORT])])
def test_of_two_robots_the_later_is_offered_only_if_it_is_quicker_by_a_second(
    second_s: float, offered: list[str]
) -> None:
    search, kept = robots(task_for(SMALL, robot="ur5e-pair"), ("pr2", SHORT), ignore), []
    for cost_s in (30.0, second_s):
        trial = next(search)
        assert isinstance(trial, SuggestionTrial)
        with suppress(StopIteration):
            kept.append(search.send(cast(Plan, SimpleNamespace(cost_s=cost_s))))
    assert [one.change["robot"] for one in kept if isinstance(one, Suggestion)] == offered


def test_no_robot_is_tried_where_three_kinds_of_change_help_or_there_is_a_plan(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def none_asked(*_: Any) -> Any:
        raise AssertionError("a robot was looked for")

    with monkeypatch.context() as patch:
        patch.setattr(searching, "ENOUGH_KINDS", 0)
        patch.setattr(searching, "robots", none_asked)
        task = task_for(LONG, robot=SHORT, work_limit_s=0.5, time_limit_s=60.0)
        list(suggestions(task, other_robots=("pr2",)))
    monkeypatch.setattr("planner.explain.suggestion_robot.robot_card_file", none_asked)
    towel = task_for(load_garment("hand-towel"), work_limit_s=5.0, time_limit_s=60.0)
    assert list(suggestions(towel, other_robots=(SHORT,))) == []


def test_a_robot_that_needs_no_maps_has_its_turn_first(monkeypatch: pytest.MonkeyPatch) -> None:
    turns: list[str] = []

    def none(_: Task, names: Iterable[str], __: Any) -> Iterator[Any]:
        turns.extend(names)
        yield from ()

    monkeypatch.setattr(searching, "robots", none)
    task = task_for(LONG, robot=SHORT, work_limit_s=0.5, time_limit_s=60.0)
    list(suggestions(task, other_robots=("baxter", "panda-pair", "pr2")))
    assert turns == ["pr2", "baxter", "panda-pair"]


def test_a_robot_is_told_before_the_next_is_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    # The maps of the next may take a minute to build; whoever waits for a robot that can had to wait for them too.
    def prepared(name: str, _: Any) -> None:
        assert name == "pr2", "told too late"

    monkeypatch.setattr("planner.explain.suggestion_robot.prepare_robot", prepared)
    task = task_for(LONG, robot=SHORT, work_limit_s=2.0, time_limit_s=60.0)
    search = suggestions(task, other_robots=("pr2", "baxter"))
    assert next(one for one in search if one.kind == "robot").change["robot"] == "pr2"


def test_no_robot_is_loaded_where_no_time_is_left_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    # To load a robot takes seconds, which no limit of work counts: a search of 2 s took 9 s, and 30 s without maps.
    def never(name: str) -> Any:
        raise AssertionError(f"{name} was loaded")

    monkeypatch.setattr("planner.explain.suggestion_robot.robot_card_file", never)
    task = task_for(LONG, robot=SHORT, work_limit_s=2.0, time_limit_s=7.0)
    search = suggestions(task, other_robots=("pr2",))
    while True:
        try:
            next(search)
        except StopIteration as end:
            assert end.value is False, "what another robot can do is unknown"
            return


def test_the_building_of_maps_ends_with_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    clock, is_begun = FastClock(monkeypatch, "clock_s"), False

    def for_ever(_: str, progress: Any) -> None:
        nonlocal is_begun
        is_begun = True
        while True:
            clock.ahead_s += 0.5
            progress(0.5)

    monkeypatch.setattr("planner.explain.suggestion_robot.prepare_robot", for_ever)
    monkeypatch.setattr(searching, "_ROBOT_S", 0.0)
    task = task_for(LONG, robot=SHORT, work_limit_s=0.5, time_limit_s=60.0)
    list(suggestions(task))  # kernels are loaded, and what a search of so little work takes is known to be less
    search = suggestions(replace(task, limits=replace(task.limits, time_limit_s=6.0)), other_robots=("pr2",))
    while True:
        try:
            next(search)
        except StopIteration as end:
            assert end.value is False, "what the robot can do is unknown"
            break
    assert is_begun, "no robot was begun"
    assert clock.ahead_s < 7.0


def test_no_station_is_proposed_that_is_there_already() -> None:
    scene = replace(Scene(), stations=(*Scene().stations, ("far", Pose2(0.95, 0.0, math.pi))))
    first = next(stations(asked(towel(), scene)))
    assert isinstance(first, SuggestionTrial)
    assert [name for name, _ in first.task.scene.stations][-1] == "middle_left"
