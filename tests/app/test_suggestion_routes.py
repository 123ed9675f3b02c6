import asyncio
import json
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import pytest
from typer.testing import CliRunner

from app.cli import cli
from planner import Task
from planner.explain.suggestion import Suggestion
from planner.robots.known_robots import robot_names
from tests.app.conftest import Served
from tests.app.job_works import suggest_and_hang
from tests.app.samples import towel
from tests.app.test_lanes import is_idle
from tests.patience import PATIENCE_S, wait_until

pytestmark = pytest.mark.anyio

FRONT_ONLY = {"stations": {"front": {"x_m": -0.95, "y_m": 0.0, "yaw_rad": 0.0}}}
FAR = {"x_m": 0.4, "y_m": 0.2, "yaw_rad": -1.5707963267948966}
STUCK = {"garment": towel(placement=FAR), "scene": FRONT_ONLY, "time_limit_s": 60.0, "work_limit_s": 1.0}
"""A search that ends by its work, however busy the machine is."""

LONG = {"time_limit_s": 60.0, "work_limit_s": 60.0}


def events_in(text: str) -> list[tuple[str, dict[str, Any]]]:
    """Return server-sent events by name, with their data."""
    events = []
    for block in text.strip().split("\n\n"):
        fields = dict(line.split(": ", 1) for line in block.splitlines() if not line.startswith(":"))
        if fields:
            events.append((fields["event"], json.loads(fields["data"])))
    return events


@pytest.mark.usefixtures("own_robot")
async def test_suggestions_come_as_events_and_done_comes_last(client: httpx.AsyncClient) -> None:
    began_s = time.perf_counter()
    answer = await client.post("/api/suggestions", json=STUCK)
    took_s = time.perf_counter() - began_s
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith("text/event-stream")
    *told, (last, done) = events_in(answer.text)
    found = [one for one in told if one[0] == "suggestion"]
    assert found
    assert {name for name, _ in told} == {"suggestion", "trying"}
    assert told[0][0] == "trying" and set(told[0][1]) == {"kind", "says"}
    assert last == "done"
    assert done["count"] == len(found)
    assert 0.0 < done["elapsed_s"] <= took_s
    assert isinstance(done["complete"], bool)
    assert set(found[0][1]) == {"kind", "is_assumption", "message", "says", "change", "size", "cost_s", "plan_id"}


@pytest.mark.usefixtures("own_robot")
async def test_a_change_merged_into_the_request_gives_the_plan_told(client: httpx.AsyncClient) -> None:
    answer = await client.post("/api/suggestions", json=STUCK)
    found = [data for name, data in events_in(answer.text) if name == "suggestion"]
    for one in found:
        told = (await client.get(f"/api/plans/{one['plan_id']}")).json()
        again = (await client.post("/api/plans", json={**STUCK, **one["change"]})).json()
        assert told["status"] == again["status"] == "solved"
        assert told["cost_s"] == again["cost_s"] == one["cost_s"]


@pytest.mark.usefixtures("own_robot")
async def test_the_answer_to_a_request_may_be_named_and_may_have_been_dropped(client: httpx.AsyncClient) -> None:
    answer = (await client.post("/api/plans", json=STUCK)).json()
    for known in (answer["id"], "dropped"):
        told = events_in((await client.post("/api/suggestions", params={"known": known}, json=STUCK)).text)
        assert any(name == "suggestion" for name, _ in told)


async def test_a_search_that_is_stuck_ends_soon_after_its_time(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.searches.suggest", suggest_and_hang)
    monkeypatch.setattr("planner.deadline.WALL_LEAST_S", 0.0)
    monkeypatch.setattr("app.api.suggestion_routes._GRACE_S", 0.1)
    answer = await client.post("/api/suggestions", json={**STUCK, "time_limit_s": 0.5})
    (trying, _), (last, done) = events_in(answer.text)
    assert (trying, last) == ("trying", "done")
    assert (done["count"], done["complete"]) == (0, False)


@pytest.mark.parametrize(
    ("body", "status", "field"),
    [
        ({}, 422, "garment"),
        ({"garment": towel(), "time_limit_s": 0}, 422, "time_limit_s"),
        ({"garment": towel(), "colour": "red"}, 422, "colour"),
        ({"garment": towel(), "start_station": "roof"}, 422, "start_station"),
        ({"garment": towel(), "robot": "nobody"}, 422, "robot"),
        ({"garment": towel(), "scene": {"friction": -1.0}}, 422, "scene.friction"),
        ({"garment": towel(outline=[[0, 0], [1, 0]])}, 422, "garment.outline"),
        ({"garment": "no-such-garment"}, 404, None),
    ],
)
async def test_a_bad_request_is_a_problem_and_no_stream(
    client: httpx.AsyncClient, body: dict[str, Any], status: int, field: str | None
) -> None:
    answer = await client.post("/api/suggestions", json=body)
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"
    if field is not None:
        assert answer.json()["errors"][0]["field"].startswith(field)


async def test_an_illegal_fold_is_named(client: httpx.AsyncClient) -> None:
    beside = {"name": "beside", "kind": "blue", "start": [3.0, 0.0], "end": [3.0, 1.0]}
    answer = await client.post("/api/suggestions", json={"garment": towel(folds=[beside])})
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["field"] == "garment.folds[0].start"


async def test_the_server_answers_others_while_it_searches(client: httpx.AsyncClient) -> None:
    lanes = client._transport.app.state.workspace.lanes  # type: ignore[attr-defined]
    search = asyncio.create_task(client.post("/api/suggestions", json={**STUCK, **LONG}))
    await asyncio.to_thread(wait_until, lambda: lanes.load()["searches"][1] > 0)
    assert (await client.get("/api/health")).status_code == 200
    assert not search.done()
    search.cancel()
    await asyncio.gather(search, return_exceptions=True)


@pytest.mark.long
async def test_when_the_client_goes_away_the_search_stops(served: Served) -> None:
    async with httpx.AsyncClient(base_url=served.url, timeout=PATIENCE_S) as browser:
        async with browser.stream("POST", "/api/suggestions", json={**STUCK, **LONG}) as stream:
            async for line in stream.aiter_lines():
                if line.startswith("event: suggestion"):
                    break
        await asyncio.to_thread(wait_until, partial(is_idle, served, "searches"))


async def test_the_map_of_placements_has_costs_and_a_best(client: httpx.AsyncClient) -> None:
    await client.put("/api/garments/my-towel", json=towel())
    wanted = {"garment": "my-towel", "step_m": 0.4, "time_limit_s": 20}
    answer = await client.post("/api/placements", json=wanted)
    assert answer.status_code == 200
    found = answer.json()
    assert set(found) == {"step_m", "cells", "best", "complete"}
    assert found["complete"] is True
    assert set(found["best"]) == {"x_m", "y_m", "yaw_rad", "cost_s"}
    assert found["best"]["cost_s"] == min(cell["cost_s"] for cell in found["cells"] if cell["cost_s"] is not None)


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({}, "garment"),
        ({"garment": "tie", "step_m": 0}, "step_m"),
        ({"garment": "tie", "time_limit_s": "10"}, "time_limit_s"),
    ],
)
async def test_a_bad_question_about_placements_names_the_parameter(
    client: httpx.AsyncClient, options: dict[str, Any], field: str
) -> None:
    answer = await client.post("/api/placements", json=options)
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["field"] == field


async def test_placements_of_an_unknown_garment_are_not_found(client: httpx.AsyncClient) -> None:
    assert (await client.post("/api/placements", json={"garment": "nothing"})).status_code == 404


def test_the_command_line_prints_suggestions_after_the_reasons(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.cli.plan.robot_names", lambda: ())  # to load another robot takes many seconds
    garment, scene = tmp_path / "towel.json", tmp_path / "scene.json"
    garment.write_text(json.dumps(STUCK["garment"]))
    scene.write_text(json.dumps(FRONT_ONLY))
    command = ["plan", str(garment), "--scene", str(scene), "--time-limit-s", "2", "--suggest"]
    result = CliRunner().invoke(cli, command)
    assert result.exit_code == 3
    assert "out_of_reach" in result.stderr
    for heading in ("kind", "what", "size", "cost", "assumption?", "placement"):
        assert heading in result.stdout
    assert "Found: " in result.stderr  # each as soon as it is found


def test_the_command_line_limits_the_work_of_its_suggestions_and_leaves_a_slow_machine_the_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Task] = []

    def noted(task: Task, *, other_robots: Sequence[str], **_: object) -> list[Suggestion]:
        assert other_robots == robot_names()
        asked.append(task)
        return []

    monkeypatch.setattr("app.cli.plan.suggestions", noted)
    garment = tmp_path / "towel.json"
    garment.write_text(json.dumps(towel()))
    for given, work_s, time_s in ((["--time-limit-s", "2"], 2.0, 12.0), ([], 10.0, 60.0)):
        result = CliRunner().invoke(cli, ["plan", str(garment), *given, "--suggest"])
        assert f"No change was found within {work_s:g} s of work." in result.stdout
        limits = asked.pop().limits
        assert (limits.work_limit_s, limits.time_limit_s) == (work_s, time_s)
