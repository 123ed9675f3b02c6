"""Requests of a document's routes that many tests make."""

from typing import Any

import httpx

from tests.app.samples import towel


async def created(client: httpx.AsyncClient, **changes: Any) -> dict[str, Any]:
    answer = await client.post("/api/documents", json={"garment": towel(**changes)})
    assert answer.status_code == 201, answer.text
    state: dict[str, Any] = answer.json()
    assert answer.headers["location"] == f"/d/{state['id']}"
    return state


def moved(state: dict[str, Any], x_m: float) -> dict[str, Any]:
    """Return a state's drawing with its first corner at another x."""
    drawing = state["drawing"]
    first, *others = drawing["outline"]
    return {**drawing, "outline": [{**first, "point": [x_m, first["point"][1]]}, *others]}


async def put(client: httpx.AsyncClient, state: dict[str, Any], drawing: object, **request: Any) -> httpx.Response:
    body = {"base_version": state["version"], "label": "Move", "drawing": drawing, **request}
    return await client.put(f"/api/documents/{state['id']}/drawing", json=body)
