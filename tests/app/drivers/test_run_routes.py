"""A run of a plan as a job, with the simulated driver."""

from typing import Any

import httpx
import pytest

from planner import Plan
from tests.app.test_job_routes import ended

pytestmark = pytest.mark.anyio


async def test_steps_of_a_plan_are_run_in_real_time_and_the_rest_from_there(
    client: httpx.AsyncClient, plan: Plan
) -> None:
    last = len(plan.steps) - 1
    begun = await client.post("/api/runs", json={"plan": plan.to_dict(), "from_step": last, "until_step": last + 1})
    assert begun.status_code == 202, begun.text
    job = await ended(client, begun.headers["location"])
    assert job["kind"] == "runs" and job["about"] == plan.garment.title
    assert (job["status"], job["result"]) == ("done", {"ended": "done", "done": last + 1, "why": ""})


async def test_a_run_can_be_stopped(client: httpx.AsyncClient, plan: Plan) -> None:
    begun = await client.post("/api/runs", json={"plan": plan.to_dict(), "speed": 0.05})
    path = begun.headers["location"]
    assert (await client.post(f"{path}/cancel")).json()["status"] == "cancelled"


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"from_step": -1}, "from_step"),
        ({"from_step": 99}, "from_step"),
        ({"until_step": 0}, "until_step"),
        ({"until_step": 99}, "until_step"),
        ({"speed": 1.5}, "speed"),
        ({"driver": "ur"}, "driver"),
    ],
)
async def test_a_run_that_cannot_be_is_refused_by_its_field(
    client: httpx.AsyncClient, plan: Plan, change: dict[str, Any], field: str
) -> None:
    answer = await client.post("/api/runs", json={"plan": plan.to_dict(), **change})
    assert answer.status_code == 422, answer.text
    assert [error["field"] for error in answer.json()["errors"]] == [field]
