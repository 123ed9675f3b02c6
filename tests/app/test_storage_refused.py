"""A disk that is full, read-only or failing: every request is answered with a problem, and nothing is half done."""

import sqlite3
from pathlib import Path
from typing import Any

import httpx
import pytest
from sqlalchemy import event, select, update

from app.drawing.edit import Edit
from app.store.database import Database
from app.store.document_repository import DocumentRepository
from app.store.schema import PlanRow, StepRow, Table
from tests.app.conftest import client_of
from tests.app.document_requests import created, moved, put
from tests.app.refused import refused
from tests.app.samples import towel
from tests.app.store.documents import kept_document
from tests.app.store.drafts import moved as moved_drawing
from tests.app.test_garbage import assert_problem
from tests.app.websocket import Listener

pytestmark = pytest.mark.anyio

STATUS_OF = {
    "EACCES": 403,
    "EPERM": 403,
    "EROFS": 403,
    "ENOSPC": 507,
    "EDQUOT": 507,
    "ENAMETOOLONG": 500,
    "EIO": 500,
}


def every_writing_request(client: httpx.AsyncClient, state: dict[str, Any]) -> dict[str, Any]:
    """Return all requests that write, by name."""
    path = f"/api/documents/{state['id']}"
    return {
        "commit": lambda: put(client, state, moved(state, -0.03)),
        "preview": lambda: put(client, state, moved(state, -0.03), phase="preview"),
        "garment": lambda: client.put(f"{path}/garment", json={"garment": "tie"}),
        "choose": lambda: client.post(f"{path}/playback", json={"do": "choose", "garment": "tie"}),
        "undo": lambda: client.post(f"{path}/undo"),
        "delete": lambda: client.delete(path),
        "create": lambda: client.post("/api/documents", json={"garment": towel()}),
        "copy": lambda: client.post("/api/documents", json={"copy_of": state["id"]}),
        "save garment": lambda: client.put("/api/garments/my-towel", json=towel(title="Another")),
        "remove garment": lambda: client.delete("/api/garments/my-towel"),
    }


def stored(client: httpx.AsyncClient) -> list[list[Any]]:
    """Return all rows of the database but the plans', which are found in the background."""
    database = client._transport.app.state.workspace.database  # type: ignore[attr-defined]
    with database.reading("look") as session:
        tables = [table for table in Table.metadata.sorted_tables if table is not PlanRow.__table__]
        return [[tuple(row) for row in session.execute(select(table))] for table in tables]


@pytest.mark.parametrize("name", STATUS_OF)
async def test_what_cannot_be_written_is_a_problem_and_is_not_done(
    client: httpx.AsyncClient, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    state = await created(client)
    state = (await put(client, state, moved(state, -0.01))).json()
    assert (await client.put("/api/garments/my-towel", json=towel())).status_code == 201
    rows = stored(client)
    with refused(monkeypatch, tmp_path, name):
        for ask in every_writing_request(client, state).values():
            problem = assert_problem(await ask(), STATUS_OF[name])
            assert str(tmp_path) not in problem["detail"]
        assert (await client.get(f"/d/{state['id']}")).status_code == 200
        assert (await client.get("/api/documents")).json()[0]["id"] == state["id"]
        assert (await client.get(f"/api/documents/{state['id']}")).json() == state
        health = (await client.get("/api/health")).json()
        assert health["status"] == "degraded" and "written" in health["problem"]
    assert stored(client) == rows
    assert "problem" not in (await client.get("/api/health")).json()
    assert (await put(client, state, moved(state, -0.03))).status_code == 200


async def test_a_document_that_could_not_be_removed_is_the_same_for_everybody(
    client: httpx.AsyncClient, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    state = await created(client)
    app = client._transport.app  # type: ignore[attr-defined]
    page = Listener(app, f"/api/documents/{state['id']}/live")
    await page.until("document")
    with refused(monkeypatch, tmp_path, "EROFS"):
        assert_problem(await client.delete(f"/api/documents/{state['id']}"), 403)
    changed = (await put(client, state, moved(state, -0.02))).json()
    assert await page.until("document", version=2) == changed
    assert (await client.delete(f"/api/documents/{state['id']}")).status_code == 204
    assert_problem(await client.get(f"/api/documents/{state['id']}"), 404)
    await page.hang_up()


async def test_in_a_read_only_folder_everything_is_shown_and_nothing_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = DocumentRepository(Database(tmp_path / "pleat.db"))
    (document_id, document), (spoilt, _) = kept_document(kept), kept_document(kept)
    document.edit(Edit("one", moved_drawing(1)))
    with kept._database.writing("spoil") as session:
        session.execute(update(StepRow).where(StepRow.document_id == spoilt).values(drawing="{"))
    with refused(monkeypatch, tmp_path, "EROFS", databases_too=False):
        async with client_of(tmp_path) as client:
            assert (await client.get("/")).headers["location"] == f"/d/{document_id}"
            state = (await client.get(f"/api/documents/{document_id}")).json()
            assert_problem(await client.get(f"/api/documents/{spoilt}"), 422)
            assert [one["id"] for one in (await client.get("/api/documents")).json() if one["problem"]] == [spoilt]
            for ask in every_writing_request(client, state).values():
                assert_problem(await ask(), 403)
            assert (await client.get(f"/api/documents/{document_id}")).json() == state


async def test_a_database_that_does_not_answer_is_a_problem(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    state = await created(client)
    workspace = client._transport.app.state.workspace  # type: ignore[attr-defined]
    workspace.close_unused(-1.0)

    def deny(*_: object) -> None:
        error = sqlite3.OperationalError("unable to open database file")
        error.sqlite_errorcode = sqlite3.SQLITE_CANTOPEN
        raise error

    event.listen(workspace.database.engine(), "do_execute", deny)
    problem = assert_problem(await client.get(f"/api/documents/{state['id']}"), 403)
    assert "unable to open" in problem["detail"]
    assert (await client.get("/api/health")).json()["checks"]["database"] != "ok"
    event.remove(workspace.database.engine(), "do_execute", deny)
    assert (await client.get(f"/api/documents/{state['id']}")).json() == state


async def test_what_the_system_refuses_anywhere_is_a_problem_too(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not only in the rooms that know of files."""

    def refuse(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device", "/secret/path")

    monkeypatch.setattr("app.api.plan_routes.fold_dag", refuse)
    answer = await client.post("/api/dag", json={"garment": "tie"})
    assert "secret" not in assert_problem(answer, 507)["detail"]
