"""Priorities: short work never waits for long work, long work never longer than its limit."""

import asyncio
import signal
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.api.request_parsing import SHORTEST_S, TimeLimit
from app.jobs.job_pool import BusyError, JobPool
from app.jobs.lanes import SEARCHES_WAITING_MAX
from app.worker.template import PlannerNotLoadedError
from app.worker.workers import Workers
from bench.growth_cases import tabs_on_two_sides
from tests.app.conftest import REST, Served
from tests.app.processes import descendants, is_alive
from tests.app.samples import towel
from tests.patience import wait_until

pytestmark = pytest.mark.anyio

SLOW = {
    "garment": tabs_on_two_sides(40).to_dict(),
    "time_limit_s": 60,
    "work_limit_s": 60,
    "heuristic": "zero",
}
"""Every set of the tabs is a state: without a heuristic the search takes until its limit."""


@asynccontextmanager
async def endless_plans(client: httpx.AsyncClient, many: int) -> AsyncIterator[None]:
    """Request some plans, each of which takes longer than any test waits."""
    lanes = client._transport.app.state.workspace.lanes  # type: ignore[attr-defined]
    tasks = [asyncio.create_task(client.post("/api/plans", json=SLOW)) for _ in range(many)]
    await asyncio.to_thread(wait_until, lambda: len(lanes.searches._open) >= many or any(task.done() for task in tasks))
    try:
        yield
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def test_short_work_is_answered_while_all_searches_are_taken(client: httpx.AsyncClient) -> None:
    document = (await client.post("/api/documents", json={"garment": towel()})).json()
    path = f"/api/documents/{document['id']}"
    edit = {"base_version": document["version"], "drawing": document["drawing"]}
    async with endless_plans(client, 8), asyncio.timeout(30.0):
        assert (await client.post("/api/dag", json={"garment": "t-shirt"})).status_code == 200
        assert (await client.put(f"{path}/drawing", json=edit)).status_code == 200
        for part in ("steps", "quick-fixes", "overlays?station=front&show=slip"):
            assert (await client.get(f"{path}/{part}")).status_code == 200
        drawing = (
            b'<svg xmlns="http://www.w3.org/2000/svg" width="10cm" height="10cm"><path d="M0 0h90v90h-90z"/></svg>'
        )
        assert (await client.post("/api/imports?filename=a.svg&units=mm", content=drawing)).status_code == 200


async def test_a_plan_whose_time_is_up_before_its_turn_is_told_when_to_come_again(client: httpx.AsyncClient) -> None:
    async with endless_plans(client, 8), asyncio.timeout(30.0):
        for path in ("plans", "suggestions", "placements"):
            body = {"garment": "hand-towel", "time_limit_s": 0.1}
            answer = await client.post(f"/api/{path}", json=body)
            assert answer.status_code == 503, path
            assert answer.headers["content-type"] == "application/problem+json"
            assert int(answer.headers["retry-after"]) >= 1


async def test_a_full_queue_is_told_at_once(client: httpx.AsyncClient) -> None:
    lanes = client._transport.app.state.workspace.lanes  # type: ignore[attr-defined]
    async with endless_plans(client, SEARCHES_WAITING_MAX + lanes.searches._workers), asyncio.timeout(30.0):
        answer = await client.post("/api/plans", json={"garment": "hand-towel", "time_limit_s": 60})
        assert answer.status_code == 503
        assert int(answer.headers["retry-after"]) >= 1
    async with asyncio.timeout(30.0):
        assert (await client.post("/api/plans", json={"garment": "hand-towel"})).status_code == 200


async def test_where_the_planner_cannot_be_loaded_every_search_ends_with_that(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise PlannerNotLoadedError

    monkeypatch.setattr(Workers, "run", refuse)
    for path in ("plans", "suggestions", "placements"):
        answer = await client.post(f"/api/{path}", json={"garment": "hand-towel"})
        assert answer.status_code == 503, path
        assert answer.json()["detail"] == "the planner could not be loaded; the server's log says why"


def test_the_time_of_a_request_runs_while_it_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now_s)
    limit = TimeLimit(5.0)
    now_s = 103.0
    assert limit.left_s == pytest.approx(2.0)
    now_s = 200.0
    assert limit.left_s == SHORTEST_S


def test_a_queue_has_an_end_and_what_was_stopped_makes_room() -> None:
    pool = JobPool(workers=1, waiting_max=1)

    running = pool.start(wait_until)
    wait_until(running.future.running)
    waiting = pool.start(wait_until)
    with pytest.raises(BusyError) as refused:
        pool.start(wait_until)
    assert refused.value.retry_after_s >= 1
    waiting.stop()
    pool.start(wait_until).stop()
    pool.close()


def is_running(server: Served, lane: str) -> bool:
    """Return whether a server's lane has work."""
    return f'pleat_lane_running{{lane="{lane}"}} 0.0' not in REST.get(f"{server.url}/metrics").text


def is_idle(server: Served, lane: str) -> bool:
    return not is_running(server, lane)


async def test_a_client_that_goes_away_ends_the_work_for_it_and_the_workers_stay(served: Served) -> None:
    polygon = " ".join(f"{(i * 7919) % 100_003} {(i * 104_729) % 99_991}" for i in range(150_000))
    knot = f'<svg xmlns="http://www.w3.org/2000/svg"><path d="M {polygon} Z"/></svg>'.encode()[: 2 << 20]
    endless = (("files", "imports?filename=a.svg&units=mm", {"content": knot}), ("searches", "plans", {"json": SLOW}))
    async with httpx.AsyncClient(base_url=served.url, timeout=120.0) as client:
        assert (await client.post("/api/plans", json={"garment": "hand-towel"})).status_code in (200, 503)
        warm = descendants(served.process.pid)
        for lane, path, body in endless:
            sent = asyncio.create_task(client.post(f"/api/{path}", **body))
            await asyncio.to_thread(wait_until, partial(is_running, served, lane))
            sent.cancel()
            await asyncio.gather(sent, return_exceptions=True)
            await asyncio.to_thread(wait_until, partial(is_idle, served, lane))
            assert len(descendants(served.process.pid)) <= len(warm), path


def post_and_leave(url: str, body: dict[str, Any]) -> None:
    with suppress(httpx.ReadTimeout):
        httpx.post(url, timeout=1.0, **body)


@pytest.mark.parametrize("end", [pytest.param(signal.SIGINT, marks=pytest.mark.long), signal.SIGTERM, signal.SIGKILL])
def test_no_process_outlives_the_server(tmp_path: Path, end: signal.Signals) -> None:
    server = Served(tmp_path)
    try:
        post_and_leave(f"{server.url}/api/dag", {"json": {"garment": "tie"}})
        with httpx.Client(timeout=0.2) as client, suppress(httpx.ReadTimeout):
            client.post(f"{server.url}/api/plans", json=SLOW)
        below = descendants(server.process.pid)
        assert below
        server.process.send_signal(end)
        server.process.communicate(timeout=30.0)
        wait_until(lambda: not any(is_alive(pid) for pid in below))
    finally:
        server.stop()
