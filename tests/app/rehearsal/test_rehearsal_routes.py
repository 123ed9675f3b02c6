from typing import Any

import httpx
import pytest

from tests.app.rehearsal.towel import towel_plan

pytestmark = pytest.mark.anyio


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
):
    answer = await client.post("/api/rehearsals", json={"plan": towel_plan().to_dict(), **change})
    assert answer.status_code == 422, answer.text
    assert [error["field"] for error in answer.json()["errors"]] == [field]


async def test_an_unknown_plan_cannot_be_rehearsed(client: httpx.AsyncClient):
    assert (await client.post("/api/rehearsals", json={"plan": "unknown"})).status_code == 404


async def test_a_rehearsal_of_a_plan_file_is_a_job_that_can_be_cancelled(client: httpx.AsyncClient):
    answer = await client.post("/api/rehearsals", json={"plan": towel_plan().to_dict(), "runs": 50})
    assert answer.status_code == 202, answer.text
    path = answer.headers["location"]
    assert (await client.get(path)).json()["kind"] == "rehearsals"
    assert (await client.post(f"{path}/cancel")).status_code == 200
