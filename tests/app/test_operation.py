import sqlite3
from contextlib import closing
from pathlib import Path

import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families

from app.distribution import installing
from tests.app.conftest import client_of
from tests.app.samples import towel

pytestmark = pytest.mark.anyio


async def samples(client: httpx.AsyncClient) -> dict[tuple[str, tuple[tuple[str, str], ...]], float]:
    answer = await client.get("/metrics")
    assert answer.headers["content-type"].startswith("text/plain")
    families = text_string_to_metric_families(answer.text)
    return {(one.name, tuple(sorted(one.labels.items()))): one.value for family in families for one in family.samples}


async def test_metrics_count_answers_by_route_and_never_by_made_up_paths(client: httpx.AsyncClient) -> None:
    for path in ("/api/garments/tie", "/api/garments/scarf", "/api/garments/none", "/made/up", "/static/icon.svg"):
        await client.get(path)
    found = await samples(client)
    route = ("route", "/api/garments/{name}")
    assert found["pleat_answers_total", (("method", "GET"), route, ("status", "200"))] == 2
    assert found["pleat_answers_total", (("method", "GET"), route, ("status", "404"))] == 1
    assert found["pleat_request_seconds_count", (("method", "GET"), route)] == 3
    routes = {dict(labels).get("route") for _, labels in found}
    assert not any(route and ("made" in route or "icon" in route or "tie" in route) for route in routes)
    assert found["process_resident_memory_bytes", ()] > 1e6


async def test_without_their_library_metrics_say_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.distribution.is_installed", lambda _: False)
    async with client_of(tmp_path) as client:
        answer = await client.get("/metrics")
    assert answer.status_code == 501
    assert installing("metrics") in answer.json()["detail"]


async def test_metrics_tell_the_work_of_each_lane(client: httpx.AsyncClient) -> None:
    before = await samples(client)
    assert (await client.post("/api/dag", json={"garment": towel()})).status_code == 200
    quick = (("lane", "quick"),)
    after = await samples(client)
    assert before["pleat_lane_ended_total", quick] == 0
    assert after["pleat_lane_waiting", quick] == 0
    lanes = {labels for name, labels in after if name == "pleat_lane_running"}
    assert lanes == {(("lane", name),) for name in ("quick", "files", "robots", "searches", "jobs", "live")}
    assert after["pleat_open_documents", ()] == 0


async def test_a_request_keeps_its_id_or_gets_one(client: httpx.AsyncClient) -> None:
    own = await client.get("/api/scene", headers={"x-request-id": "from-the.proxy_1"})
    assert own.headers["x-request-id"] == "from-the.proxy_1"
    ids = {
        (await client.get(path, headers={"x-request-id": given})).headers["x-request-id"]
        for path, given in (("/api/scene", ""), ("/nothing", "x" * 65), ("/api/scene", "a b"), ("/", "a;b"))
    }
    assert len(ids) == 4 and all(len(one) == 32 for one in ids)


async def test_health_says_what_is_well_and_what_is_not(client: httpx.AsyncClient, tmp_path: Path) -> None:
    well = (await client.get("/api/health")).json()
    assert well["status"] == "ok" and "version" in well and "problem" not in well
    assert well["checks"] == {"disk": "ok", "database": "ok", "workers": "ok"}


@pytest.mark.parametrize("table", ["documents", "document_steps", "shares", "plans", "jobs"])
async def test_health_tells_a_table_that_is_missing(client: httpx.AsyncClient, tmp_path: Path, table: str) -> None:
    assert (await client.get("/api/health")).json()["status"] == "ok"
    with closing(sqlite3.connect(tmp_path / "pleat.db")) as other:
        other.execute(f"DROP TABLE {table}")
    ill = (await client.get("/api/health")).json()
    assert ill["status"] == "degraded" and f"no such table: {table}" in ill["checks"]["database"]


async def test_health_tells_a_database_that_was_removed_or_takes_no_change(
    client: httpx.AsyncClient, tmp_path: Path
) -> None:
    assert (await client.get("/api/health")).json()["status"] == "ok"
    with closing(sqlite3.connect(tmp_path / "pleat.db")) as other:
        other.execute("CREATE TRIGGER no BEFORE UPDATE ON alembic_version BEGIN SELECT RAISE(ABORT, 'full'); END")
    assert "full" in (await client.get("/api/health")).json()["checks"]["database"]
    for path in tmp_path.glob("pleat.db*"):
        path.unlink()
    assert "removed" in (await client.get("/api/health")).json()["checks"]["database"]


async def test_health_tells_a_database_that_is_none(client: httpx.AsyncClient, tmp_path: Path) -> None:
    (tmp_path / "pleat.db").write_bytes(b"no database" * 1000)
    ill = (await client.get("/api/health")).json()
    assert ill["status"] == "degraded" and "not a database" in ill["problem"]
    assert ill["checks"]["database"] == ill["problem"] and ill["checks"]["disk"] == "ok"
