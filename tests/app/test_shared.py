"""Links to look at a document: no token of the server is needed, nothing can be changed, nothing else is seen."""

import hashlib
import re
from pathlib import Path
from typing import Any

import httpx
import pytest
from sqlalchemy import select

from app.api import shared
from app.api.create_app import create_app
from app.settings import Settings
from app.store.access_token import AccessToken
from app.store.schema import ShareRow
from tests.app.conftest import OWN_URL
from tests.app.document_requests import created, moved, planned, put
from tests.app.test_garbage import assert_problem
from tests.app.websocket import Listener
from tests.patience import PATIENCE_S

pytestmark = pytest.mark.anyio

TOKEN = "the server's own token"


async def link_to(client: httpx.AsyncClient, document_id: str) -> str:
    """Return the prefix of a new link."""
    answer = await client.post(f"/api/documents/{document_id}/share")
    assert answer.status_code == 201
    path: str = answer.json()["path"]
    assert re.fullmatch(rf"/s/[\w-]{{32}}/d/{document_id}", path)
    return path.removesuffix(f"/d/{document_id}")


async def test_a_preview_of_a_link_shows_the_title_and_a_picture_of_the_plan(client: httpx.AsyncClient) -> None:
    document_id = await planned(client, title='A "small" towel')
    link = await link_to(client, document_id)
    page = (await client.get(f"{link}/d/{document_id}")).text
    told = dict(re.findall(r'<meta property="([^"]+)" content="([^"]*)">', page))
    assert told["og:title"] == "A &quot;small&quot; towel - Pleat"
    assert told["og:image"] == f"{OWN_URL}{link}/api/documents/{document_id}/files/picture.png"
    picture = await client.get(told["og:image"])
    assert (picture.status_code, picture.headers["content-type"]) == (200, "image/png")
    assert "og:image" not in (await client.get(f"/d/{document_id}")).text


async def test_with_a_link_the_document_can_be_seen_and_played_and_not_changed(client: httpx.AsyncClient) -> None:
    state = await created(client)
    path = f"/api/documents/{state['id']}"
    link = await link_to(client, state["id"])
    assert (await client.get(f"{link}{path}")).json() == state
    view = f"/viser/{state['id']}/"
    for seen in ("/d/" + state["id"], "/static/js/main.js", "/api/scene", "/api/robots/pr2", f"{path}/steps", view):
        assert (await client.get(f"{link}{seen}")).status_code == 200, seen
    assert (await client.post(f"{link}{path}/playback", json={"do": "seek", "t_s": 1.0})).status_code == 200
    refused: list[tuple[str, str, Any]] = [
        ("POST", f"{path}/playback", {"do": "choose", "garment": "tie"}),
        ("POST", f"{path}/playback", {"do": "theme", "dark": True}),
        ("PUT", f"{path}/drawing", {"base_version": 1, "label": "", "drawing": moved(state, -0.01)}),
        ("POST", f"{path}/undo", {}),
        ("POST", f"{path}/share", {}),
        ("DELETE", f"{path}/share", {}),
        ("DELETE", path, {}),
        ("POST", "/api/plans", {"garment": "scarf"}),
        ("GET", "/api/documents", {}),
        ("GET", "/api/jobs", {}),
        ("GET", f"{path}/versions", {}),
        ("GET", "/api/robots", {}),
        ("GET", "/api/robots/bench", {}),
        ("GET", "/", {}),
        ("GET", "/metrics", {}),
    ]
    for method, asked, body in refused:
        assert_problem(await client.request(method, f"{link}{asked}", json=body), 403)
    other = await created(client)
    for before in ("/api/documents/", "/d/", path, "/viser/"):
        assert_problem(await client.get(f"{link}{before}{other['id']}"), 403)
    assert (await client.get(path)).json() == state


async def test_visitors_play_by_a_clock_of_their_own(client: httpx.AsyncClient) -> None:
    state = await created(client, folds=[{"name": "", "kind": "blue", "start": [0.4, 0.15], "end": [0.0, 0.15]}])
    path = f"/api/documents/{state['id']}"
    link = await link_to(client, state["id"])
    app = client._transport.app  # type: ignore[attr-defined]
    owner, visitor = Listener(app, f"{path}/live"), Listener(app, f"{link}{path}/live")
    await owner.until("plan", status="solved")
    duration_s = (await visitor.until("plan", status="solved"))["plan"]["cost_s"]
    sought = await client.post(f"{link}{path}/playback", json={"do": "seek", "t_s": 3.0})
    assert sought.json()["t_s"] == 3.0 and sought.json()["duration_s"] == duration_s
    visitor.say({"do": "speed", "speed": 2.0})
    assert (await visitor.until("playback", speed=2.0))["t_s"] == 3.0
    visitor.say({"do": "play"})
    await visitor.until("playback", playing=True)
    now = (await client.post(f"{path}/playback", json={"do": "pause"})).json()
    assert (now["t_s"], now["playing"], now["speed"]) == (0.0, False, 1.0)
    await client.post(f"{path}/playback", json={"do": "seek", "t_s": 1.0})
    assert (await client.post(f"{link}{path}/playback", json={"do": "pause"})).json()["t_s"] >= 3.0
    await owner.until("playback", t_s=1.0)


async def test_a_page_by_a_link_follows_until_that_is_taken_back_and_its_commands_only_play(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shared, "_LOOK_EVERY_S", 0.01)
    state = await created(client)
    link = await link_to(client, state["id"])
    page = Listener(client._transport.app, f"{link}/api/documents/{state['id']}/live")  # type: ignore[attr-defined]
    await page.until("document", version=1)
    page.say({"do": "plan_from", "step": None})
    assert "looking and playing" in str(await page.until("problem"))
    line = {"start": [0.1, 0.0], "end": [0.1, 0.3]}
    refused: list[dict[str, Any]] = [{"do": "undo"}, {"do": "crease", "line": line}, {"do": "places"}]
    for ask, sent in enumerate(refused):
        page.say({"ask": ask, **sent})
        assert (await page.until("problem", ask=ask))["status"] == 403
    page.say({"ask": 7, "do": "overlays", "station": "front", "show": "slip"})
    assert (await page.until("answer", ask=7))["result"]["slip"]["holds"]
    await put(client, state, moved(state, -0.01))
    await page.until("document", version=2)
    assert (await client.delete(f"/api/documents/{state['id']}/share")).status_code == 204
    await page.has_ended()
    assert_problem(await client.get(f"{link}/api/documents/{state['id']}"), 404)


async def test_a_link_needs_no_token_of_the_server_and_only_its_hash_is_kept(tmp_path: Path) -> None:
    app = create_app(Settings(data=tmp_path), AccessToken(hashlib.sha256(TOKEN.encode()).digest()))
    transport = httpx.ASGITransport(app=app, raise_app_exceptions=False)
    known = {"authorization": f"Bearer {TOKEN}"}
    async with httpx.AsyncClient(transport=transport, base_url=OWN_URL, timeout=PATIENCE_S) as client:
        document_id = (await client.post("/api/documents", json={}, headers=known)).json()["id"]
        assert (await client.post(f"/api/documents/{document_id}/share")).status_code == 401
        answer = await client.post(f"/api/documents/{document_id}/share", headers=known)
        link = answer.json()["path"].removesuffix(f"/d/{document_id}")
        assert (await client.get(f"{link}/api/documents/{document_id}")).status_code == 200
        assert (await client.get(f"/api/documents/{document_id}")).status_code == 401
        for wrong in ("/s/" + "x" * 32, link[:-1], link + "x"):
            assert_problem(await client.get(f"{wrong}/api/documents/{document_id}"), 404)
        with app.state.workspace.database.reading("look") as session:
            assert link.removeprefix("/s/") not in str(session.execute(select(ShareRow.hash)).all())
        await client.delete(f"/api/documents/{document_id}", headers=known)
        assert_problem(await client.get(f"{link}/d/{document_id}"), 404)
    app.state.workspace.close()


async def test_what_is_not_there_cannot_be_shared(client: httpx.AsyncClient) -> None:
    for asked in ("abcdefgh", "%00", "x"):
        assert_problem(await client.post(f"/api/documents/{asked}/share"), 404)
