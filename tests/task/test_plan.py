"""Plans as JSON: read back equal, here and in a process without the planner, and refused when invalid."""

import json
import pickle
import subprocess
import sys
from collections.abc import Callable, Iterator
from copy import deepcopy
from functools import cache
from hashlib import sha256
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from planner import Plan, load_garment
from planner.errors import FieldError
from planner.motion.timeline import Timeline
from planner.task.plan import VERSION
from tests.planning.found import found_plan
from tests.replay.planned import shipped_plan
from tests.required import required
from tests.sweep import sweep

NAMES = ("t-shirt", "vest", "tie", "hand-towel", "tie-halved")
HELD = ("letter-towel", "big-towel")
"""Garments whose cloth is held from one step to the next: for a red fold, and out beyond the table's edge."""

RATE_HZ = 50.0

# Reads a plan from a file and prints what it is played like; then whether anything was imported that compiles.
PROGRAM = """
import json, sys
from hashlib import sha256
from pathlib import Path
from planner import Plan, Timeline

text = Path(sys.argv[1]).read_text()
plan = Plan.from_dict(json.loads(text))
assert plan.to_dict() == json.loads(text)
if plan.is_solved:
    for frame in Timeline.of(plan).samples(float(sys.argv[2])):
        cloth = sha256(frame.cloth.vertices.tobytes()).hexdigest()
        print(json.dumps([frame.to_dict(), frame.placement.to_dict(), cloth]))
print(json.dumps([name for name in ("numba", "pinocchio") if name in sys.modules]))
"""

each_name = pytest.mark.parametrize("name", NAMES)


def plan_of(name: str) -> Plan:
    return shipped_plan(name)


@cache
def text_of(name: str) -> str:
    return json.dumps(plan_of(name).to_dict(), allow_nan=False)


def data_of(name: str) -> dict[str, Any]:
    """Return a plan's JSON, which may be changed."""
    data: dict[str, Any] = json.loads(text_of(name))
    return data


def refusal(data: Any) -> FieldError:
    with pytest.raises(FieldError) as caught:
        Plan.from_dict(data)
    return caught.value


def played(plan: Plan) -> Iterator[Any]:
    """Yield every frame as JSON, the cloth by its hash."""
    for frame in Timeline.of(plan).samples(RATE_HZ):
        cloth = sha256(frame.cloth.vertices.tobytes()).hexdigest()
        yield [frame.to_dict(), frame.placement.to_dict(), cloth]


@pytest.mark.parametrize("name", (*NAMES, *HELD))
def test_a_plan_is_read_back_from_its_json_as_it_was(name: str) -> None:
    plan = plan_of(name)
    read = Plan.from_dict(json.loads(text_of(name)))
    assert read == plan
    assert read.to_dict() == plan.to_dict()
    assert read.answer() == plan.answer()


@sweep("name", NAMES, ("vest",))
def test_a_plan_is_read_in_a_process_without_the_planner_and_played_there_to_the_last_digit(
    name: str, tmp_path: Path
) -> None:
    path = tmp_path / "plan.json"
    path.write_text(text_of(name))
    command = [sys.executable, "-c", PROGRAM, str(path), str(RATE_HZ)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    *frames, imported = [json.loads(line) for line in done.stdout.splitlines()]
    assert imported == []
    plan = plan_of(name)
    assert frames == (list(played(plan)) if plan.is_solved else [])


def test_a_table_that_is_open_on_one_side_is_so_when_it_is_read_back() -> None:
    plan = plan_of("big-towel")
    assert any(step.after.held for step in plan.steps)
    tops = [segment["phase"]["cloth"]["top"] for segment in data_of("big-towel")["trajectory"]["segments"]]
    assert any(number is None for top in tops for corner in top for number in corner)
    read = Plan.from_dict(data_of("big-towel"))
    found = [segment.phase.cloth.top for segment in required(read.trajectory).segments]
    assert found == [segment.phase.cloth.top for segment in required(plan.trajectory).segments]


@each_name
def test_a_plan_is_the_same_when_it_comes_from_another_process(name: str) -> None:
    plan = plan_of(name)
    sent = pickle.dumps(plan)
    assert plan.final_layers, "what is worked out once is not sent along"
    assert pickle.loads(sent) == plan and len(pickle.dumps(plan)) == len(sent)


def test_a_plan_that_was_found_within_no_limits_is_one_too() -> None:
    plan = found_plan(load_garment("t-shirt"), max_expanded=1).plan
    assert (plan.status, plan.steps, plan.trajectory) == ("budget_exceeded", (), None)
    assert Plan.from_dict(json.loads(json.dumps(plan.to_dict()))) == plan


@each_name
def test_the_file_holds_all_that_rest_answers(name: str) -> None:
    plan = plan_of(name)
    assert plan.answer().items() <= plan.to_dict().items()
    assert "trajectory" not in plan.answer() and "task" not in plan.answer()


@each_name
def test_steps_follow_one_another_from_the_start_to_the_end(name: str) -> None:
    plan = plan_of(name)
    assert plan.state_after(-1) == plan.task.start
    assert [plan.state_after(number) for number in range(len(plan.steps))] == [step.after for step in plan.steps]
    assert plan.state_after(len(plan.steps) - 1) == plan.end
    for step, after in pairwise(plan.steps):
        assert after.before == step.after
        assert after.start_s == pytest.approx(step.end_s)
    if plan.is_solved:
        assert sorted(plan.end.folds_done) == list(range(len(plan.garment.folds)))
        assert plan.end.placement == plan.final_placement
        assert plan.end.held == ()


def test_the_state_after_a_step_that_a_plan_has_not_is_refused() -> None:
    plan = plan_of("hand-towel")
    for step in (-2, len(plan.steps)):
        with pytest.raises(FieldError) as caught:
            plan.state_after(step)
        assert caught.value.field == "after_step"


def test_a_newer_version_is_refused_by_its_number() -> None:
    newer = refusal({**data_of("hand-towel"), "pleat_plan": VERSION + 1})
    assert newer.field == "pleat_plan"
    assert str(VERSION + 1) in newer.message and f"newer than {VERSION}" in newer.message


@pytest.mark.parametrize("version", [None, 0, -1, True, "1", 1.5])
def test_what_is_no_version_is_refused(version: object) -> None:
    assert refusal({**data_of("hand-towel"), "pleat_plan": version}).field == "pleat_plan"


@pytest.mark.parametrize("data", [None, 3, "plan", [], [{}]])
def test_what_is_no_object_is_refused(data: object) -> None:
    assert "is not a JSON object" in refusal(data).message


def _at(data: Any, path: tuple[str | int, ...]) -> Any:
    for part in path:
        data = data[part]
    return data


@pytest.mark.parametrize(
    ("path", "field"),
    [
        ((), ""),
        (("task",), "task."),
        (("task", "garment"), "task.garment."),
        (("task", "scene"), "task.scene."),
        (("task", "start"), "task.start."),
        (("task", "start", "base"), "task.start.base."),
        (("task", "limits"), "task.limits."),
        (("steps", 1), "steps[1]."),
        (("steps", 0, "after"), "steps[0].after."),
        (("steps", 0, "grips", 0), "steps[0].grips[0]."),
        (("statistics",), "statistics."),
        (("trajectory",), "trajectory."),
        (("trajectory", "segments", 2), "trajectory.segments[2]."),
        (("trajectory", "segments", 0, "phase", "cloth"), "trajectory.segments[0].phase.cloth."),
        (("trajectory", "arms"), "trajectory.arms."),
        (("trajectory", "grippers", 1), "trajectory.grippers[1]."),
    ],
)
def test_an_unknown_field_is_refused_by_its_name_and_path(path: tuple[str | int, ...], field: str) -> None:
    data = data_of("hand-towel")
    _at(data, path)["colour"] = 1
    error = refusal(data)
    assert (error.field, error.message) == (f"{field}colour", "is not a known field")


def test_an_unknown_field_of_a_reason_is_refused_by_its_name_and_path() -> None:
    data = data_of("tie-halved")
    data["reasons"][1]["colour"] = 1
    assert refusal(data).field == "reasons[1].colour"


def test_a_missing_field_is_refused_by_its_name() -> None:
    for name in data_of("hand-towel"):
        data = data_of("hand-towel")
        del data[name]
        error = refusal(data)
        assert (error.field, error.message) == (name, "is missing")


def _later(data: dict[str, Any]) -> None:
    data["steps"][1]["start_s"] += 0.5


def _gone_on(data: dict[str, Any]) -> None:
    data["steps"][1]["before"]["placement"]["x_m"] += 0.1


def _begun_elsewhere(data: dict[str, Any]) -> None:
    data["steps"][0]["before"]["base"]["x_m"] -= 0.1


def _begun_folded(data: dict[str, Any]) -> None:
    data["task"]["start"]["folds_done"] = [0]


def _without_motion(data: dict[str, Any]) -> None:
    data["trajectory"] = None


@pytest.mark.parametrize(
    ("change", "field"),
    [
        (lambda data: data.update(cost_s=data["cost_s"] + 1.0), "cost_s"),
        (lambda data: data.update(cost_s=None), "cost_s"),
        (lambda data: data["primitives"].pop(), "primitives"),
        (lambda data: data["primitives"][0].update(duration_s=1.0), "primitives"),
        (lambda data: data["dag"].update(edges=[[1, 0]]), "dag"),
        (lambda data: data["final_placement"].update(x_m=0.0), "final_placement"),
        (lambda data: data.update(status="infeasible"), "trajectory"),
        (_gone_on, "steps[1].before"),
        (_later, "steps[1].start_s"),
        (_begun_elsewhere, "steps[0].before"),
        (_begun_folded, "steps[0].before"),
        (_without_motion, "trajectory"),
    ],
)
def test_what_does_not_follow_from_the_rest_is_refused_by_its_field(
    change: Callable[[dict[str, Any]], object], field: str
) -> None:
    data = data_of("hand-towel")
    assert len(data["steps"]) > 1
    whole = deepcopy(data)
    change(data)
    assert data != whole, "else nothing is tested"
    assert refusal(data).field == field


@pytest.mark.parametrize(
    ("change", "field"),
    [
        (lambda data: data.update(status="maybe"), "status"),
        (lambda data: data.update(is_exhaustive=1), "is_exhaustive"),
        (lambda data: data.update(reasons={}), "reasons"),
        (lambda data: data["statistics"].update(expanded="1"), "statistics.expanded"),
        (lambda data: data["statistics"].update(expanded=True), "statistics.expanded"),
        (lambda data: data["steps"][0].update(duration_s=True), "steps[0].duration_s"),
        (lambda data: data["steps"][0].update(duration_s=float("nan")), "steps[0].duration_s"),
        (lambda data: data["trajectory"].update(duration_s="6"), "trajectory.duration_s"),
        (lambda data: data["task"]["limits"].update(time_limit_s=0.0), "task.limits.time_limit_s"),
        (lambda data: data["task"]["scene"].update(friction=-1.0), "task.scene.friction"),
    ],
)
def test_a_field_of_another_kind_is_refused_by_its_path(change: Callable[[dict[str, Any]], object], field: str) -> None:
    data = data_of("hand-towel")
    change(data)
    assert refusal(data).field == field


def test_a_plan_from_before_velocities_were_kept_goes_straight_from_keyframe_to_keyframe() -> None:
    data = json.loads(json.dumps(data_of("hand-towel")))
    path = data["trajectory"]
    for owner, names in (
        (path["arms"], ["velocities"]),
        *((track, ["velocities", "opening_rates"]) for track in path["grippers"]),
        *((segment, ["rates", "base_rates"]) for segment in path["segments"]),
    ):
        for name in names:
            del owner[name]
    plan, now = Plan.from_dict(data), shipped_plan("hand-towel")
    assert plan.trajectory is not None and now.trajectory is not None and plan != now
    assert Plan.from_dict(json.loads(json.dumps(plan.to_dict()))) == plan
    arms = plan.trajectory.arms
    for number in range(0, len(arms.times_s) - 1, 7):
        start, end = arms.times_s[number : number + 2]
        middle = 0.5 * (arms.rows[number] + arms.rows[number + 1])
        assert arms.at(0.5 * (start + end)) == pytest.approx(middle)
        assert arms.velocities_at(start) == pytest.approx((arms.rows[number + 1] - arms.rows[number]) / (end - start))
    assert [frame.t_s for frame in Timeline.of(plan).samples(10.0)] == [
        frame.t_s for frame in Timeline.of(now).samples(10.0)
    ]
