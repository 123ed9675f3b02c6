from collections.abc import AsyncIterator
from pathlib import Path

import httpx
import pytest

from app.api.create_app import create_app
from app.api.guard import own_names
from app.settings import Settings
from tests.app.conftest import OWN_URL
from tests.app.samples import towel

pytestmark = pytest.mark.anyio


def assert_is_problem(answer: httpx.Response, header: str) -> None:
    assert answer.headers["content-type"] == "application/problem+json"
    told = answer.json()
    assert told["status"] == answer.status_code
    assert header in told["detail"]


@pytest.mark.parametrize("host", ["127.0.0.1:8000", "localhost:8000", "LOCALHOST:8000", "[::1]:8000"])
async def test_own_names_are_answered(client: httpx.AsyncClient, host: str) -> None:
    answer = await client.get("/api/health", headers={"host": host, "origin": f"http://{host.lower()}"})
    assert answer.status_code == 200


@pytest.mark.parametrize(
    "host", ["evil.example", "127.0.0.1", "127.0.0.1:9000", "localhost.evil.example:8000", "", "127.0.0.1:8000."]
)
@pytest.mark.parametrize("path", ["/", "/api/health", "/nothing", "/static/js/main.js"])
async def test_a_foreign_host_is_refused(client: httpx.AsyncClient, host: str, path: str) -> None:
    answer = await client.get(path, headers={"host": host})
    assert answer.status_code == 421
    assert_is_problem(answer, "Host")


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "null", "https://127.0.0.1:8000", "http://127.0.0.1:8001", "http://127.0.0.1", ""],
)
async def test_a_foreign_origin_is_refused(client: httpx.AsyncClient, origin: str) -> None:
    answer = await client.post("/api/dag", json={"garment": "tie"}, headers={"origin": origin})
    assert answer.status_code == 403
    assert_is_problem(answer, "Origin")


@pytest.mark.parametrize("site", ["cross-site", "same-site", ""])
@pytest.mark.parametrize("destination", ["image", "iframe", "empty"])
async def test_what_a_foreign_page_embeds_is_refused(client: httpx.AsyncClient, site: str, destination: str) -> None:
    headers = {"sec-fetch-site": site, "sec-fetch-mode": "no-cors", "sec-fetch-dest": destination}
    for path in ("/api/health", "/api/garments", "/", "/static/js/main.js"):
        answer = await client.get(path, headers=headers)
        assert answer.status_code == 403
        assert_is_problem(answer, "Sec-Fetch-Site")


async def test_a_foreign_page_may_link_to_a_page_but_to_nothing_that_works(client: httpx.AsyncClient) -> None:
    headers = {"sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}
    first = await client.get("/", headers=headers)
    assert first.status_code == 307
    assert (await client.get(first.headers["location"], headers=headers)).status_code == 200
    assert (await client.get("/api/garments", headers=headers)).status_code == 403
    assert (await client.post("/", headers=headers)).status_code == 403
    assert (await client.get("/", headers={**headers, "sec-fetch-dest": "iframe"})).status_code == 403


@pytest.mark.parametrize("site", ["same-origin", "none"])
async def test_what_our_own_page_or_the_reader_asks_for_is_answered(client: httpx.AsyncClient, site: str) -> None:
    headers = {"sec-fetch-site": site, "sec-fetch-mode": "no-cors", "sec-fetch-dest": "image"}
    assert (await client.get("/api/garments", headers=headers)).status_code == 200


async def test_nothing_that_plans_for_seconds_is_started_by_a_get(client: httpx.AsyncClient) -> None:
    document_id = (await client.post("/api/documents", json={"garment": towel()})).json()["id"]
    for path in ("/api/placements?garment=tie", f"/api/documents/{document_id}/overlays/places"):
        answer = await client.get(path)
        assert answer.status_code == 405
        assert "POST" in answer.headers["allow"]


def test_the_given_host_is_an_own_name_too() -> None:
    assert "192.0.2.7:80" in own_names("192.0.2.7", 80)
    assert "192.0.2.7" in own_names("192.0.2.7", 80)
    assert "[2001:db8::1]:8000" in own_names("2001:db8::1", 8000)


@pytest.fixture
async def everywhere(tmp_path: Path) -> AsyncIterator[httpx.AsyncClient]:
    """Return a client of a server that listens on all addresses of the machine."""
    app = create_app(Settings(data=tmp_path, host="0.0.0.0", insecure=True))
    async with httpx.AsyncClient(transport=httpx.ASGITransport(app=app), base_url=OWN_URL) as client:
        yield client
    app.state.workspace.close()


@pytest.mark.parametrize("host", ["192.0.2.7:8000", "[2001:db8::1]:8000", "127.0.0.1:8000"])
async def test_on_all_addresses_each_address_is_answered(everywhere: httpx.AsyncClient, host: str) -> None:
    headers = {"host": host, "origin": f"http://{host}"}
    assert (await everywhere.post("/api/dag", json={"garment": "tie"}, headers=headers)).status_code == 200


async def test_on_all_addresses_no_foreign_name_or_page_is_answered(everywhere: httpx.AsyncClient) -> None:
    assert (await everywhere.get("/api/health", headers={"host": "evil.example:8000"})).status_code == 421
    headers = {"host": "192.0.2.7:8000", "origin": "http://192.0.2.8:8000"}
    assert (await everywhere.get("/api/health", headers=headers)).status_code == 403


async def test_other_pages_may_not_frame_ours(client: httpx.AsyncClient) -> None:
    answer = await client.get("/")
    assert "frame-ancestors 'self'" in answer.headers["content-security-policy"]
