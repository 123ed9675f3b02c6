"""Messages to several pages on one document."""

import asyncio
import time
from typing import Any

import httpx
import pytest

from app.api.live_messages import document_message
from app.document_state import DocumentState
from app.live_search import LiveSearch
from app.workspace import Workspace
from tests.app.document_requests import created, moved, put
from tests.app.websocket import Listener

pytestmark = pytest.mark.anyio


def listening(client: httpx.AsyncClient, document_id: str) -> Listener:
    app = client._transport.app  # type: ignore[attr-defined]
    return Listener(app, f"/api/documents/{document_id}/live")


async def move(client: httpx.AsyncClient, state: dict[str, Any], x_m: float, **request: Any) -> dict[str, Any]:
    answer = await put(client, state, moved(state, x_m), **request)
    assert answer.status_code == 200, answer.text
    after: dict[str, Any] = answer.json()
    return after


async def test_a_page_is_told_everything_when_it_comes(client: httpx.AsyncClient) -> None:
    state = await created(client)
    page = listening(client, state["id"])
    assert await page.until("document") == state
    plan = await page.until_planned(1)
    assert plan["text"].startswith("Planned: ")
    assert (plan["plan"]["version"], plan["plan"]["is_stale"]) == (1, False)
    assert plan["checks"]["folds"][0]["grips_needed"] == 2
    assert plan["before"] is None
    playback = await page.until("playback", duration_s=plan["plan"]["cost_s"])
    assert playback["version"] == 1
    await page.hang_up()


async def test_two_pages_are_told_the_same(client: httpx.AsyncClient) -> None:
    state = await created(client)
    pages = [listening(client, state["id"]) for _ in range(2)]
    moved = await move(client, state, -0.02)
    for page in pages:
        assert await page.until("document", version=moved["version"]) == moved
        plan = await page.until_planned(moved["version"])
        assert plan["plan"]["version"] == moved["version"]
    assert pages[0].last == pages[1].last
    for page in pages:
        await page.hang_up()


async def test_a_message_is_made_once_for_all_pages_and_the_answer(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    state = await created(client)
    pages = [listening(client, state["id"]) for _ in range(3)]
    for page in pages:
        await page.until_planned(1)
    made: list[int] = []

    def noted(document_id: str, now: DocumentState) -> dict[str, Any]:
        made.append(now.version)
        return document_message(document_id, now)

    monkeypatch.setattr("app.api.serialization.document_message", noted)
    moved = await move(client, state, -0.02)
    for page in pages:
        assert await page.until("document", version=moved["version"]) == moved
        await page.hang_up()
    assert made == [moved["version"]]


async def test_a_page_is_told_how_far_a_robots_arms_are_mapped(client: httpx.AsyncClient) -> None:
    state = await created(client)
    page = listening(client, state["id"])
    await page.until_planned(1)
    workspace: Workspace = client._transport.app.state.workspace  # type: ignore[attr-defined]
    document = workspace.opened(state["id"]).document
    document.prepare(0.25)
    await page.until("plan", prepared=0.25)
    document.prepare(None)
    await page.until("plan", prepared=None)
    await page.hang_up()


async def test_another_page_follows_a_drag_within_a_moment(client: httpx.AsyncClient) -> None:
    """Every preview is on the other page before the hand has gone on; here with room for a busy machine."""
    state = await created(client)
    page = listening(client, state["id"])
    await page.until("plan", status="solved")
    delays = []
    for number in range(1, 11):
        began = time.monotonic()
        state = await move(client, state, -0.001 * number, phase="preview", gesture="drag")
        await page.until("document", version=state["version"])
        delays.append(time.monotonic() - began)
        await asyncio.sleep(0.03)
    assert sorted(delays)[5] < 0.25
    assert page.last["document"]["gesture"] == "Move"
    await page.hang_up()


async def test_the_plan_before_stays_in_sight_and_says_that_it_is_old(client: httpx.AsyncClient) -> None:
    state = await created(client)
    page = listening(client, state["id"])
    await page.until("plan", status="solved")
    page.keep_all = True
    moved = await move(client, state, -0.02)
    await page.until("plan", status="solved", version=moved["version"])
    planning = [one for one in page.heard if one["kind"] == "plan" and one["status"] == "planning"]
    assert planning
    assert all(one["plan"]["version"] == 1 and one["plan"]["is_stale"] for one in planning)
    await page.hang_up()


async def test_commands_come_by_websocket_too_and_bad_ones_are_told_of(client: httpx.AsyncClient) -> None:
    state = await created(client)
    page = listening(client, state["id"])
    page.say({"do": "dance"})
    assert "dance" in (await page.until("problem"))["detail"]
    page.say({"do": "choose", "garment": "hand-towel"})
    document = await page.until("document", version=2)
    assert document["drawing"]["name"] == "hand-towel"
    assert document["history"]["can_undo"] == "Open Hand towel"
    await page.until("plan", status="solved", version=2)
    page.say({"do": "speed", "speed": 4.0})
    await page.until("playback", speed=4.0)
    await page.hang_up()


async def test_what_failed_is_planned_again_when_a_page_asks_for_it(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    state = await created(client)
    page = listening(client, state["id"])
    await page.until_planned(1)

    def fail(*_: object, **__: object) -> None:
        raise RuntimeError("a bug")

    with monkeypatch.context() as patch:
        patch.setattr(LiveSearch, "find", fail)
        await move(client, state, -0.01)
        await page.until("plan", status="failed", version=2)
    page.say({"do": "plan"})
    await page.until_planned(2)
    await page.hang_up()


async def test_a_page_on_a_document_that_is_not_there_or_goes_away_is_sent_away(client: httpx.AsyncClient) -> None:
    nowhere = listening(client, "nothing")
    async with asyncio.timeout(10.0):
        while nowhere.closed_with is None:
            await asyncio.sleep(0.002)
    assert nowhere.closed_with == 4404
    state = await created(client)
    page = listening(client, state["id"])
    await page.until("document")
    assert (await client.delete(f"/api/documents/{state['id']}")).status_code == 204
    async with asyncio.timeout(10.0):
        while page.closed_with is None:
            await asyncio.sleep(0.002)
    assert page.closed_with == 4404
