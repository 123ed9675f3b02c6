from collections.abc import AsyncIterator
from pathlib import Path

import httpx
import pytest

from app.api.create_app import create_app
from app.settings import Settings
from app.workspace import Workspace
from tests.app.conftest import OWN_URL
from tests.app.samples import towel
from tests.app.websocket import Listener
from tests.patience import PATIENCE_S

pytestmark = pytest.mark.anyio


@pytest.fixture
async def limited(tmp_path: Path) -> AsyncIterator[httpx.ASGITransport]:
    """Return the way to a server that allows a request in three seconds, and none at once beyond that."""
    app = create_app(Settings(data=tmp_path, requests_per_s=0.3))
    yield httpx.ASGITransport(app=app)
    app.state.workspace.close()


async def statuses(transport: httpx.ASGITransport, client: str, path: str = "/api/scene") -> list[httpx.Response]:
    transport.client = (client, 1)
    asking = httpx.AsyncClient(transport=transport, base_url=OWN_URL)
    return [await asking.get(path) for _ in range(3)]


async def test_a_client_that_asks_too_often_is_told_when_to_come_again(limited: httpx.ASGITransport) -> None:
    first, *others = await statuses(limited, "192.0.2.1")
    assert first.status_code == 200
    for answer in others:
        assert answer.status_code == 429
        assert answer.headers["content-type"] == "application/problem+json"
        assert 1 <= int(answer.headers["retry-after"]) <= 4
    assert (await statuses(limited, "192.0.2.2"))[0].status_code == 200


async def test_the_page_s_files_and_this_machine_are_not_limited(limited: httpx.ASGITransport) -> None:
    for client, path in (("192.0.2.3", "/static/icon.svg"), ("127.0.0.1", "/api/scene"), ("::1", "/api/scene")):
        assert [answer.status_code for answer in await statuses(limited, client, path)] == [200] * 3


async def test_what_a_page_sends_over_its_websocket_counts_as_requests_do(limited: httpx.ASGITransport) -> None:
    document_id = (await created(limited, "127.0.0.1")).json()["id"]
    page = Listener(limited.app, f"/api/documents/{document_id}/live", "192.0.2.4")
    await page.until("document")
    page.say({"ask": 1, "do": "undo"})
    await page.until("answer", ask=1)
    assert [answer.status_code for answer in await statuses(limited, "192.0.2.4")] == [429] * 3
    await page.hang_up()


@pytest.fixture
async def shared(tmp_path: Path) -> AsyncIterator[httpx.ASGITransport]:
    """Return the way to a server that allows a client two open documents and two websockets."""
    app = create_app(Settings(data=tmp_path, open_documents=2, connections=2))
    yield httpx.ASGITransport(app=app, client=("192.0.2.1", 1))
    app.state.workspace.close()


def workspace_behind(transport: httpx.ASGITransport) -> Workspace:
    found: Workspace = transport.app.state.workspace  # type: ignore[attr-defined]
    return found


async def created(transport: httpx.ASGITransport, client: str = "192.0.2.1") -> httpx.Response:
    transport.client = (client, 1)
    asking = httpx.AsyncClient(transport=transport, base_url=OWN_URL, timeout=PATIENCE_S)
    return await asking.post("/api/documents", json={"garment": towel()})


async def test_a_client_with_too_many_documents_in_use_is_told_when_to_come_again(shared: httpx.ASGITransport) -> None:
    held = [(await created(shared)).json()["id"] for _ in range(2)]
    workspace = workspace_behind(shared)
    with workspace.opened(held[0]).in_use(), workspace.opened(held[1]).in_use():
        refused = await created(shared)
        assert refused.status_code == 429
        assert refused.headers["content-type"] == "application/problem+json"
        assert int(refused.headers["retry-after"]) > 0
        assert len([*workspace.documents.recent()]) == 2  # nothing was made that could not be opened
        first = await httpx.AsyncClient(transport=shared, base_url=OWN_URL).get("/")
        assert first.headers["location"].endswith(held[1])  # those that are open stay within reach
        closed = (await created(shared, "127.0.0.1")).json()["id"]
        workspace.close_unused(0.0)
        page = Listener(shared.app, f"/api/documents/{closed}/live", "192.0.2.1")
        await page.has_ended()
        assert page.closed_with == 1013 and page.last == {}
        for other in ("192.0.2.2", "127.0.0.1"):
            assert (await created(shared, other)).status_code == 201


async def test_a_document_that_nobody_uses_makes_room_for_the_clients_next(
    shared: httpx.ASGITransport, monkeypatch: pytest.MonkeyPatch
) -> None:
    held = [(await created(shared)).json()["id"] for _ in range(2)]
    workspace = workspace_behind(shared)
    monkeypatch.setattr("app.workspace._AT_REST_S", 0.0)
    with workspace.opened(held[0]).in_use():
        third = await created(shared)
    assert third.status_code == 201
    assert {*workspace._open} == {held[0], third.json()["id"]}


async def test_a_client_has_so_many_websockets_open_and_no_more(shared: httpx.ASGITransport) -> None:
    document_id = (await created(shared, "127.0.0.1")).json()["id"]
    path = f"/api/documents/{document_id}/live"
    pages = [Listener(shared.app, path, "192.0.2.1") for _ in range(2)]
    for page in pages:
        await page.until("document")
    refused = Listener(shared.app, path, "192.0.2.1")
    await refused.has_ended()
    assert refused.closed_with == 1013 and refused.last == {}
    for client in ("192.0.2.2", "127.0.0.1"):
        other = Listener(shared.app, path, client)
        await other.until("document")
        await other.hang_up()
    await pages.pop().hang_up()
    again = Listener(shared.app, path, "192.0.2.1")
    await again.until("document")
    for page in (*pages, again):
        await page.hang_up()


async def test_a_refused_websocket_says_when_to_come_again_where_the_listener_can_say_so(
    shared: httpx.ASGITransport,
) -> None:
    document_id = (await created(shared, "127.0.0.1")).json()["id"]
    path = f"/api/documents/{document_id}/live"
    pages = [Listener(shared.app, path, "192.0.2.1") for _ in range(2)]
    for page in pages:
        await page.until("document")
    refused = Listener(shared.app, path, "192.0.2.1", extensions={"websocket.http.response": {}})
    await refused.has_ended()
    assert refused.answered is not None and refused.answered["status"] == 429
    assert int(dict(refused.answered["headers"])[b"retry-after"]) > 0
    for page in pages:
        await page.hang_up()
