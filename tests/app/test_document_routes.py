"""REST routes of documents: made, copied, listed, opened again, removed, and the page of each."""

import itertools
import math
from typing import Any

import httpx
import pytest
from sqlalchemy import text

from app.workspace import Workspace
from tests.app.document_requests import created, moved, put
from tests.app.samples import towel
from tests.app.test_garbage import BODIES, assert_problem

pytestmark = pytest.mark.anyio


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
    assert set(entries[0]) == {"id", "title", "name", "changed_at", "problem", "picture"}
    assert entries[0]["picture"]["outline"] == [corner["point"] for corner in other["drawing"]["outline"]]
    assert [fold["kind"] for fold in entries[0]["picture"]["folds"]] == ["blue"]
    assert (await client.delete(f"/api/documents/{one['id']}")).status_code == 204
    for answer in (
        await client.get(f"/api/documents/{one['id']}"),
        await client.delete(f"/api/documents/{one['id']}"),
        await put(client, one, one["drawing"]),
        await client.get(f"/viser/{one['id']}/"),
    ):
        assert_problem(answer, 404)
    assert [entry["id"] for entry in (await client.get("/api/documents")).json()] == [other["id"]]


async def test_versions_are_the_steps_with_their_times_and_drawings(client: httpx.AsyncClient) -> None:
    first = await created(client)
    path = f"/api/documents/{first['id']}"
    assert (await client.get(f"{path}/versions")).json() == []
    second = (await put(client, first, moved(first, -0.02))).json()
    await put(client, second, moved(second, -0.03))
    found = (await client.get(f"{path}/versions")).json()
    assert [version["drawing"] for version in found] == [second["drawing"], first["drawing"]]
    assert [bool(version["label"]) for version in found] == [True, False]
    times = [version["changed_at"] for version in found]
    assert all(times) and times == sorted(times, reverse=True)
    await client.post(f"{path}/undo", json={})
    assert [version["drawing"] for version in (await client.get(f"{path}/versions")).json()] == [first["drawing"]]
    assert_problem(await client.get("/api/documents/aaaaaaaa/versions"), 404)


async def test_a_long_list_comes_in_pages_each_of_which_leads_to_the_next(client: httpx.AsyncClient) -> None:
    made = [(await created(client))["id"] for _ in range(7)]
    path, pages = "/api/documents?limit=3", []
    while path:
        answer = await client.get(path)
        pages.append([entry["id"] for entry in answer.json()])
        path = str(answer.url.join(answer.links["next"]["url"])) if "next" in answer.links else ""
    assert [len(page) for page in pages] == [3, 3, 1]
    assert sorted(itertools.chain(*pages)) == sorted(made)
    assert "link" not in (await client.get("/api/documents")).headers
    for query in ("limit=0", "limit=501", "limit=x", "after=" + "x" * 101):
        assert_problem(await client.get(f"/api/documents?{query}"), 422)
    for after in ("", "x", "/", "9/zzzzzzzz", "\x00", "é/é"):
        assert (await client.get("/api/documents", params={"after": after})).status_code == 200


def spoil(client: httpx.AsyncClient, document_id: str, change: str) -> None:
    """Close all documents, and change a row of one as no server would."""
    workspace: Workspace = client._transport.app.state.workspace  # type: ignore[attr-defined]
    workspace.close_unused(0.0)
    with workspace.database.writing("try") as session:
        session.execute(text(f"UPDATE {change} = :id"), {"id": document_id})


async def test_a_document_of_a_newer_version_is_refused_by_it(client: httpx.AsyncClient) -> None:
    newer, state = await created(client), await created(client)
    spoil(client, newer["id"], "documents SET format = 99 WHERE id")
    for answer in (
        await client.get(f"/api/documents/{newer['id']}"),
        await put(client, newer, newer["drawing"]),
        await client.post("/api/documents", json={"copy_of": newer["id"]}),
    ):
        assert "format 99" in assert_problem(answer, 409)["detail"]
    assert [one["id"] for one in (await client.get("/api/documents")).json() if one["problem"]] == [newer["id"]]
    assert (await client.get("/")).headers["location"] == f"/d/{state['id']}"


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


async def test_edges_that_stand_for_an_arc_become_a_curve_only_where_that_is_asked_for(
    client: httpx.AsyncClient,
) -> None:
    turns = [math.pi * step / 40 for step in range(41)]
    half_circle = [[0.2 + 0.1 * math.sin(turn), 0.1 - 0.1 * math.cos(turn)] for turn in turns]
    garment = towel(outline=[[0.0, 0.0], *half_circle, [0.0, 0.2]], folds=[])

    def curved(state: dict[str, Any]) -> list[float]:
        return [corner["curve"]["across"] for corner in state["drawing"]["outline"] if corner.get("curve")]

    straight = (await client.post("/api/documents", json={"garment": garment})).json()
    assert len(straight["drawing"]["outline"]) == len(garment["outline"])
    assert curved(straight) == []
    anew = (await client.post("/api/documents", json={"garment": garment, "arcs": True})).json()
    path = f"/api/documents/{straight['id']}/garment"
    here = (await client.put(path, json={"garment": garment, "arcs": True})).json()
    for state in (anew, here):
        assert len(state["drawing"]["outline"]) == 4
        assert curved(state) == [pytest.approx(-0.5, abs=1e-6)]


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


async def test_a_spoilt_document_is_told_of_and_leads_nobody_astray(client: httpx.AsyncClient) -> None:
    spoilt, state = await created(client), await created(client)
    spoil(client, spoilt["id"], "document_steps SET drawing = '{' WHERE document_id")
    assert_problem(await client.get(f"/api/documents/{spoilt['id']}"), 422)
    entries = (await client.get("/api/documents")).json()
    assert [entry["id"] for entry in entries if entry["problem"]] == [spoilt["id"]]
    assert (await client.get("/")).headers["location"] == f"/d/{state['id']}"


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
    workspace.close_unused(-1.0)  # even those that have been used just now
    assert (await client.get(f"/api/documents/{state['id']}")).json() == moved_on
    assert workspace.opened(state["id"]) is not opened


async def test_of_many_documents_the_longest_unused_are_closed_and_come_back_when_asked_for(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = client._transport.app.state.workspace  # type: ignore[attr-defined]
    monkeypatch.setattr("app.workspace.OPEN_MAX", 2)
    monkeypatch.setattr("app.workspace.CROWDED_S", 0.0)
    states = [await created(client) for _ in range(4)]
    with workspace.opened(states[0]["id"]).in_use():
        workspace.close_unused()
        assert set(workspace._open) == {states[0]["id"], states[3]["id"]}
    for state in states:
        again = (await client.get(f"/api/documents/{state['id']}")).json()
        assert again["drawing"] == state["drawing"] and again["version"] == state["version"]
