"""HTTP methods, failures, and their description."""

import logging
from pathlib import Path
from typing import Any

import httpx
import pytest

from planner.robots.known_robots import shipped_card
from tests.app.samples import towel

pytestmark = pytest.mark.anyio


@pytest.mark.parametrize("path", ["/api/health", "/api/garments/tie", "/docs", "/static/js/main.js", "/openapi.json"])
async def test_head_is_answered_as_get_without_a_body(client: httpx.AsyncClient, path: str) -> None:
    got, head = await client.get(path), await client.head(path)
    assert head.status_code == got.status_code == 200
    assert head.content == b"" and got.content
    assert head.headers["content-length"] == got.headers["content-length"]
    assert head.headers["content-type"] == got.headers["content-type"]


async def test_head_of_what_is_not_there_is_not_found(client: httpx.AsyncClient) -> None:
    assert (await client.head("/api/garments/nothing")).status_code == 404


@pytest.mark.parametrize(
    ("path", "allowed"),
    [
        ("/api/garments/tie", {"GET", "HEAD", "PUT", "DELETE"}),
        ("/api/documents", {"GET", "HEAD", "POST"}),
        ("/api/documents/anything/drawing", {"PUT"}),
        ("/api/plans", {"POST"}),
        ("/api/plans/imports", {"POST"}),
        ("/api/jobs/placements", {"POST"}),
        ("/api/jobs/anything", {"GET", "HEAD"}),
        ("/static/js/main.js", {"GET", "HEAD"}),
    ],
)
async def test_a_method_that_is_not_possible_is_told_those_that_are(
    client: httpx.AsyncClient, path: str, allowed: set[str]
) -> None:
    answer = await client.patch(path)
    assert answer.status_code == 405
    assert set(answer.headers["allow"].split(", ")) == allowed


async def test_a_body_is_described_as_required_only_where_it_is(client: httpx.AsyncClient) -> None:
    paths: dict[str, Any] = (await client.get("/openapi.json")).json()["paths"]
    is_required = {
        (method, path): operation["requestBody"]["required"]
        for path, operations in paths.items()
        for method, operation in operations.items()
        if "requestBody" in operation
    }
    # Without folds the map of its places, which has a body by default, is there at once.
    document = (await client.post("/api/documents", json={"garment": towel(folds=[])})).json()["id"]
    for (method, path), wanted in is_required.items():
        filled = path.replace("{document_id}", document).replace("{name}", "towel")
        answer = await client.request(method, filled, params={"filename": "a.svg"})
        assert (answer.status_code == 422) == wanted, (method, path)
    assert set(is_required.values()) == {True, False}


async def test_a_failure_is_logged_once_with_the_request(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def fail(*_: object) -> None:
        raise RuntimeError("this is a bug")

    monkeypatch.setattr("app.api.plan_routes.fold_dag", fail)
    answer = await client.post("/api/dag", json={"garment": "tie"})
    assert answer.status_code == 500
    (record,) = [record for record in caplog.records if record.exc_info]
    assert record.getMessage() == "POST /api/dag failed"


async def test_the_server_below_learns_of_no_failure_that_was_answered(
    client: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise RuntimeError("this is a bug")

    monkeypatch.setattr("app.api.plan_routes.fold_dag", fail)
    transport = client._transport
    assert isinstance(transport, httpx.ASGITransport)
    transport.raise_app_exceptions = True
    assert (await client.post("/api/dag", json={"garment": "tie"})).status_code == 500


async def test_an_upload_that_is_broken_off_is_no_failure_of_the_server(
    client: httpx.AsyncClient, caplog: pytest.LogCaptureFixture
) -> None:
    app = client._transport.app  # type: ignore[attr-defined]
    messages: list[dict[str, Any]] = [
        {"type": "http.request", "body": b'{"garment": ', "more_body": True},
        {"type": "http.disconnect"},
    ]
    sent: list[dict[str, Any]] = []

    async def receive() -> dict[str, Any]:
        return messages.pop(0)

    async def send(message: dict[str, Any]) -> None:
        sent.append(message)

    headers = [(b"host", b"127.0.0.1:8000"), (b"content-type", b"application/json"), (b"content-length", b"1000")]
    scope = {"type": "http", "method": "POST", "path": "/api/plans", "query_string": b"", "headers": headers}
    await app({**scope, "asgi": {"version": "3.0"}, "http_version": "1.1", "scheme": "http"}, receive, send)
    assert sent[0]["status"] == 499
    assert not [record for record in caplog.records if record.levelno >= logging.WARNING]


async def test_no_problem_names_a_folder_of_the_machine(
    client: httpx.AsyncClient, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    card = shipped_card("so101-pair").to_dict() | {"name": "bench"}
    assert (await client.put("/api/robots/bench", json=card)).status_code == 201

    def refuse(path: Path, *_: object, **__: object) -> str:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(Path, "read_text", refuse)
    answer = await client.get("/api/robots/bench")
    assert answer.status_code == 422
    assert answer.json()["detail"] == "robot.json cannot be read: Permission denied"
    assert str(tmp_path) not in answer.text
