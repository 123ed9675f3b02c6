import asyncio
from typing import Any

import httpx
import pytest

from app.api.job_answers import JobAnswer, JobEntry, JobsAnswer
from tests.app.conftest import Served
from tests.app.samples import towel
from tests.app.test_described_answers import assert_described
from tests.app.test_suggestion_routes import STUCK, events_in
from tests.patience import PATIENCE_S, wait_until_async

pytestmark = pytest.mark.anyio

MAP = {"garment": towel(), "step_m": 1.0, "time_limit_s": 60.0}
LONG = {"garment": "shirt", "step_m": 0.02, "time_limit_s": 60.0}


async def ended(client: httpx.AsyncClient, path: str) -> dict[str, Any]:
    async def at_end() -> dict[str, Any] | None:
        job: dict[str, Any] = (await client.get(path)).json()
        return None if job["status"] in ("queued", "running") else job

    return await wait_until_async(at_end)


async def test_a_map_as_a_job_is_followed_to_its_end_and_is_the_map_that_is_waited_for(
    client: httpx.AsyncClient,
) -> None:
    answer = await client.post("/api/jobs/placements", json=MAP)
    assert answer.status_code == 202
    assert_described(answer.json(), JobAnswer)
    assert answer.headers["location"] == f"/api/jobs/{answer.json()['id']}"
    path = answer.headers["location"]
    followed = await client.get(f"{path}/events")
    assert followed.headers["content-type"].startswith("text/event-stream")
    *progress, (last, job) = events_in(followed.text)
    assert {name for name, _ in progress} <= {"progress"}
    assert last == "end"
    for _, told in progress:
        assert_described(told, JobEntry)
    assert_described(job, JobAnswer)
    assert job == (await client.get(path)).json()
    again = await client.get(f"{path}/events", headers={"last-event-id": "1"})
    assert events_in(again.text) == [("end", job)]
    assert (job["kind"], job["about"], job["status"], job["progress"]) == ("placements", "My towel", "done", 1.0)
    assert job["result"] == (await client.post("/api/placements", json=MAP)).json()
    listed = (await client.get("/api/jobs")).json()
    assert_described(listed, JobsAnswer)
    assert [one["id"] for one in listed["jobs"]] == [job["id"]]
    assert "result" not in listed["jobs"][0]


async def test_suggestions_as_a_job_have_their_plans(client: httpx.AsyncClient) -> None:
    wanted = {**STUCK, "time_limit_s": 7.5}  # too short for another robot to be loaded
    answer = await client.post("/api/jobs/suggestions", json=wanted)
    job = await ended(client, answer.headers["location"])
    assert job["status"] == "done", job
    assert job["result"]["suggestions"]
    for one in job["result"]["suggestions"]:
        plan = (await client.get(f"/api/plans/{one['plan_id']}")).json()
        assert (plan["status"], plan["cost_s"]) == ("solved", one["cost_s"])


async def test_proposals_are_told_as_they_are_found(client: httpx.AsyncClient) -> None:
    towel = {"name": "napkin", "outline": [[0, 0], [0.4, 0], [0.4, 0.3], [0, 0.3]]}
    asked = {"garment": towel, "to": {"width_m": 0.2, "length_m": 0.15}, "count": 2, "untried": 1}
    path = (await client.post("/api/proposals", json=asked)).headers["location"]
    followed = events_in((await client.get(f"{path}/events")).text)
    name, job = followed[-1]
    assert (name, job["status"], job["kind"], job["about"]) == ("end", "done", "proposals", "napkin")
    found = job["result"]["proposals"]
    assert [one["status"] for one in found] == ["solved", "solved"]
    assert found[0]["cost_s"] <= found[1]["cost_s"]
    assert job["result"]["enumerated"] >= 2
    untried, *told = [data for name, data in followed if name == "found"]
    assert (untried["status"], untried["cost_s"], "plan_id" in untried) == ("untried", None, False)
    assert sorted(told, key=lambda one: one["cost_s"]) == found
    plan = (await client.get(f"/api/plans/{found[0]['plan_id']}")).json()
    assert (plan["status"], plan["cost_s"]) == ("solved", found[0]["cost_s"])


async def test_robots_are_compared_each_at_its_own_table(client: httpx.AsyncClient) -> None:
    towel = {"name": "napkin", "outline": [[0, 0], [0.2, 0], [0.2, 0.2], [0, 0.2]]}
    towel["folds"] = [{"name": "half", "kind": "blue", "start": [0.1, 0.2], "end": [0.1, 0.0]}]
    asked = {"garment": towel, "robots": ["so101-pair", "pr2"], "time_limit_s": 5.0}
    job = await ended(client, (await client.post("/api/comparisons", json=asked)).headers["location"])
    assert job["status"] == "done", job
    small, large = job["result"]["robots"]
    assert [small["robot"], large["robot"]] == ["so101-pair", "pr2"]
    plan = (await client.post("/api/plans", json={"garment": towel, "robot": "so101-pair"})).json()
    assert (small["status"], small["cost_s"]) == (plan["status"], plan["cost_s"])
    assert large["status"] == "solved" and 0.03 <= large["margin_m"] <= 0.1


async def test_a_cancelled_job_ends_for_those_who_follow_it(client: httpx.AsyncClient) -> None:
    path = (await client.post("/api/jobs/placements", json=LONG)).headers["location"]
    following = asyncio.create_task(client.get(f"{path}/events"))
    cancelled = (await client.post(f"{path}/cancel")).json()
    assert (cancelled["status"], cancelled["result"]) == ("cancelled", None)
    assert events_in((await following).text)[-1] == ("end", cancelled)


@pytest.mark.parametrize(
    ("kind", "body", "status", "field"),
    [
        ("placements", {"garment": "tie", "step_m": 0}, 422, "step_m"),
        ("placements", {"garment": "nothing"}, 404, None),
        ("suggestions", {}, 422, "garment"),
        ("suggestions", {"garment": "tie", "scene": {"friction": -1.0}}, 422, "scene.friction"),
        ("../comparisons", {"garment": "tie", "robots": ["pr2", "r2d2"]}, 422, "robots[1]"),
        ("../comparisons", {"garment": "tie", "robots": []}, 422, "robots"),
        ("placements", {"garment": towel(outline=[[0, 0], [0, 0], [0, 1]])}, 422, "garment.outline[1]"),
        ("suggestions", {"garment": towel(outline=[[0, 0], [0, 0], [0, 1]])}, 422, "garment.outline[1]"),
        ("../proposals", {"garment": "tie"}, 422, "to"),
        ("../proposals", {"garment": "tie", "to": "attic"}, 422, "to"),
        ("../proposals", {"garment": "tie", "to": {"width_m": 0.2}}, 422, "to.length_m"),
        ("../proposals", {"garment": "tie", "to": {"like": "nothing"}}, 404, None),
        ("../proposals", {"garment": "tie", "to": {"like": towel(folds=[])}}, 422, "to.like"),
        ("../proposals", {"garment": "tie", "to": "shelf", "count": 0}, 422, "count"),
        ("../proposals", {"garment": "tie", "to": "shelf", "face": "left"}, 422, "face"),
        ("../proposals", {"garment": "tie", "to": "shelf", "robot": "r2d2"}, 422, "robot"),
        ("nothing", {}, 405, None),
    ],
)
async def test_a_bad_request_starts_no_job(
    client: httpx.AsyncClient, kind: str, body: dict[str, Any], status: int, field: str | None
) -> None:
    answer = await client.post(f"/api/jobs/{kind}", json=body)
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    if field is not None:
        assert answer.json()["errors"][0]["field"] == field
    assert (await client.get("/api/jobs")).json() == {"jobs": [], "before": None}


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("GET", "/api/jobs/nothing"),
        ("GET", "/api/jobs/nothing/events"),
        ("POST", "/api/jobs/nothing/cancel"),
        ("GET", "/api/jobs?before=nothing"),
    ],
)
async def test_an_unknown_job_is_not_found(client: httpx.AsyncClient, method: str, path: str) -> None:
    answer = await client.request(method, path)
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"


@pytest.mark.long
def test_jobs_and_their_results_outlive_a_server_that_is_killed(served: Served) -> None:
    with httpx.Client(base_url=served.url, timeout=PATIENCE_S) as client:
        done = client.post("/api/jobs/placements", json=MAP).headers["location"]
        assert "event: end" in client.get(f"{done}/events").text
        before = client.get(done).json()
        interrupted = client.post("/api/jobs/placements", json=LONG).headers["location"]
    served.stop()
    served.start_again()
    with httpx.Client(base_url=served.url, timeout=PATIENCE_S) as client:
        assert client.get(done).json() == before
        again = client.get(interrupted).json()
        assert again["status"] in ("queued", "running")
        assert client.post(f"{interrupted}/cancel").json()["status"] == "cancelled"
