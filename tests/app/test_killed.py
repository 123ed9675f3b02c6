"""A server that is killed loses nothing that a client has seen."""

from pathlib import Path
from typing import Any

import httpx

from tests.app.conftest import Served
from tests.app.samples import towel
from tests.patience import PATIENCE_S


def change(client: httpx.Client, state: dict[str, Any], x_m: float, phase: str) -> dict[str, Any]:
    first, *others = state["drawing"]["outline"]
    drawing = {**state["drawing"], "outline": [{**first, "point": [x_m, 0.0]}, *others]}
    body = {"base_version": state["version"], "label": f"to {x_m}", "phase": phase, "drawing": drawing}
    answer = client.put(f"/api/documents/{state['id']}/drawing", json=body)
    assert answer.status_code == 200, answer.text
    changed: dict[str, Any] = answer.json()
    return changed


def test_after_kill_9_everything_is_there_that_was_answered(tmp_path: Path) -> None:
    first = Served(tmp_path)
    try:
        with httpx.Client(base_url=first.url, timeout=PATIENCE_S) as client:
            state = client.post("/api/documents", json={"garment": towel()}).json()
            client.get(f"/d/{state['id']}")
            state = change(client, state, -0.01, "commit")
            state = change(client, state, -0.02, "commit")
            state = client.post(f"/api/documents/{state['id']}/undo").json()
            dragged = change(client, state, -0.03, "preview")
            dragged = change(client, dragged, -0.04, "preview")
    finally:
        first.process.kill()
        first.process.communicate()
    second = Served(tmp_path, first.port)
    try:
        assert second.document == state["id"]
        with httpx.Client(base_url=second.url, timeout=PATIENCE_S) as client:
            found = client.get(f"/api/documents/{state['id']}").json()
            assert found["version"] == dragged["version"]
            assert found["drawing"] == dragged["drawing"]
            assert found["history"] == {"can_undo": "to -0.03", "can_redo": None}
            undone = client.post(f"/api/documents/{state['id']}/undo").json()
            assert undone["drawing"] == state["drawing"]
            assert undone["history"]["can_undo"] == "to -0.01"
    finally:
        second.stop()
