import asyncio
import io
import json
from contextlib import closing
from pathlib import Path

import httpx
import pytest
from pyarrow import parquet

from app.job_kinds.studies import keep_study
from app.store.database import Database
from app.store.study_store import StudyStore, UnknownStudyError
from app.studies.results import Results
from app.studies.run_study import run_study, study_id
from app.studies.study import Study
from app.studies.table import CSV
from app.studies.workers import InProcess
from planner.robots.known_robots import shipped_path
from tests.app.samples import towel
from tests.app.studies.planners import fake_plan
from tests.app.studies.study_samples import content, study
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
    study_path = files["report_html"].removesuffix("/report.html")
    planned = await client.post(f"{study_path}/cells/5/plan")
    assert planned.status_code == 200 and planned.json()["status"] == "solved", planned.text
    assert planned.json()["cost_s"] == table.column("cost_s").to_pylist()[5]
    assert (await client.get(f"/api/plans/{planned.json()['id']}")).json() == planned.json()
    for cell in (8, 10**30):
        refused = await client.post(f"{study_path}/cells/{cell}/plan")
        assert refused.status_code == 422 and refused.json()["errors"][0]["field"] == "cell"
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


async def test_a_study_that_is_done_goes_from_its_folder_into_the_database(tmp_path: Path) -> None:
    folder, asked = tmp_path / "studies", study()
    with Results(folder / study_id(asked)) as results:
        results.begin(asked, resume=True)
        run_study(asked, results, InProcess(fake_plan), lambda _: None)
    (folder / ("0" * 32)).mkdir()  # one that is not done
    with closing(Database(tmp_path / "pleat.db")) as database:
        store = StudyStore(folder, database)
        assert keep_study(store, study_id(asked))
        assert not keep_study(store, "0" * 32)
        assert store.known() == {study_id(asked)}
        elsewhere = StudyStore(tmp_path / "elsewhere", database)
        assert elsewhere.file(study_id(asked), CSV) == (folder / study_id(asked) / CSV).read_bytes()
        assert Study.from_dict(json.loads(elsewhere.content(study_id(asked)))) == asked
        with pytest.raises(UnknownStudyError):
            elsewhere.file("0" * 32, CSV)


async def test_there_is_no_plan_of_an_unknown_study(client: httpx.AsyncClient) -> None:
    for study_path in ("0" * 32, "x", "%00"):
        assert (await client.post(f"/api/studies/{study_path}/cells/0/plan")).status_code == 404
