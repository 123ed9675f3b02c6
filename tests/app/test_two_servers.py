"""Two servers on one PostgreSQL database, each in a process of its own, see each other's documents."""

from pathlib import Path

import httpx

from tests.app.conftest import Served
from tests.app.document_requests import moved
from tests.app.samples import towel
from tests.databases import emptied
from tests.patience import PATIENCE_S


def test_two_servers_on_one_database_see_each_others_documents(tmp_path: Path, postgresql_server: str) -> None:
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

            assert second.delete(address).status_code == 204
            assert made["id"] not in {entry["id"] for entry in first.get("/api/documents").json()}
    finally:
        for server in servers:
            server.stop()
