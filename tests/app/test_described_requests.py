"""The server accepts and refuses the requests that the description at /docs says it does."""

from typing import Any

import httpx
import pytest
from jsonschema import Draft202012Validator

from app.api.create_app import create_app
from app.settings import Settings
from tests.app.samples import towel

pytestmark = pytest.mark.anyio

CORNERS = towel()["outline"]
GRAB, LINE = {"from": [0.05, 0.05], "to": [0.2, 0.05]}, {"start": [0.1, 0.0], "end": [0.1, 0.3]}
POSE = {"x_m": -0.5, "y_m": 0.0, "yaw_rad": 0.0}
STUDY = {"garments": [{"name": "hand-towel"}]}

BODIES: list[tuple[str, str, dict[str, Any], bool]] = [
    ("post", "/api/dag", {"garment": towel()}, True),
    ("post", "/api/dag", {"garment": {**towel(), "outline": [*CORNERS, CORNERS[0]]}}, False),
    ("post", "/api/documents", {"garment": "hand-towel", "copy_of": None}, True),
    ("post", "/api/documents", {"garment": "hand-towel", "copy_of": "abcd2345"}, False),
    ("post", "/api/documents/{document_id}/crease", {"grab": GRAB, "after": 0}, True),
    ("post", "/api/documents/{document_id}/crease", {"line": LINE, "grab": None, "after": 0}, True),
    ("post", "/api/documents/{document_id}/crease", {"line": LINE, "grab": GRAB}, False),
    ("post", "/api/documents/{document_id}/crease", {}, False),
    ("put", "/api/documents/{document_id}/drawing", {"base_version": 1, "phase": "cancel"}, True),
    ("put", "/api/documents/{document_id}/drawing", {"base_version": 1, "phase": "commit"}, False),
    ("put", "/api/documents/{document_id}/drawing", {"base_version": 1, "drawing": None}, False),
    ("post", "/api/plans", {"garment": "hand-towel", "start": {"base": {"station": "front"}}}, True),
    ("post", "/api/plans", {"garment": "hand-towel", "start": {"base": {"station": None, **POSE}}}, True),
    ("post", "/api/plans", {"garment": "hand-towel", "start": {"base": {"back_off_m": 0.1}}}, False),
    ("post", "/api/plans", {"garment": "hand-towel", "start": {"base": {**POSE, "yaw_rad": None}}}, False),
    ("post", "/api/plans/imports", {}, False),
    ("post", "/api/comparisons", {"garment": "hand-towel", "robots": [""]}, False),
    ("post", "/api/rehearsals", {"plan": {}, "noise": "loud"}, False),
    ("post", "/api/rehearsals", {"plan": {}, "runs": 0}, False),
    ("post", "/api/studies", STUDY, True),
    ("post", "/api/studies", {**STUDY, "placements": [{**POSE, "x_m": -0.75}]}, True),
    ("post", "/api/studies", {**STUDY, "placements": []}, False),
    ("post", "/api/studies", {**STUDY, "placements": ["own"]}, False),
    ("post", "/api/studies", {**STUDY, "placements": "here"}, False),
    ("post", "/api/studies", {**STUDY, "placements": {}}, False),
    ("post", "/api/studies", {**STUDY, "robots": []}, False),
    ("post", "/api/studies", {**STUDY, "start_stations": []}, False),
    ("post", "/api/studies", {**STUDY, "title": ""}, False),
    ("post", "/api/studies", {**STUDY, "cells_max": 0}, False),
    ("post", "/api/studies", {"garments": []}, False),
    ("post", "/api/studies", {"garments": [{}]}, False),
    ("post", "/api/studies", {"garments": [{"name": "hand-towel", "random": 2}]}, False),
]


@pytest.fixture(scope="module")
def described_paths(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Return what the description says of each path; it takes longer than most requests."""
    app = create_app(Settings(data=tmp_path_factory.mktemp("described")))
    app.state.workspace.close()
    paths: dict[str, Any] = app.openapi()["paths"]
    return paths


@pytest.mark.parametrize(("method", "path", "body", "is_good"), BODIES)
async def test_bodies_are_described_as_the_server_takes_them(
    client: httpx.AsyncClient,
    described_paths: dict[str, Any],
    method: str,
    path: str,
    body: dict[str, Any],
    is_good: bool,
) -> None:
    described = described_paths[path][method]["requestBody"]["content"]
    assert Draft202012Validator(described["application/json"]["schema"]).is_valid(body) is is_good
    document = (await client.post("/api/documents", json={"garment": "hand-towel"})).json()
    answer = await client.request(method, path.replace("{document_id}", document["id"]), json=body)
    assert answer.is_success if is_good else answer.status_code == httpx.codes.UNPROCESSABLE_ENTITY, answer.text


async def test_a_card_names_the_kind_of_its_drives_and_joints_for_each_arm(
    client: httpx.AsyncClient, described_paths: dict[str, Any]
) -> None:
    description = described_paths["/api/robots/{name}"]["put"]["requestBody"]
    card = (await client.get("/api/robots/ur5e-pair")).json() | {"name": "mine"}
    valid = Draft202012Validator(description["content"]["application/json"]["schema"])
    assert valid.is_valid(card)
    arm = card["arms"][0]
    drive = {name: value for name, value in arm["gripper"]["drive"].items() if name != "kind"}
    wrong = [{**arm, "gripper": {**arm["gripper"], "drive": drive}}, {**arm, "joints": [], "home": []}]
    changes: list[dict[str, Any]] = [{"pleat_robot": 99}, {"arms": []}, *({"arms": [one]} for one in wrong)]
    for changed in changes:
        bad = {**card, **changed}
        assert not valid.is_valid(bad)
        assert (await client.put("/api/robots/mine", json=bad)).status_code == httpx.codes.UNPROCESSABLE_ENTITY


@pytest.mark.parametrize(
    ("query", "is_good"),
    [
        ({"filename": "a.json"}, True),
        ({"filename": "A.JSON", "units": "mm", "scale": 1000}, True),
        ({"filename": "a"}, False),
        ({"filename": ".json"}, False),
        ({"filename": "a.jsonl"}, False),
        ({"filename": "a.json", "units": "ft"}, False),
        ({"filename": "a.json", "scale": 0.0001}, False),
    ],
)
async def test_the_query_of_an_import_is_described_as_the_server_takes_it(
    client: httpx.AsyncClient, described_paths: dict[str, Any], query: dict[str, Any], is_good: bool
) -> None:
    described = described_paths["/api/imports"]["post"]["parameters"]
    schemas = {parameter["name"]: parameter["schema"] for parameter in described}
    assert all(Draft202012Validator(schemas[name]).is_valid(value) for name, value in query.items()) is is_good
    answer = await client.post("/api/imports", params=query, json=towel())
    assert answer.is_success if is_good else answer.status_code == httpx.codes.UNPROCESSABLE_ENTITY, answer.text
