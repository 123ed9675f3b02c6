"""Messages to several pages on one document."""

import asyncio
from typing import Any

import httpx
import pytest

from app.api.live_messages import document_message
from app.document_state import DocumentState
from app.live_search import LiveSearch
from app.workspace import Workspace
from tests.app.document_requests import created, moved, put
from tests.app.websocket import Listener
from tests.patience import wait_until

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

    monkeypatch.setattr("app.api.live_messages.document_message", noted)
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


async def test_another_page_follows_a_drag_step_by_step(client: httpx.AsyncClient) -> None:
    state = await created(client)
    page = listening(client, state["id"])
    await page.until("plan", status="solved")
    for number in range(1, 11):
        state = await move(client, state, -0.001 * number, phase="preview", gesture="drag")
        await page.until("document", version=state["version"])
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
    await nowhere.has_ended()
    assert nowhere.closed_with == 4404
    state = await created(client)
    page = listening(client, state["id"])
    await page.until("document")
    assert (await client.delete(f"/api/documents/{state['id']}")).status_code == 204
    await page.has_ended()
    assert page.closed_with == 4404


def edit(state: dict[str, Any], x_m: float, **changes: Any) -> dict[str, Any]:
    """Return what a page sends to move the first corner of a state's drawing."""
    return {"do": "edit", "base_version": state["version"], "label": "Move", "drawing": moved(state, x_m), **changes}


async def test_a_change_is_answered_with_its_version_after_the_state_that_it_has_made(
    client: httpx.AsyncClient,
) -> None:
    state = await created(client)
    page, other = (listening(client, state["id"]) for _ in range(2))
    await page.until_planned(1)
    page.keep_all = True
    page.say({"ask": 7, **edit(state, -0.02)})
    assert await page.until("answer", ask=7) == {"kind": "answer", "ask": 7, "version": 2, "result": None}
    kinds = [heard["kind"] for heard in page.heard]
    assert kinds.index("document") < kinds.index("answer")
    assert await other.until("document", version=2) == page.last["document"]
    for ask, (do, version) in enumerate((("undo", 3), ("redo", 4), ("redo", 4))):
        page.say({"ask": ask, "do": do})
        assert (await page.until("answer", ask=ask))["version"] == version
    page.say({"ask": 8, "do": "put_garment", "garment": "tie"})
    assert (await page.until("answer", ask=8))["version"] == 5
    assert page.last["document"]["drawing"]["name"] == "tie"
    page.say({"ask": 9, "do": "put_robot", "robot": "so101-pair"})
    assert (await page.until("answer", ask=9))["version"] == 6
    assert page.last["document"]["robot"]["name"] == "so101-pair"
    for one in (page, other):
        await one.hang_up()


async def test_a_change_that_comes_too_late_is_a_conflict_and_the_newer_state_is_there_before(
    client: httpx.AsyncClient,
) -> None:
    state = await created(client)
    page = listening(client, state["id"])
    await page.until("document")
    newer = await move(client, state, -0.01)
    page.say({"ask": 1, **edit(state, -0.02)})
    problem = await page.until("problem", ask=1)
    assert (problem["status"], problem["title"]) == (409, "Conflict")
    assert page.last["document"] == newer
    await page.hang_up()


@pytest.mark.parametrize(
    ("sent", "status", "field"),
    [
        ({"ask": 1, "do": "edit", "base_version": 1}, 422, "drawing"),
        ({"ask": 1, "do": "edit", "base_version": 1, "drawing": {}}, 422, "drawing.name"),
        ({"ask": 1, "do": "put_robot", "robot": "robo-9000"}, 422, "robot"),
        ({"ask": 1, "do": "put_garment", "garment": "nothing"}, 404, None),
        ({"ask": 1, "do": "crease", "line": {"start": [5.0, 0.0], "end": [5.0, 0.3]}}, 422, "line"),
        ({"ask": 1, "do": "overlays", "show": "magic"}, 422, "show"),
        ({"ask": 1, "do": "overlays", "t_s": 1.0, "station": "front"}, 422, "station"),
        ({"ask": 1, "do": "undo", "label": "x"}, 422, "label"),
        ({"ask": 1, "do": "put_garment", "garment": "x" * (1 << 20)}, 413, None),
        ({"ask": -1, "do": "undo"}, 422, "ask"),
        ({"do": "steps"}, 422, "ask"),
        ([], 422, "body"),
    ],
)
async def test_what_is_refused_is_answered_with_a_problem_and_changes_nothing(
    client: httpx.AsyncClient, sent: Any, status: int, field: str | None
) -> None:
    state = await created(client)
    page = listening(client, state["id"])
    page.say(sent)
    problem = await page.until("problem")
    assert problem["status"] == status
    assert problem["ask"] == (1 if isinstance(sent, dict) and sent.get("ask") == 1 else None)
    assert [error["field"] for error in problem.get("errors", [])] == ([] if field is None else [field])
    assert (await page.until("document")) == state
    await page.hang_up()


async def test_questions_are_answered_as_programs_are(client: httpx.AsyncClient) -> None:
    state = await created(client)
    path = f"/api/documents/{state['id']}"
    page = listening(client, state["id"])
    plan = (await page.until_planned(1))["plan"]
    line = {"start": [0.1, 0.0], "end": [0.1, 0.3]}
    asked: list[tuple[dict[str, Any], httpx.Response]] = [
        ({"do": "steps"}, await client.get(f"{path}/steps")),
        ({"do": "quick_fixes"}, await client.get(f"{path}/quick-fixes")),
        ({"do": "crease", "line": line}, await client.post(f"{path}/crease", json={"line": line})),
        ({"do": "pictures", "plan": plan["id"]}, await client.get(f"/api/plans/{plan['id']}/pictures")),
        (
            {"do": "overlays", "station": "front", "show": "reach,slip"},
            await client.get(f"{path}/overlays?station=front&show=reach,slip"),
        ),
    ]
    for ask, (question, answer) in enumerate(asked):
        page.say({"ask": ask, **question})
        assert answer.status_code == 200
        assert (await page.until("answer", ask=ask))["result"] == answer.json()
    await page.hang_up()


async def test_a_question_that_is_dropped_is_not_answered_and_its_work_is_stopped(client: httpx.AsyncClient) -> None:
    state = await created(client)
    page = listening(client, state["id"])
    await page.until_planned(1)
    searches = client._transport.app.state.workspace.lanes.searches  # type: ignore[attr-defined]
    page.keep_all = True
    page.say({"ask": 1, "do": "places", "step_m": 0.02, "time_limit_s": 60.0})
    await asyncio.to_thread(wait_until, lambda: searches.load()[1] > 0)
    page.say({"do": "drop", "question": 1})
    await asyncio.to_thread(wait_until, lambda: searches.load()[1] == 0)
    page.say({"ask": 2, "do": "undo"})
    await page.until("answer", ask=2)
    assert not any(heard.get("ask") == 1 for heard in page.heard)
    await page.hang_up()


async def test_a_bug_is_logged_and_told_and_the_page_goes_on(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    state = await created(client)
    page = listening(client, state["id"])

    def fail(*_: object) -> None:
        raise ZeroDivisionError

    with monkeypatch.context() as patch:
        patch.setattr("app.api.live.dispatch", fail)
        page.say({"ask": 1, "do": "undo"})
        assert (await page.until("problem", ask=1))["status"] == 500
    assert "ZeroDivisionError" in caplog.text
    page.say({"ask": 2, "do": "undo"})
    await page.until("answer", ask=2)
    await page.hang_up()
