import asyncio
import io

import httpx
import pytest
from pyarrow import parquet

from planner.robots.described_robot import shipped_path
from tests.app.samples import towel
from tests.app.studies.study_samples import content
from tests.app.test_job_routes import ended

pytestmark = pytest.mark.anyio


async def test_a_study_is_a_job_whose_files_are_served(client: httpx.AsyncClient) -> None:
    drawn = content(garments=[{"garment": towel()}, {"template": "towel", "measures": {"width_m": 0.3}}])
    answer = await client.post("/api/studies", json=drawn)
    assert answer.status_code == 202
    job = await ended(client, answer.headers["location"])
    assert (job["kind"], job["status"]) == ("studies", "done"), job
    assert (job["result"]["cells"], job["result"]["statuses"]["solved"]) == (8, 8)
    files = job["result"]["files"]
    table = parquet.read_table(io.BytesIO((await client.get(files["table_parquet"])).content))
    assert table.column("garment").to_pylist() == ["my-towel"] * 4 + ["towel 0.3"] * 4
    report = await client.get(files["report_html"])
    assert report.headers["content-type"] == "text/html; charset=utf-8"
    assert "default-src 'none'" in report.headers["content-security-policy"]
    assert "Who folds what" in report.text
    again = await ended(client, (await client.post("/api/studies", json=drawn)).headers["location"])
    assert again["result"] == job["result"]


async def test_a_bad_study_is_refused_with_its_field_before_there_is_a_job(client: httpx.AsyncClient) -> None:
    for changes, field in (
        ({"table": {"height_m": [50]}}, "table.height_m"),
        ({"garments": [{"name": "sock"}]}, "garments[0].name"),
        ({"garments": [{"name": "../../etc/passwd"}]}, "garments[0].name"),
        ({"garments": [{"file": "/etc/passwd"}]}, "garments[0].file"),
        ({"robots": ["pr2", str(shipped_path("so101-pair"))]}, "robots[1]"),
        ({"cells_max": 10_000_000}, "cells_max"),
        ({"colour": 1}, "colour"),
    ):
        answer = await client.post("/api/studies", json=content(**changes))
        assert answer.status_code == 422
        assert [error["field"] for error in answer.json()["errors"]] == [field]
    assert (await client.get("/api/jobs")).json()["jobs"] == []


async def test_files_that_are_not_a_studys_are_not_found(client: httpx.AsyncClient) -> None:
    paths = ("0" * 32 + "/report.html", "0" * 32 + "/results.sqlite", "../report.html", "%2e%2e/pleat.db")
    answers = await asyncio.gather(*(client.get(f"/api/studies/{path}") for path in paths))
    assert {answer.status_code for answer in answers} == {404}
