"""Changes of a drawing over REST: steps that can be undone, or refusals with the wrong field."""

from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.app.document_requests import created, moved, put
from tests.app.test_garbage import assert_problem

pytestmark = pytest.mark.anyio
HALF = {"name": "half", "kind": "blue", "start": {"point": [0.4, 0.15]}, "end": {"point": [0.0, 0.15]}}


async def test_a_document_can_be_drawn_from_nothing(client: httpx.AsyncClient) -> None:
    state = (await client.post("/api/documents", json={})).json()
    corners = [{"point": point} for point in ([0, 0], [0.4, 0], [0.4, 0.3], [0, 0.3])]
    state = (await put(client, state, {**state["drawing"], "outline": corners})).json()
    assert state["problems"] == []
    assert [corner["id"] for corner in state["drawing"]["outline"]] == ["v0", "v1", "v2", "v3"]
    state = (await put(client, state, {**state["drawing"], "folds": [HALF]}, label="Draw fold")).json()
    assert state["solved"][0]["status"] == "legal"
    assert state["history"]["can_undo"] == "Draw fold"


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
    assert set(problem) == {"code", "field", "message", "says", "fold", "points", "lines"}
    assert problem["code"] == "outline_crosses"
    assert problem["says"] == {"code": "edges_cross", "edges": [1, 3], "at": problem["points"][0]}
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


async def test_a_change_that_cannot_be_kept_is_told_of(client: httpx.AsyncClient, tmp_path: Path) -> None:
    state = await created(client)
    (tmp_path / "pleat.db").rename(tmp_path / "elsewhere")
    problem = assert_problem(await put(client, state, moved(state, -0.01)), 500)
    assert "could not be written, so the change was not made: the database's file was" in problem["detail"]
    assert (await client.get(f"/api/documents/{state['id']}")).json() == state


async def test_a_quick_fix_can_be_committed_and_undone(client: httpx.AsyncClient) -> None:
    state = await created(client)
    path = f"/api/documents/{state['id']}"
    assert (await client.get(f"{path}/quick-fixes")).json() == {"version": 1, "quick_fixes": []}
    fold = {**state["drawing"]["folds"][0], "kind": "red"}
    spoilt = (await put(client, state, {**state["drawing"], "folds": [fold]})).json()
    answer = (await client.get(f"{path}/quick-fixes")).json()
    assert answer["version"] == spoilt["version"]
    first = answer["quick_fixes"][0]
    assert set(first) == {"label", "says", "drawing"}
    fixed = (await put(client, spoilt, first["drawing"], label=first["label"])).json()
    assert fixed["problems"] == []
    assert fixed["history"]["can_undo"] == "Make fold 0 'half' blue"
    undone = (await client.post(f"{path}/undo")).json()
    assert undone["problems"] == spoilt["problems"]
