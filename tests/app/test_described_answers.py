"""Answers and messages have exactly the fields that are described, from which the page's types are generated."""

import json
from typing import Any

import httpx
import pytest
from pydantic import TypeAdapter

from app.api.answers import GarmentAnswer, PlanAnswer, RobotEntry
from app.api.document_answers import (
    CreaseAnswer,
    DocumentAnswer,
    LiveMessage,
    PlaybackAnswer,
    QuickFixesAnswer,
    StepsAnswer,
)
from app.api.file_routes import FileEntry, ImportAnswer
from app.api.problems import Problem
from app.api.suggestion_routes import DoneEvent, SuggestionEvent, TryingEvent
from app.api.template_routes import MadeAnswer, TemplateAnswer
from app.overlays.overlays import OverlaysAnswer
from app.store.document_repository import DocumentEntry
from app.store.garment_repository import GarmentEntry
from planner.robots.card_file import CardFile
from planner.task.scene import Scene
from tests.app.document_requests import created, put
from tests.app.samples import towel
from tests.app.test_live import listening
from tests.app.test_suggestion_routes import STUCK, events_in
from tests.replay.planned import shipped_plan

pytestmark = pytest.mark.anyio

CROSSED = [[0.0, 0.0], [0.4, 0.3], [0.4, 0.0], [0.0, 0.3]]
"""An outline whose edges cross."""


def assert_described(answer: Any, shape: Any) -> None:
    """Check JSON against a model: it is equal after being read and written."""
    adapter: TypeAdapter[Any] = TypeAdapter(shape)
    read = adapter.validate_json(json.dumps(answer))
    assert adapter.dump_python(read, mode="json", by_alias=True, exclude_unset=True) == answer


@pytest.mark.parametrize(
    ("path", "shape"),
    [
        ("/api/garments", list[GarmentEntry]),
        ("/api/garments/t-shirt", GarmentAnswer),
        ("/api/robots", list[RobotEntry]),
        ("/api/robots/ur5e-pair", CardFile),
        ("/api/scene", Scene),
        ("/api/templates", list[TemplateAnswer]),
    ],
)
async def test_what_can_be_read_without_a_document_is_as_described(
    client: httpx.AsyncClient, path: str, shape: Any
) -> None:
    assert_described((await client.get(path)).json(), shape)


async def test_what_is_made_and_imported_is_as_described(client: httpx.AsyncClient) -> None:
    made = await client.post("/api/templates/towel", json={})
    assert_described(made.json(), MadeAnswer)
    imported = await client.post("/api/imports?filename=a.json", json=made.json()["garment"])
    assert_described(imported.json(), ImportAnswer)


@pytest.mark.parametrize(
    ("name", "shape"), [("steps", StepsAnswer), ("quick-fixes", QuickFixesAnswer), ("files", list[FileEntry])]
)
async def test_what_belongs_to_a_document_is_as_described(client: httpx.AsyncClient, name: str, shape: Any) -> None:
    for outline in (towel()["outline"], CROSSED):
        document = (await client.post("/api/documents", json={"garment": towel(), "copy_of": None})).json()
        corners = [{**corner, "point": at} for corner, at in zip(document["drawing"]["outline"], outline, strict=True)]
        changed = (await put(client, document, {**document["drawing"], "outline": corners})).json()
        assert_described(changed, DocumentAnswer)
        assert bool(changed["problems"]) == (outline is CROSSED)
        assert_described((await client.get(f"/api/documents/{document['id']}/{name}")).json(), shape)


async def test_the_list_the_clock_and_a_crease_are_as_described(client: httpx.AsyncClient) -> None:
    path = f"/api/documents/{(await created(client))['id']}"
    assert_described((await client.get("/api/documents")).json(), list[DocumentEntry])
    assert_described((await client.post(f"{path}/playback", json={"do": "pause"})).json(), PlaybackAnswer)
    line = {"start": [0.1, 0.0], "end": [0.1, 0.3]}
    assert_described((await client.post(f"{path}/crease", json={"line": line})).json(), CreaseAnswer)
    assert_described((await client.get(f"{path}/overlays?station=front")).json(), OverlaysAnswer)
    beside = {"start": [5.0, 0.0], "end": [5.0, 0.3]}
    assert_described((await client.post(f"{path}/crease", json={"line": beside})).json(), Problem)


async def test_every_message_of_the_websocket_is_as_described(client: httpx.AsyncClient) -> None:
    document = await created(client)
    page = listening(client, document["id"])
    page.keep_all = True
    await page.until_planned(document["version"])
    page.say({"do": "seek"})
    await page.until("problem")
    page.say({"do": "plan_from", "step": 0})
    while (await page.until("plan"))["start"] is None:
        page.last.pop("plan")
    told = await put(client, document, {**document["drawing"], "start_station": "left"})
    await page.until_planned(told.json()["version"])
    await page.hang_up()
    assert {message["kind"] for message in page.heard} == {"document", "plan", "playback", "problem"}
    for message in page.heard:
        assert_described(message, LiveMessage)


@pytest.mark.parametrize("name", ["letter-towel", pytest.param("tie-halved", marks=pytest.mark.long), "big-towel"])
def test_plans_and_the_reasons_why_there_is_none_are_as_described(name: str) -> None:
    plan = shipped_plan(name)
    assert_described({"id": "p", **plan.answer()}, PlanAnswer)


@pytest.mark.usefixtures("own_robot")
async def test_suggestions_are_as_described(client: httpx.AsyncClient) -> None:
    answer = await client.post("/api/suggestions", json=STUCK)
    shapes = {"trying": TryingEvent, "suggestion": SuggestionEvent, "done": DoneEvent}
    events = events_in(answer.text)
    assert {name for name, _ in events} == set(shapes)
    for name, data in events:
        assert_described(data, shapes[name])
