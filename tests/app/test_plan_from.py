"""Planning from the middle: the command `plan_from`, and the `plan` message about it."""

import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import pytest
from sqlalchemy import update

from app.document import Document
from app.drawing.draft import draft_of
from app.drawing.edit import Edit
from app.drawing.garment_drawing import drawing_of
from app.live_search import LiveSearch
from app.store.database import Database
from app.store.document_repository import DocumentRepository
from app.store.schema import DocumentRow
from planner import Plan, load_garment, make_plan
from planner.errors import RequestError
from tests.app.document_requests import moved, put
from tests.app.test_live import listening
from tests.app.websocket import Listener
from tests.replay.planned import shipped_plan

T_SHIRT = load_garment("t-shirt")


async def planned(client: httpx.AsyncClient) -> tuple[dict[str, Any], Listener, dict[str, Any]]:
    """Open a T-shirt's document with a page on it, and return its plan message."""
    state: dict[str, Any] = (await client.post("/api/documents", json={"garment": "t-shirt"})).json()
    page = listening(client, state["id"])
    return state, page, await page.until_planned(state["version"])


async def replanned(page: Listener, **wanted: object) -> dict[str, Any]:
    """Wait for the final plan of a version with this start; return its message."""
    await page.until("plan", status="solved", **wanted)
    return await page.until_planned(page.last["plan"]["version"])


@pytest.mark.anyio
async def test_what_is_left_after_a_step_is_planned_and_the_message_says_from_where(client: httpx.AsyncClient) -> None:
    state, page, whole = await planned(client)
    assert whole["start"] is None
    after = shipped_plan("t-shirt").state_after(2).to_dict()
    page.say({"do": "plan_from", "step": 2})
    rest = await replanned(page, start=after)
    folds = [step["fold"] for step in rest["plan"]["primitives"] if step["kind"] == "fold"]
    assert sorted([*folds, *after["folds_done"]]) == [0, 1, 2, 3, 4]
    last = whole["plan"]["primitives"][2]
    left_s = whole["plan"]["cost_s"] - (last["start_s"] + last["duration_s"])
    assert rest["plan"]["cost_s"] == pytest.approx(left_s)
    assert (rest["before"], rest["version"]) == (None, state["version"])
    await page.hang_up()


@pytest.mark.anyio
async def test_the_start_is_taken_back_by_a_command_and_by_an_edit(client: httpx.AsyncClient) -> None:
    state, page, whole = await planned(client)
    for take_back in ("command", "edit"):
        page.say({"do": "plan_from", "step": 0})
        while (await page.until("plan", status="solved"))["start"] is None:
            page.last.pop("plan")
        if take_back == "command":
            page.say({"do": "plan_from", "step": None})
            again = await replanned(page, start=None)
            assert again["plan"]["cost_s"] == pytest.approx(whole["plan"]["cost_s"])
        else:
            told = (await put(client, state, moved(state, -0.001))).json()
            again = await replanned(page, start=None, version=told["version"])
            assert again["before"] is None  # what was left is nothing to compare the whole with
        assert len(again["plan"]["primitives"]) == len(whole["plan"]["primitives"])
    await page.hang_up()


@pytest.mark.anyio
async def test_a_document_that_is_opened_again_is_planned_from_where_it_was(client: httpx.AsyncClient) -> None:
    workspace = client._transport.app.state.workspace  # type: ignore[attr-defined]
    state, page, _ = await planned(client)
    left = await from_second_step(page)
    await page.hang_up()
    workspace.close_unused(-1.0)
    page = listening(client, state["id"])
    again = await page.until_planned(state["version"])
    assert again["start"] == left["start"]
    assert again["plan"]["cost_s"] == pytest.approx(left["plan"]["cost_s"])

    page.say({"do": "plan_from", "step": None})
    await replanned(page, start=None)
    workspace.close_unused(-1.0)
    assert workspace.opened(state["id"]).document.state.start is None


@pytest.mark.anyio
async def test_a_drawing_that_was_changed_is_planned_from_its_beginning_when_it_is_opened_again(
    client: httpx.AsyncClient,
) -> None:
    workspace = client._transport.app.state.workspace  # type: ignore[attr-defined]
    state, page, _ = await planned(client)
    await from_second_step(page)
    changed = (await put(client, state, moved(state, -0.001))).json()
    await client.post(f"/api/documents/{state['id']}/undo", json={"base_version": changed["version"]})
    await page.hang_up()
    workspace.close_unused(-1.0)
    assert workspace.opened(state["id"]).document.state.start is None


async def from_second_step(page: Listener) -> dict[str, Any]:
    """Plan what is left after the second step of the plan on show; return the message of the final plan."""
    page.say({"do": "plan_from", "step": 1})
    while (await page.until("plan", status="solved"))["start"] is None:
        page.last.pop("plan")
    return await replanned(page)


def test_a_start_ends_with_the_drawing_that_it_was_chosen_for_and_is_none_if_it_cannot_be_read(
    plan: Plan, tmp_path: Path
) -> None:
    database = Database(tmp_path / "pleat.db")
    repository = DocumentRepository(database)
    draft = draft_of(drawing_of(T_SHIRT))
    keeper = repository.keeper("aaaabbbb")
    keeper.keep(1, draft)
    start = plan.state_after(1)
    keeper.keep_start(start)
    assert repository.kept("aaaabbbb").start == start
    keeper.keep(2, draft.edited(Edit("turn", replace(draft.drawing, start_station="left")), 0.0))
    assert repository.kept("aaaabbbb").start is None
    keeper.keep_start(start)
    with database.writing("spoil") as session:
        session.execute(update(DocumentRow).values(start="{"))
    assert repository.kept("aaaabbbb").start is None
    database.close()


@pytest.mark.anyio
async def test_a_page_hears_that_the_start_was_taken_back_before_anything_is_planned(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, page, _ = await planned(client)
    may_plan = threading.Event()
    find = LiveSearch.find

    def waiting(search: LiveSearch, *asked: Any) -> None:
        assert may_plan.wait(60.0)
        find(search, *asked)

    monkeypatch.setattr(LiveSearch, "find", waiting)
    page.say({"do": "plan_from", "step": 0})
    assert (await page.until("plan", status="planning"))["start"]["folds_done"] == [0]
    page.say({"do": "plan_from", "step": None})
    assert (await page.until("plan", start=None))["status"] == "planning"
    may_plan.set()
    await replanned(page, start=None)
    await page.hang_up()


@pytest.mark.anyio
async def test_without_a_plan_of_the_drawing_and_beyond_its_steps_it_is_refused(client: httpx.AsyncClient) -> None:
    blank = (await client.post("/api/documents", json={})).json()
    page = listening(client, blank["id"])
    page.say({"do": "plan_from", "step": 0})
    refused = await page.until("problem")
    assert refused["detail"] == "step: there is no plan of the drawing as it is now"
    await page.hang_up()
    _, page, whole = await planned(client)
    count = len(whole["plan"]["primitives"])
    page.say({"do": "plan_from", "step": count})
    assert (await page.until("problem"))["detail"].startswith(f"step: {count} is not between -1 and {count - 1}")
    page.last.pop("problem")
    page.say({"do": "plan_from"})
    assert "step" in (await page.until("problem"))["detail"]
    assert page.last["plan"]["start"] is None
    await page.hang_up()


@pytest.mark.anyio
async def test_what_is_left_is_planned_from_where_the_cloth_is_seen(client: httpx.AsyncClient) -> None:
    state, page, _ = await planned(client)
    after = shipped_plan("t-shirt").state_after(2).to_dict()
    seen = {**after, "placement": {**after["placement"], "x_m": after["placement"]["x_m"] + 0.02}}
    page.say({"do": "plan_from_state", "start": seen})
    rest = await replanned(page, start=seen)
    folds = [step["fold"] for step in rest["plan"]["primitives"] if step["kind"] == "fold"]
    assert sorted([*folds, *after["folds_done"]]) == [0, 1, 2, 3, 4]
    for wrong, field in (
        ({"folds_done": [9]}, "start.folds_done[0]"),
        ({"folds_done": [], "base": {"station": "attic"}}, "start.base.station"),
        ({"speed": 1}, "start.speed"),
    ):
        page.last.pop("problem", None)
        page.say({"do": "plan_from_state", "start": wrong})
        assert field in (await page.until("problem"))["detail"]
    assert page.last["plan"]["start"] == seen and page.last["plan"]["version"] == state["version"]
    await page.hang_up()


@pytest.mark.anyio
async def test_a_drawing_with_problems_cannot_be_planned_from_what_is_seen(client: httpx.AsyncClient) -> None:
    blank = (await client.post("/api/documents", json={})).json()
    page = listening(client, blank["id"])
    page.say({"do": "plan_from_state", "start": {}})
    assert (await page.until("problem"))["detail"].startswith("start: the drawing has problems")
    await page.hang_up()


@pytest.fixture(scope="module")
def plan() -> Plan:
    return shipped_plan("t-shirt")


def answered(plan: Plan) -> Document:
    document = Document(draft_of(drawing_of(T_SHIRT)))
    assert document.state.task is not None
    document.settle(1, document.state.task, plan, "whole")
    return document


def test_the_plan_of_a_drawing_that_was_changed_since_is_none_to_go_on_from(plan: Plan) -> None:
    document = answered(plan)
    document.edit(Edit("Begin elsewhere", replace(document.state.drawing, start_station="left")))
    assert document.state.answer is not None and not document.state.is_answered
    with pytest.raises(RequestError, match="no plan of the drawing"):
        document.plan_from(lambda state: state.start_after(0))
    assert document.state.start is None


def test_an_answer_from_the_beginning_that_comes_late_is_none_to_what_is_left(plan: Plan) -> None:
    document = answered(plan)
    whole = document.state.task
    assert whole is not None
    document.plan_from(lambda state: state.start_after(0))
    document.settle(1, whole, plan, "late")
    assert document.state.is_planning
    assert document.state.shown is None
    rest = make_plan(replace(whole, start=plan.state_after(0)))
    assert document.state.task is not None
    document.settle(1, document.state.task, rest, "rest")
    assert document.state.answer is not None and document.state.answer.plan is rest
