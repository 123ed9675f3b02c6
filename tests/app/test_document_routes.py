import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.app.samples import towel
from tests.app.test_garbage import BODIES, assert_problem

pytestmark = pytest.mark.anyio

HALF = {"name": "half", "kind": "blue", "start": {"point": [0.4, 0.15]}, "end": {"point": [0.0, 0.15]}}


async def created(client: httpx.AsyncClient, **changes: Any) -> dict[str, Any]:
    answer = await client.post("/api/documents", json={"garment": towel(**changes)})
    assert answer.status_code == 201, answer.text
    state: dict[str, Any] = answer.json()
    assert answer.headers["location"] == f"/d/{state['id']}"
    return state


def moved(state: dict[str, Any], x_m: float) -> dict[str, Any]:
    """A state's drawing with its first corner at another x."""
    drawing = state["drawing"]
    first, *others = drawing["outline"]
    return {**drawing, "outline": [{**first, "point": [x_m, first["point"][1]]}, *others]}


async def put(client: httpx.AsyncClient, state: dict[str, Any], drawing: object, **request: Any) -> httpx.Response:
    body = {"base_version": state["version"], "label": "Move", "drawing": drawing, **request}
    return await client.put(f"/api/documents/{state['id']}/drawing", json=body)


async def test_a_new_document_has_its_folds_tied_and_its_cloth_step_by_step(client: httpx.AsyncClient) -> None:
    state = await created(client)
    assert state["version"] == 1
    assert state["problems"] == []
    assert state["history"] == {"can_undo": None, "can_redo": None}
    assert state["gesture"] is None
    fold = state["drawing"]["folds"][0]
    assert fold["start"]["on"] == {"kind": "edge", "from": "v1", "to": "v2", "fraction": 0.5}
    assert state["solved"] == [{"fold": "f0", "status": "legal", "start": [0.4, 0.15], "end": [0.0, 0.15]}]
    assert len(state["steps"]) == 2
    assert state["garment"]["folds"][0]["start"] == [0.4, 0.15]
    assert (await client.get(f"/api/documents/{state['id']}")).json() == state


async def test_a_blank_document_is_an_honest_one(client: httpx.AsyncClient) -> None:
    state = (await client.post("/api/documents", json={})).json()
    assert state["drawing"]["outline"] == []
    assert [problem["code"] for problem in state["problems"]] == ["outline_unfinished"]


async def test_a_document_can_be_drawn_from_nothing(client: httpx.AsyncClient) -> None:
    state = (await client.post("/api/documents", json={})).json()
    corners = [{"point": point} for point in ([0, 0], [0.4, 0], [0.4, 0.3], [0, 0.3])]
    state = (await put(client, state, {**state["drawing"], "outline": corners})).json()
    assert state["problems"] == []
    assert [corner["id"] for corner in state["drawing"]["outline"]] == ["v0", "v1", "v2", "v3"]
    state = (await put(client, state, {**state["drawing"], "folds": [HALF]}, label="Draw fold")).json()
    assert state["solved"][0]["status"] == "legal"
    assert state["history"]["can_undo"] == "Draw fold"


async def test_a_copy_is_another_document(client: httpx.AsyncClient) -> None:
    state = await created(client)
    copy = (await client.post("/api/documents", json={"copy_of": state["id"]})).json()
    assert copy["id"] != state["id"]
    assert copy["drawing"] == state["drawing"]
    await put(client, copy, moved(copy, -0.02))
    assert (await client.get(f"/api/documents/{state['id']}")).json() == state


async def test_documents_are_listed_and_removed(client: httpx.AsyncClient) -> None:
    one, other = await created(client), await created(client, title="Other")
    entries = (await client.get("/api/documents")).json()
    assert {entry["id"]: entry["title"] for entry in entries} == {one["id"]: "My towel", other["id"]: "Other"}
    assert set(entries[0]) == {"id", "title", "name", "changed_at", "problem"}
    assert (await client.delete(f"/api/documents/{one['id']}")).status_code == 204
    for answer in (
        await client.get(f"/api/documents/{one['id']}"),
        await client.delete(f"/api/documents/{one['id']}"),
        await put(client, one, one["drawing"]),
        await client.get(f"/viser/{one['id']}/"),
    ):
        assert_problem(answer, 404)
    assert [entry["id"] for entry in (await client.get("/api/documents")).json()] == [other["id"]]


async def test_a_gesture_is_one_step_and_undo_and_redo_go_to_and_fro(client: httpx.AsyncClient) -> None:
    state = await created(client)
    dragged = (await put(client, state, moved(state, -0.01), phase="preview")).json()
    assert dragged["gesture"] == "Move"
    assert dragged["history"]["can_undo"] is None
    dropped = (await put(client, dragged, moved(state, -0.02), phase="commit")).json()
    assert dropped["gesture"] is None
    assert dropped["history"]["can_undo"] == "Move"
    undone = (await client.post(f"/api/documents/{state['id']}/undo")).json()
    assert undone["drawing"] == state["drawing"]
    assert undone["history"] == {"can_undo": None, "can_redo": "Move"}
    redone = (await client.post(f"/api/documents/{state['id']}/redo", json={"base_version": undone["version"]})).json()
    assert redone["drawing"] == dropped["drawing"]
    assert [state["version"] for state in (dragged, dropped, undone, redone)] == [2, 3, 4, 5]


async def test_a_cancel_needs_no_drawing(client: httpx.AsyncClient) -> None:
    state = await created(client)
    dragged = (await put(client, state, moved(state, -0.01), phase="preview")).json()
    cancel = {"base_version": dragged["version"], "phase": "cancel"}
    cancelled = (await client.put(f"/api/documents/{state['id']}/drawing", json=cancel)).json()
    assert cancelled["drawing"] == state["drawing"]
    assert cancelled["history"] == {"can_undo": None, "can_redo": None}


async def test_a_change_of_an_old_version_is_a_conflict_that_has_the_current_state(client: httpx.AsyncClient) -> None:
    state = await created(client)
    current = (await put(client, state, moved(state, -0.01))).json()
    problem = assert_problem(await put(client, state, moved(state, -0.02)), 409)
    assert problem["state"] == current
    for way in ("undo", "redo"):
        old = {"base_version": state["version"]}
        assert_problem(await client.post(f"/api/documents/{state['id']}/{way}", json=old), 409)


async def test_what_is_wrong_with_a_drawing_is_kept_and_told_of(client: httpx.AsyncClient) -> None:
    state = await created(client)
    spoilt = (await put(client, state, moved(state, 0.5))).json()
    assert spoilt["drawing"]["outline"][0]["point"] == [0.5, 0.0]
    (problem,) = spoilt["problems"]
    assert set(problem) == {"code", "field", "message", "fold", "points", "lines"}
    assert problem["code"] == "outline_crosses"
    assert (await client.get(f"/api/documents/{state['id']}")).json() == spoilt


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"drawing": None}, "drawing"),
        ({"drawing": 3}, "drawing"),
        ({"drawing": {}}, "drawing.name"),
        ({"phase": "later"}, "phase"),
        ({"base_version": "1"}, "base_version"),
        ({"base_version": 0}, "base_version"),
        ({"label": "x" * 201}, "label"),
        ({"colour": "red"}, "colour"),
    ],
)
async def test_a_request_that_is_none_is_refused_by_its_field(
    client: httpx.AsyncClient, change: dict[str, Any], field: str
) -> None:
    state = await created(client)
    problem = assert_problem(await put(client, state, **{"drawing": state["drawing"], **change}), 422)
    assert problem["errors"][0]["field"] == field
    assert (await client.get(f"/api/documents/{state['id']}")).json() == state


async def test_a_wrong_field_of_a_drawing_is_named_from_the_request_on(client: httpx.AsyncClient) -> None:
    state = await created(client)
    wrong = moved(state, 11.0)
    problem = assert_problem(await put(client, state, wrong), 422)
    assert problem["errors"][0]["field"] == "drawing.outline[0].point[0]"
    problem = assert_problem(await put(client, state, {**state["drawing"], "scene": {"friction": -1.0}}), 422)
    assert problem["errors"][0]["field"] == "drawing.scene.friction"


@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES.keys())
@pytest.mark.parametrize("path", ["drawing", "garment", "undo", "playback", "crease", ""])
async def test_a_body_that_cannot_be_read_is_a_problem(client: httpx.AsyncClient, path: str, body: bytes) -> None:
    state = await created(client)
    method = "PUT" if path in ("drawing", "garment") else "POST"
    address = f"/api/documents/{state['id']}/{path}" if path else "/api/documents"
    if path == "undo" and not body:
        return
    answer = await client.request(method, address, content=body, headers={"content-type": "application/json"})
    assert assert_problem(answer, 422)["errors"]


@pytest.mark.parametrize("document_id", ["nothing", "abcdefgh", "..%2fsettings", "%00", "a" * 300])
async def test_unknown_documents_are_not_found(client: httpx.AsyncClient, document_id: str) -> None:
    body = {"base_version": 1, "phase": "cancel"}
    for answer in (
        await client.get(f"/api/documents/{document_id}"),
        await client.get(f"/api/documents/{document_id}/steps"),
        await client.delete(f"/api/documents/{document_id}"),
        await client.put(f"/api/documents/{document_id}/drawing", json=body),
        await client.post(f"/api/documents/{document_id}/undo"),
        await client.post(f"/api/documents/{document_id}/playback", json={"do": "pause"}),
        await client.post("/api/documents", json={"copy_of": document_id.replace("%2f", "/")}),
    ):
        assert_problem(answer, 404)


async def test_another_garment_is_one_step_in_the_same_scene(client: httpx.AsyncClient) -> None:
    state = await created(client)
    drawing = {**state["drawing"], "scene": {"friction": 0.5}}
    state = (await put(client, state, drawing)).json()
    path = f"/api/documents/{state['id']}/garment"
    opened = (await client.put(path, json={"garment": "tie", "base_version": state["version"]})).json()
    assert opened["drawing"]["name"] == "tie"
    assert opened["drawing"]["scene"]["friction"] == 0.5
    assert opened["history"]["can_undo"] == "Open Tie"
    assert (await client.post(f"/api/documents/{state['id']}/undo")).json()["drawing"] == state["drawing"]
    assert_problem(await client.put(path, json={"garment": "tie", "base_version": 1}), 409)
    assert_problem(await client.put(path, json={"garment": "nothing"}), 404)
    problem = assert_problem(await client.put(path, json={"garment": towel(outline=[[0, 0]])}), 422)
    assert problem["errors"][0]["field"] == "garment.outline"


async def test_a_fold_by_grab_and_drop_can_be_drawn_as_it_is_answered(client: httpx.AsyncClient) -> None:
    """After the half, the left side onto the right: over x = 0.2, from the crease to the edges."""
    state = await created(client)
    grab = {"after": 1, "kind": "blue", "grab": {"from": [0.0, 0.2], "to": [0.4, 0.2]}}
    answer = (await client.post(f"/api/documents/{state['id']}/crease", json=grab)).json()
    assert set(answer) == {"start", "end", "moving", "landed"}
    fold = {"name": "", "kind": "blue", "start": answer["start"], "end": answer["end"]}
    drawing = {**state["drawing"], "folds": [*state["drawing"]["folds"], fold]}
    drawn = (await put(client, state, drawing)).json()
    assert drawn["solved"][1] == {"fold": "f1", "status": "legal", "start": [0.2, 0.15], "end": [0.2, 0.3]}
    assert drawn["steps"][1]["landed"] == answer["landed"]


@pytest.mark.parametrize(
    ("request_body", "field"),
    [
        ({}, "grab"),
        ({"grab": {"from": [0, 0], "to": [0, 0.3]}, "line": {"start": [0, 0], "end": [1, 1]}}, "grab"),
        ({"grab": {"from": [0.2, 0.2]}}, "grab.to"),
        ({"grab": {"from": [5, 5], "to": [0, 0.3]}}, "grab.from"),
        ({"line": {"start": [0, 0], "end": [0, 0]}}, "line.end"),
        ({"line": {"start": [0, 5], "end": [1, 5]}}, "line"),
        ({"after": 2, "grab": {"from": [0, 0], "to": [0, 0.3]}}, "after"),
        ({"after": -1, "grab": {"from": [0, 0], "to": [0, 0.3]}}, "after"),
    ],
)
async def test_why_a_fold_cannot_be_placed(client: httpx.AsyncClient, request_body: dict[str, Any], field: str) -> None:
    state = await created(client)
    problem = assert_problem(await client.post(f"/api/documents/{state['id']}/crease", json=request_body), 422)
    assert problem["errors"][0]["field"] == field


async def test_the_layers_of_each_step_lie_bottom_to_top(client: httpx.AsyncClient) -> None:
    state = await created(client)
    answer = (await client.get(f"/api/documents/{state['id']}/steps")).json()
    assert answer["version"] == 1
    spread, halved = (step["layers"] for step in answer["steps"])
    assert [(layer["face"], layer["moved"]) for layer in spread] == [("front", False)]
    assert [(layer["face"], layer["moved"]) for layer in halved] == [("front", False), ("back", True)]


async def test_playback_is_obeyed_by_post_too(client: httpx.AsyncClient) -> None:
    state = await created(client)
    answer = await client.post(f"/api/documents/{state['id']}/playback", json={"do": "speed", "speed": 2.0})
    assert answer.json()["speed"] == 2.0
    assert_problem(await client.post(f"/api/documents/{state['id']}/playback", json={"do": "dance"}), 422)


async def test_the_first_page_leads_to_the_document_opened_last(client: httpx.AsyncClient) -> None:
    first = (await client.get("/")).headers["location"]
    state = (await client.get(f"/api/documents/{first.rpartition('/')[2]}")).json()
    assert state["drawing"]["name"] == "t-shirt"
    other = await created(client)
    assert (await client.get(f"/d/{other['id']}")).status_code == 200
    assert (await client.get("/")).headers["location"] == f"/d/{other['id']}"
    assert (await client.get(first)).status_code == 200
    assert (await client.get("/")).headers["location"] == first


async def test_the_page_of_a_document_that_is_not_there_says_so(client: httpx.AsyncClient) -> None:
    answer = await client.get("/d/nothing")
    assert answer.status_code == 404
    assert "text/html" in answer.headers["content-type"]


async def test_a_spoilt_document_is_told_of_and_leads_nobody_astray(client: httpx.AsyncClient, tmp_path: Path) -> None:
    state = await created(client)
    folder = tmp_path / "documents"
    (folder / "spoilt22.json").write_text("{")
    assert_problem(await client.get("/api/documents/spoilt22"), 422)
    entries = (await client.get("/api/documents")).json()
    assert [entry["id"] for entry in entries if entry["problem"]] == ["spoilt22"]
    assert (await client.get("/")).headers["location"] == f"/d/{state['id']}"


async def test_a_change_that_cannot_be_kept_is_told_of(client: httpx.AsyncClient, tmp_path: Path) -> None:
    state = await created(client)
    folder = tmp_path / "documents"
    folder.rename(tmp_path / "elsewhere")
    folder.write_text("in the way")
    assert_problem(await put(client, state, moved(state, -0.01)), 507)
    assert (await client.get(f"/api/documents/{state['id']}")).json() == state


async def until(condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(60.0):
        while not condition():
            await asyncio.sleep(0.005)


async def test_a_document_that_nobody_uses_is_closed_and_opens_again_as_it_was(
    client: httpx.AsyncClient,
) -> None:
    state = await created(client)
    moved_on = (await put(client, state, moved(state, -0.01))).json()
    workspace = client._transport.app.state.workspace  # type: ignore[attr-defined]
    opened = workspace.opened(state["id"])
    with opened.in_use():
        workspace.close_unused(0.0)
        assert workspace.opened(state["id"]) is opened
    await asyncio.sleep(0.01)
    workspace.close_unused(0.0)
    assert (await client.get(f"/api/documents/{state['id']}")).json() == moved_on
    assert workspace.opened(state["id"]) is not opened
