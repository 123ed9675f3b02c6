"""Any request is answered, bad ones with a problem that names the field: never a 500, never a trace."""

import asyncio
import json
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from fastapi import FastAPI
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.api.create_app import create_app
from app.settings import Settings
from app.worker.workers import Workers
from tests.app.conftest import OWN_URL
from tests.app.samples import towel

pytestmark = pytest.mark.anyio

BODIES = {
    "nothing": b"",
    "no JSON": b"{",
    "bytes": b"\xff\xfe\x00",
    "another encoding": json.dumps({"garment": "tie"}).encode("utf-16"),
    "NaN": b'{"garment": "tie", "comfort_radius_m": NaN}',
    "Infinity": b'{"garment": "tie", "time_limit_s": Infinity}',
    "beyond doubles": b'{"garment": "tie", "time_limit_s": 1e400}',
    "5,000 digits": b'{"garment": "tie", "max_expanded": ' + b"9" * 5000 + b"}",
    "400 digits": b'{"garment": "tie", "time_limit_s": ' + b"9" * 400 + b"}",
    "deep nesting": b'{"garment": ' + b"[" * 100_000 + b"]" * 100_000 + b"}",
    "deep objects": b'{"garment": ' + b'{"a":' * 50_000 + b"1" + b"}" * 50_000 + b"}",
    "a list": b"[]",
    "a number": b"1",
    "null": b"null",
    "half a surrogate": b'{"garment": "\\ud800"}',
    "two documents": b'{"garment": "tie"} {}',
}

FIELDS: list[tuple[dict[str, Any], str]] = [
    ({}, "garment"),
    ({"garment": 1}, "garment"),
    ({"garment": None}, "garment"),
    ({"garment": []}, "garment"),
    ({"garment": "tie", "colour": "red"}, "colour"),
    ({"garment": "tie", "comfort_radius_m": "0.03"}, "comfort_radius_m"),
    ({"garment": "tie", "comfort_radius_m": True}, "comfort_radius_m"),
    ({"garment": "tie", "comfort_radius_m": 0.2}, "comfort_radius_m"),
    ({"garment": "tie", "comfort_radius_m": None}, "comfort_radius_m"),
    ({"garment": "tie", "time_limit_s": 61}, "time_limit_s"),
    ({"garment": "tie", "max_expanded": 0}, "max_expanded"),
    ({"garment": "tie", "max_expanded": 1.5}, "max_expanded"),
    ({"garment": "tie", "heuristic": "magic"}, "heuristic"),
    ({"garment": "tie", "start_station": "nowhere"}, "start_station"),
    ({"garment": "tie", "start_station": 3}, "start_station"),
    ({"garment": "tie", "robot": "r2d2"}, "robot"),
    ({"garment": "tie", "placement": {"x_m": 0}}, "placement.y_m"),
    ({"garment": "tie", "placement": {"x_m": 11, "y_m": 0, "yaw_rad": 0}}, "placement.x_m"),
    ({"garment": "tie", "placement": 3}, "placement"),
    ({"garment": "tie", "scene": 3}, "scene"),
    ({"garment": "tie", "scene": {"table": {"depth_m": -1}}}, "scene.table.depth_m"),
    ({"garment": "tie", "scene": {"table": {"length_m": 1}}}, "scene.table.length_m"),
    ({"garment": "tie", "scene": {"friction": "1"}}, "scene.friction"),
    ({"garment": "tie", "scene": {"stations": {}}}, "scene.stations"),
    ({"garment": "tie", "scene": {"torso_m": 0.9}}, "scene.torso_m"),
    ({"garment": towel(size="L")}, "garment.size"),
    ({"garment": towel(outline=[[0, 0], [1, 0]])}, "garment.outline"),
    ({"garment": towel(outline=[[0, 0], [0.3, 0], [0, 0.3], [0.3, 0.3]])}, "garment.outline[3]"),
    ({"garment": towel(outline=[[0, 0], [11, 0], [0, 1]])}, "garment.outline[1][0]"),
    ({"garment": towel(name="My towel")}, "garment.name"),
    ({"garment": towel(areal_density_kg_m2=0)}, "garment.areal_density_kg_m2"),
    ({"garment": towel(thickness_m=0.05)}, "garment.thickness_m"),
    (
        {"garment": towel(folds=[{"name": "", "kind": "green", "start": [0.4, 0.15], "end": [0, 0.15]}])},
        "garment.folds[0].kind",
    ),
    (
        {"garment": towel(folds=[{"name": "", "kind": "blue", "start": [0.2, 0.15], "end": [0, 0.15]}])},
        "garment.folds[0].start",
    ),
]

REQUESTS = [("POST", "/api/plans"), ("POST", "/api/dag"), ("PUT", "/api/garments/my-towel")]


def assert_problem(answer: httpx.Response, status: int) -> dict[str, Any]:
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    problem: dict[str, Any] = answer.json()
    assert {"title", "status", "detail"} <= set(problem)
    assert problem["status"] == status
    assert "Traceback" not in answer.text
    return problem


@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES.keys())
@pytest.mark.parametrize(("method", "path"), REQUESTS)
async def test_a_body_that_cannot_be_read_is_a_problem(
    client: httpx.AsyncClient, method: str, path: str, body: bytes
) -> None:
    answer = await client.request(method, path, content=body, headers={"content-type": "application/json"})
    assert assert_problem(answer, 422)["errors"]


@pytest.mark.parametrize(("body", "field"), FIELDS, ids=[f"{i} {field}" for i, (_, field) in enumerate(FIELDS)])
async def test_a_problem_names_the_field(client: httpx.AsyncClient, body: dict[str, Any], field: str) -> None:
    problem = assert_problem(await client.post("/api/plans", json=body), 422)
    assert problem["errors"][0]["field"].startswith(field)
    assert problem["errors"][0]["message"]


async def test_an_illegal_fold_is_named_by_the_dag_too(client: httpx.AsyncClient) -> None:
    folds = [{"name": "", "kind": "blue", "start": [0.2, 0.15], "end": [0, 0.15]}]
    problem = assert_problem(await client.post("/api/dag", json={"garment": towel(folds=folds)}), 422)
    assert problem["errors"][0]["field"] == "garment.folds[0].start"


async def test_more_than_a_mebibyte_is_too_large(client: httpx.AsyncClient) -> None:
    body = b'{"garment": "' + b"x" * (1 << 20) + b'"}'
    headers = {"content-type": "application/json"}
    assert_problem(await client.post("/api/plans", content=body, headers=headers), 413)


async def test_a_body_of_another_type_is_a_problem(client: httpx.AsyncClient) -> None:
    headers = {"content-type": "text/plain"}
    assert_problem(await client.post("/api/plans", content=b'{"garment": "tie"}', headers=headers), 422)


async def test_unknown_garments_are_not_found(client: httpx.AsyncClient) -> None:
    for path in ("/api/plans", "/api/dag"):
        for name in ("nothing", "../garments/tie.json", "garments/tie.json", "", "\x00"):
            assert_problem(await client.post(path, json={"garment": name}), 404)


@pytest.mark.parametrize(
    "path",
    [
        "/nothing",
        "/api/nothing",
        "/static/nothing.js",
        "/static/%00",
        "/static/..%2f..%2fpyproject.toml",
        "/static/" + "x" * 3000,
        "/viser/nothing/",
        "/viser/nothing",
        "/static-offline-docs/%00",
    ],
)
async def test_what_is_not_there_is_a_problem(client: httpx.AsyncClient, path: str) -> None:
    assert_problem(await client.get(path), 404)


async def test_a_wrong_method_is_a_problem_that_keeps_the_allowed_ones(client: httpx.AsyncClient) -> None:
    answer = await client.patch("/api/plans")
    assert_problem(answer, 405)
    assert "POST" in answer.headers["allow"]


async def test_a_bug_is_a_problem_without_a_trace(client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise RuntimeError("secret")

    monkeypatch.setattr(Workers, "run", fail)
    answer = await client.post("/api/plans", json={"garment": "tie"})
    assert_problem(answer, 500)
    assert "secret" not in answer.text


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=12,
)
KNOWN = st.sampled_from(
    ["garment", "placement", "scene", "start_station", "robot", "comfort_radius_m", "heuristic", "max_expanded"]
)


@pytest.fixture(scope="module")
def app(tmp_path_factory: pytest.TempPathFactory) -> Iterator[FastAPI]:
    made = create_app(Settings(data=tmp_path_factory.mktemp("fuzz")))
    yield made
    made.state.workspace.close()


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(body=st.dictionaries(KNOWN, JSON, max_size=5))
def test_no_known_field_with_any_value_ends_in_a_500(body: dict[str, Any], app: FastAPI) -> None:
    async def ask() -> httpx.Response:
        transport = httpx.ASGITransport(app=app, raise_app_exceptions=False)
        async with httpx.AsyncClient(transport=transport, base_url=OWN_URL) as client:
            return await client.post("/api/plans", json=body)

    answer = asyncio.run(ask())
    assert answer.status_code in (200, 404, 422), answer.text
