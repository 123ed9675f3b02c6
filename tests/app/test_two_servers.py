"""Two servers on one PostgreSQL database, each in a process of its own, see what the other has."""

from pathlib import Path

import httpx

from tests.app.conftest import Served
from tests.app.document_requests import moved
from tests.app.samples import towel
from tests.databases import emptied
from tests.patience import PATIENCE_S, wait_until


def test_two_servers_on_one_database_see_what_each_other_has(tmp_path: Path, postgresql_server: str) -> None:
    url = emptied(postgresql_server)
    servers: list[Served] = []
    try:
        servers += [Served(tmp_path / name, 0, "--database", url) for name in ("a", "b")]
        with (
            httpx.Client(base_url=servers[0].url, timeout=PATIENCE_S) as first,
            httpx.Client(base_url=servers[1].url, timeout=PATIENCE_S) as second,
        ):
            made = first.post("/api/documents", json={"garment": towel()}).json()
            address = f"/api/documents/{made['id']}"
            assert made["id"] in {entry["id"] for entry in second.get("/api/documents").json()}
            assert second.get(address).json() == made

            edit = {"base_version": 1, "label": "Move", "drawing": moved(made, -0.01)}
            edited = second.put(f"{address}/drawing", json=edit)
            assert edited.status_code == 200
            late = first.put(f"{address}/drawing", json={**edit, "drawing": moved(made, -0.02)})
            assert late.status_code == 409
            assert late.json()["state"]["drawing"] == edited.json()["drawing"]
            undone = first.post(f"{address}/undo")
            assert undone.status_code == 200 and undone.json()["drawing"] == made["drawing"]

            planned = first.post("/api/plans", json={"garment": towel()}).json()
            assert second.get(f"/api/plans/{planned['id']}").json() == planned

            card = {**first.get("/api/robots/ur5e-single").json(), "name": "bench"}
            assert first.put("/api/robots/bench", json=card).status_code == 201
            wait_until(lambda: second.get("/api/robots/bench").status_code == 200)
            assert second.delete("/api/robots/bench").status_code == 204
            wait_until(lambda: first.get("/api/robots/bench").status_code == 404)

            asked = {"garments": [{"garment": towel()}], "limits": {"work_limit_s": 1.0}}
            job = first.post("/api/studies", json=asked).headers["location"]
            wait_until(lambda: second.get(job).json()["status"] == "done")
            report = second.get(job).json()["result"]["files"]["report_html"]
            assert second.get(report).text == first.get(report).text != ""

            assert second.delete(address).status_code == 204
            assert made["id"] not in {entry["id"] for entry in first.get("/api/documents").json()}
    finally:
        for server in servers:
            server.stop()
