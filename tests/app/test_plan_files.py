"""Plan files over REST: written, imported after a replay, refused with the step that fails; starts."""

import copy
from collections.abc import Callable
from typing import Any

import httpx
import pytest

from planner import Plan

pytestmark = pytest.mark.anyio

PLAN_FILE = "application/vnd.pleat.plan+json"


@pytest.fixture
async def file(client: httpx.AsyncClient) -> dict[str, Any]:
    made = (await client.post("/api/plans", json={"garment": "vest"})).json()
    answer = await client.get(f"/api/plans/{made['id']}/file")
    assert answer.status_code == 200 and answer.headers["content-type"] == PLAN_FILE
    found: dict[str, Any] = answer.json()
    return found


async def test_a_plan_file_is_served_by_url_or_accept_header(client: httpx.AsyncClient) -> None:
    made = (await client.post("/api/plans", json={"garment": "vest"})).json()
    by_address = await client.get(f"/api/plans/{made['id']}/file")
    by_accept = await client.get(f"/api/plans/{made['id']}", headers={"Accept": PLAN_FILE})
    plainly = await client.get(f"/api/plans/{made['id']}")
    assert by_address.json() == by_accept.json() and plainly.json() == made
    plan = Plan.from_dict(by_address.json())
    assert {"id": made["id"], **plan.answer()} == made


async def test_a_file_taken_back_is_the_same_plan(client: httpx.AsyncClient, file: dict[str, Any]) -> None:
    answer = await client.post("/api/plans/imports", json=file)
    assert answer.status_code == 200 and answer.json()["cost_s"] == file["cost_s"]
    again = (await client.get(f"/api/plans/{answer.json()['id']}/file")).json()
    assert again == file
    timeline = await client.get(f"/api/plans/{answer.json()['id']}/timeline", params={"rate_hz": 5})
    assert timeline.json()["samples"][-1]["t_s"] == file["cost_s"]


def hurried(file: dict[str, Any]) -> None:
    rows, times = file["trajectory"]["arms"]["positions"], file["trajectory"]["arms"]["times_s"]
    moment = next(number for number, t_s in enumerate(times) if t_s > file["steps"][1]["start_s"] + 4.0)
    rows[moment][3] += 0.8


def elsewhere(file: dict[str, Any]) -> None:
    file["steps"][1]["holdings"][0]["point"][0] += 0.05


def skipped(file: dict[str, Any]) -> None:
    for part in ("steps", "primitives"):
        del file[part][0]


def newer(file: dict[str, Any]) -> None:
    file["pleat_plan"] = 2


@pytest.mark.parametrize(
    ("spoil", "field", "told"),
    [
        (hurried, "steps[1].trajectory", "times as fast"),
        (elsewhere, "steps[1].holdings", "do not hold"),
        (skipped, "steps[0].before", "differs"),
        (newer, "pleat_plan", "newer than 1"),
        (lambda file: file.update(extra=1), "extra", "not a known field"),
        (lambda file: file.update(cost_s=1.0), "cost_s", "is not what follows"),
    ],
)
async def test_a_file_that_does_not_replay_is_refused_with_the_step(
    client: httpx.AsyncClient, file: dict[str, Any], spoil: Callable[[dict[str, Any]], None], field: str, told: str
) -> None:
    spoilt = copy.deepcopy(file)
    spoil(spoilt)
    answer = await client.post("/api/plans/imports", json=spoilt)
    assert answer.status_code == 422
    (error,) = answer.json()["errors"]
    assert error["field"] == field and told in error["message"]


async def test_a_plan_starts_where_it_is_told(client: httpx.AsyncClient) -> None:
    whole = (await client.post("/api/plans", json={"garment": "hand-towel"})).json()
    rest = await client.post("/api/plans", json={"garment": "hand-towel", "start": {"folds_done": [0]}})
    left_s = whole["cost_s"] - whole["primitives"][1]["start_s"]
    assert rest.json()["cost_s"] == pytest.approx(left_s)
    assert [step["fold"] for step in rest.json()["primitives"]] == [1, 2]


async def test_a_base_may_stand_anywhere_at_the_start(client: httpx.AsyncClient) -> None:
    start = {"base": {"x_m": -1.5, "y_m": 0.2, "yaw_rad": 0.1}}
    plan = (await client.post("/api/plans", json={"garment": "hand-towel", "start": start})).json()
    first = plan["primitives"][0]
    assert (first["kind"], first["from"], first["waypoints"][0]) == ("move", None, [-1.5, 0.2, 0.1])


@pytest.mark.parametrize(
    ("start", "field"),
    [
        ({"folds_done": [1]}, "start.folds_done[0]"),
        ({"folds_done": [0, 0]}, "start.folds_done[1]"),
        ({"folds_done": [7]}, "start.folds_done[0]"),
        ({"folds_done": "all"}, "start.folds_done"),
        ({"base": {"station": "nowhere"}}, "start.base.station"),
        ({"base": {"station": "front", "back_off_m": 3.0}}, "start.base.back_off_m"),
        ({"base": {}}, "start.base"),
        ({"held": [{"arm": "third", "point": [0.0, 0.0]}]}, "start.held[0].arm"),
        ({"held": [{"arm": "left"}]}, "start.held[0].point"),
        ({"somewhere": 1}, "start.somewhere"),
    ],
)
async def test_a_start_that_cannot_be_is_refused_by_field(
    client: httpx.AsyncClient, start: dict[str, Any], field: str
) -> None:
    answer = await client.post("/api/plans", json={"garment": "hand-towel", "start": start})
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["field"] == field
