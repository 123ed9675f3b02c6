"""Tasks as JSON: read back equal, and refused when invalid."""

import json
import subprocess
import sys
from dataclasses import replace
from typing import Any

import pytest

from planner import Limits, Scene, Task, WorldState, load_garment, make_plan
from planner.errors import FieldError, RequestError
from planner.geometry.pose import Pose2
from planner.planning.robot_task import task_for
from planner.task.scene import DEFAULT_STATIONS
from planner.task.task import VERSION, TaskOptions, at_station
from planner.task.world_state import BaseStop, HeldPoint

FRONT = BaseStop.at("front", DEFAULT_STATIONS["front"])
NAMES = ("t-shirt", "vest", "tie", "hand-towel", "tie-halved")

# Reads a task and prints it again; then whether anything was imported that compiles.
PROGRAM = """
import json, sys
from planner import Task

print(json.dumps(Task.from_dict(json.load(sys.stdin)).to_dict()))
print(json.dumps([name for name in ("numba", "pinocchio") if name in sys.modules]))
"""


def tasks() -> dict[str, Task]:
    """Return tasks such that every field differs from its default in one of them."""
    towel = load_garment("hand-towel")
    held = (HeldPoint("left", (0.1, 0.2)), HeldPoint("right", (0.3, 0.2)))
    elsewhere = BaseStop(None, 0.0, -1.2, 0.3, 0.1)
    limits = TaskOptions(comfort_radius_m=0.0, heuristic="zero", time_limit_s=3.0, work_limit_s=2.5, max_expanded=7)
    return {
        **{name: Task.of(load_garment(name)) for name in NAMES},
        "limited": Task.of(towel, **limits),
        "elsewhere": Task.of(towel, Scene(friction=0.5), start_station="left", placement=Pose2(-0.5, 0.1, 0.3)),
        "held": Task.of(towel, start=WorldState((), towel.placement, FRONT, held, 0.3)),
        "folded": Task.of(towel, start=WorldState((0,), towel.placement, elsewhere)),
    }


each_task = pytest.mark.parametrize("task", [pytest.param(task, id=name) for name, task in tasks().items()])


def data() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(json.dumps(tasks()["held"].to_dict()))
    return found


def refusal(given: Any) -> FieldError:
    with pytest.raises(FieldError) as caught:
        Task.from_dict(given)
    return caught.value


@each_task
def test_a_task_is_read_back_from_its_json_as_it_was(task: Task) -> None:
    read = Task.from_dict(json.loads(json.dumps(task.to_dict(), allow_nan=False)))
    assert read == task and hash(read) == hash(task)
    assert read.to_dict() == task.to_dict()


def test_a_task_is_read_in_a_process_without_the_planner() -> None:
    text = json.dumps(tasks()["folded"].to_dict())
    done = subprocess.run([sys.executable, "-c", PROGRAM], input=text, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    again, imported = [json.loads(line) for line in done.stdout.splitlines()]
    assert again == json.loads(text)
    assert imported == []


def test_what_is_left_out_is_as_usual() -> None:
    towel = load_garment("hand-towel")
    task = Task.of(towel)
    assert (task.scene, task.robot, task.limits) == (Scene(), "pr2", Limits())
    assert task.start == WorldState((), towel.placement, FRONT)


def test_a_task_is_moved_limited_and_put_into_another_scene() -> None:
    task = Task.of(load_garment("hand-towel"), start_station="left")
    there = Pose2(-0.4, 0.2, 1.0)
    assert task.at(there).start == replace(task.start, placement=there)
    assert task.within(0.01) == replace(task, limits=replace(task.limits, comfort_radius_m=0.01))
    moved = Scene(stations=(("left", Pose2(0.0, 0.9, -1.5)),))
    assert task.in_scene(moved).start.base == BaseStop("left", 0.0, 0.0, 0.9, -1.5)
    assert task.in_scene(Scene(stations=(("far", there),))).start.base == task.start.base


def test_a_base_that_has_backed_off_stands_behind_its_station() -> None:
    # Front looks along the table's x, from x = -0.95.
    base = at_station(Scene(), Pose2(0.0, 0.0, 0.0), "front", 0.25).base
    assert (base.station, base.back_off_m, base.x_m, base.y_m, base.yaw_rad) == ("front", 0.25, -1.2, 0.0, 0.0)


def test_a_newer_version_is_refused_by_its_number() -> None:
    error = refusal({**data(), "version": VERSION + 1})
    assert error.field == "version"
    assert str(VERSION + 1) in error.message and f"newer than {VERSION}" in error.message


@pytest.mark.parametrize("version", [None, 0, True, "1", 1.5])
def test_what_is_no_version_is_refused(version: object) -> None:
    assert refusal({**data(), "version": version}).field == "version"


@pytest.mark.parametrize(
    ("path", "field"),
    [
        ((), ""),
        (("garment",), "garment."),
        (("garment", "folds", 0), "garment.folds[0]."),
        (("scene",), "scene."),
        (("scene", "table"), "scene.table."),
        (("start",), "start."),
        (("start", "placement"), "start.placement."),
        (("start", "base"), "start.base."),
        (("start", "held", 1), "start.held[1]."),
        (("limits",), "limits."),
    ],
)
def test_an_unknown_field_is_refused_by_its_name_and_path(path: tuple[str | int, ...], field: str) -> None:
    given = data()
    here: Any = given
    for part in path:
        here = here[part]
    here["colour"] = 1
    error = refusal(given)
    assert (error.field, error.message) == (f"{field}colour", "is not a known field")


@pytest.mark.parametrize("name", sorted(data()))
def test_a_missing_field_is_refused_by_its_name(name: str) -> None:
    given = data()
    del given[name]
    error = refusal(given)
    assert (error.field, error.message) == (name, "is missing")


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"robot": 3}, "robot"),
        ({"garment": None}, "garment"),
        ({"scene": []}, "scene"),
        ({"start": {}}, "start.folds_done"),
        ({"limits": {"max_expanded": 0}}, "limits.max_expanded"),
        ({"limits": {"max_expanded": 1.5}}, "limits.max_expanded"),
        ({"limits": {"comfort_radius_m": 0.2}}, "limits.comfort_radius_m"),
        ({"limits": {"comfort_radius_m": True}}, "limits.comfort_radius_m"),
        ({"limits": {"heuristic": "magic"}}, "limits.heuristic"),
    ],
)
def test_a_field_of_another_kind_is_refused_by_its_path(changes: dict[str, Any], field: str) -> None:
    assert refusal({**data(), **changes}).field == field


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"start_station": "roof"}, "start_station"),
        ({"time_limit_s": 0.0}, "time_limit_s"),
        ({"time_limit_s": 61.0}, "time_limit_s"),
        ({"comfort_radius_m": -0.01}, "comfort_radius_m"),
        ({"heuristic": "magic"}, "heuristic"),
        ({"max_expanded": 0}, "max_expanded"),
    ],
)
def test_an_option_out_of_range_is_refused_by_its_name(options: dict[str, Any], field: str) -> None:
    with pytest.raises(RequestError) as caught:
        Task.of(load_garment("hand-towel"), **options)
    assert caught.value.field == field


@pytest.mark.parametrize("what", ["t-shirt", None, {"name": "t-shirt"}])
def test_what_is_neither_a_task_nor_a_garment_is_refused(what: object) -> None:
    with pytest.raises(RequestError) as caught:
        make_plan(what)  # type: ignore[arg-type]
    assert caught.value.field == "garment" and "load_garment" in caught.value.message


def test_folds_done_that_are_none_or_named_twice_are_refused() -> None:
    towel = load_garment("hand-towel")
    count = len(towel.folds)
    for done, number in (((count,), 0), ((0, -1), 1), ((0, 0), 1)):
        with pytest.raises(RequestError) as caught:
            Task.of(towel, start=WorldState(done, towel.placement, FRONT))
        assert caught.value.field == f"start.folds_done[{number}]"


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("comfort_radius", 0.1, "valid: placement, .*, comfort_radius_m"),
        ("scene", 3, "3 is no Scene"),
        ("placement", (0.0, 0.0, 0.0), r"\(0.0, 0.0, 0.0\) is no Pose2"),
        ("start", 3, "3 is no WorldState"),
        ("robot", None, "None is no name"),
    ],
)
def test_an_option_that_is_unknown_or_of_the_wrong_kind_is_named(name: str, value: Any, said: str) -> None:
    with pytest.raises(RequestError, match=said) as caught:
        task_for(load_garment("hand-towel"), **{name: value})
    assert caught.value.field == name
    with pytest.raises(RequestError, match=said):
        Task.of(load_garment("hand-towel"), **{name: value})
