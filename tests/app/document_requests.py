"""Requests of a document's routes that many tests make."""

from typing import Any

import httpx

from tests.app.samples import towel
from tests.patience import wait_until_async


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


async def planned(client: httpx.AsyncClient, **changes: Any) -> str:
    """Open a document that is planned, so that all files are available; return its id."""
    document_id: str = (await created(client, **changes))["id"]

    async def is_planned() -> bool:
        entries = (await client.get(f"/api/documents/{document_id}/files")).json()
        return "planned" not in (entries[3]["reason"] or "")

    await wait_until_async(is_planned)
    return document_id
