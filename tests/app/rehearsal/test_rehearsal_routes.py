import base64
import math
from typing import Any

import httpx
import pytest

from app.api.rehearsal_routes import TraceAnswer, TraceClothAnswer
from app.distribution import installing
from tests.app.rehearsal.towel import towel_plan
from tests.app.test_described_answers import assert_described
from tests.app.test_job_routes import ended
from tests.app.test_live import listening

NAPKIN = {
    "name": "small-napkin",
    "outline": [[0.0, 0.0], [0.3, 0.0], [0.3, 0.2], [0.0, 0.2]],
    "folds": [{"name": "half", "kind": "blue", "start": [0.3, 0.1], "end": [0.0, 0.1]}],
    "placement": {"x_m": -0.7, "y_m": 0.15, "yaw_rad": -1.5708},
}
"""A cloth of a fifth of a towel, so that it is soon rehearsed."""

pytestmark = pytest.mark.anyio


async def test_the_trace_of_a_run_can_be_read_by_its_id_and_shown_in_the_3d_view(client: httpx.AsyncClient) -> None:
    document = (await client.post("/api/documents", json={"garment": NAPKIN})).json()
    page = listening(client, document["id"])
    plan = (await page.until_planned(document["version"]))["plan"]
    begun = await client.post("/api/rehearsals", json={"plan": plan["id"]})
    job = await ended(client, begun.headers["location"])
    assert job["status"] == "done", job["message"]
    (run,) = job["result"]["runs"]
    assert [step["of_plan"] for step in run["steps"]] == [0]
    path = f"/api/rehearsals/traces/{run['trace']}"
    trace, cloth = (await client.get(path)).json(), (await client.get(f"{path}/cloth")).json()
    assert_described(trace, TraceAnswer)
    assert_described(cloth, TraceClothAnswer)
    (step,), (look, after) = trace["steps"], trace["pictures"]
    assert base64.b64decode(after["jpeg"])[:2] == b"\xff\xd8"
    assert step["of_plan"] == look["of_plan"] == 0
    assert base64.b64decode(look["jpeg"])[:2] == b"\xff\xd8"
    (points,) = cloth["steps"]
    assert len(points["found"]) == len(points["planned"]) > max(max(corners) for corners in cloth["triangles"])
    off_m = [math.dist(a, b) for a, b in zip(points["found"], points["planned"], strict=True)]
    assert 1000.0 * sum(off_m) / len(off_m) < run["steps"][0]["mean_mm"] + run["steps"][0]["slid_mm"] + 1.0
    page.say({"do": "show_trace", "trace": run["trace"]})
    page.say({"do": "show_trace", "trace": "unknown"})
    assert "there is no trace" in (await page.until("problem"))["detail"]
    opened = client._transport.app.state.workspace.opened(document["id"])  # type: ignore[attr-defined]
    assert opened.document.state.trace is not None
    page.say({"do": "show_trace", "trace": None})
    page.last.pop("problem")
    page.say({"do": "show_trace", "trace": "unknown"})
    await page.until("problem")
    assert opened.document.state.trace is None
    await page.hang_up()


async def test_an_unknown_trace_is_not_found(client: httpx.AsyncClient) -> None:
    for path in ("/api/rehearsals/traces/unknown", "/api/rehearsals/traces/unknown/cloth"):
        assert (await client.get(path)).status_code == 404


async def test_without_mujoco_it_is_said_what_to_install(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.distribution.is_installed", lambda _: None)
    answer = await client.post("/api/rehearsals", json={"plan": towel_plan().to_dict()})
    assert answer.status_code == 422
    (error,) = answer.json()["errors"]
    assert error["says"] == {"code": "library_missing", "library": "MuJoCo", "install": installing("physics")}
    assert error["message"].endswith(installing("physics"))


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"runs": 0}, "runs"),
        ({"seed": -1}, "seed"),
        ({"noise": "loud"}, "noise"),
        ({"speed": 2}, "speed"),
        ({"feedback": 1}, "feedback"),
    ],
)
async def test_a_rehearsal_that_cannot_be_is_refused_by_its_field(
    client: httpx.AsyncClient, change: dict[str, Any], field: str
) -> None:
    answer = await client.post("/api/rehearsals", json={"plan": towel_plan().to_dict(), **change})
    assert answer.status_code == 422, answer.text
    assert [error["field"] for error in answer.json()["errors"]] == [field]


async def test_an_unknown_plan_cannot_be_rehearsed(client: httpx.AsyncClient) -> None:
    assert (await client.post("/api/rehearsals", json={"plan": "unknown"})).status_code == 404


async def test_a_rehearsal_of_a_plan_file_is_a_job_that_can_be_cancelled(client: httpx.AsyncClient) -> None:
    answer = await client.post("/api/rehearsals", json={"plan": towel_plan().to_dict(), "runs": 50})
    assert answer.status_code == 202, answer.text
    path = answer.headers["location"]
    assert (await client.get(path)).json()["kind"] == "rehearsals"
    assert (await client.post(f"{path}/cancel")).status_code == 200
