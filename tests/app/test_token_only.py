from collections.abc import AsyncIterator, Iterator
from pathlib import Path

import httpx
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from app.api.create_app import create_app
from app.settings import Settings
from app.store.access_token import kept_token
from tests.app.conftest import OWN_URL, Served

pytestmark = pytest.mark.anyio


@pytest.fixture
async def asking(tmp_path: Path) -> AsyncIterator[tuple[httpx.AsyncClient, str]]:
    """Return a client of a server that asks for a token, and the token."""
    token, made = kept_token(tmp_path / "token.json")
    assert made is not None
    app = create_app(Settings(data=tmp_path, host="0.0.0.0"), token)
    async with httpx.AsyncClient(transport=httpx.ASGITransport(app=app), base_url=OWN_URL) as client:
        yield client, made
    app.state.workspace.close()


def assert_refused(answer: httpx.Response) -> None:
    assert answer.status_code == 401, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.headers["www-authenticate"].startswith("Bearer")
    assert "set-cookie" not in answer.headers


@pytest.mark.parametrize(
    "path", ["/", "/api/health", "/api/jobs", "/static/js/main.js", "/viser/any/", "/docs", "/openapi.json", "/nothing"]
)
async def test_without_the_token_there_is_nothing(asking: tuple[httpx.AsyncClient, str], path: str) -> None:
    client, token = asking
    for headers in (
        {},
        {"authorization": f"Bearer {token}x"},
        {"authorization": "Bearer"},
        {"cookie": "pleat-8000=no"},
    ):
        assert_refused(await client.get(path, headers=headers))
    assert (await client.get(path, headers={"authorization": f"bearer {token}"})).status_code in (200, 307, 404)


async def test_the_token_of_an_address_is_exchanged_for_a_cookie(asking: tuple[httpx.AsyncClient, str]) -> None:
    client, token = asking
    welcome = await client.get("/", params={"token": token, "other": "1"})
    assert (welcome.status_code, welcome.headers["location"]) == (303, "/?other=1")
    cookie = welcome.headers["set-cookie"].lower()
    assert "httponly" in cookie and "samesite=strict" in cookie and "path=/" in cookie and "secure" not in cookie
    assert (await client.get("/api/health")).status_code == 200  # the client keeps the cookie
    client.cookies.clear()
    over_https = await client.get("/", params={"token": token}, headers={"x-forwarded-proto": "https"})
    assert "secure" in over_https.headers["set-cookie"].lower()


async def test_an_address_never_leads_to_another_host(asking: tuple[httpx.AsyncClient, str]) -> None:
    client, token = asking
    welcome = await client.get(f"{OWN_URL}//evil.example/", params={"token": token})
    assert welcome.headers["location"] == "/evil.example/"


async def test_a_wrong_or_doubtful_token_in_an_address_is_refused(asking: tuple[httpx.AsyncClient, str]) -> None:
    client, token = asking
    for query in ("token=", "token=wrong", f"token={token}&token=wrong", f"Token={token}"):
        assert_refused(await client.get(f"/?{query}"))
    assert_refused(await client.post(f"/api/dag?token={token}", json={"garment": "tie"}))


@pytest.fixture(scope="module")
def beyond(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """Start a server that listens on all addresses."""
    server = Served(tmp_path_factory.mktemp("data"), 0, "--host", "0.0.0.0")
    yield server
    server.stop()


def test_beyond_loopback_the_token_is_printed_once_and_opens_both_websockets(beyond: Served) -> None:
    printed, _, token = beyond.url.partition("/?token=")
    at = f"127.0.0.1:{printed.rpartition(':')[2]}"
    known = {"Authorization": f"Bearer {token}"}
    assert httpx.get(f"http://{at}/api/health").status_code == 401
    document = httpx.get(f"http://{at}/", headers=known).headers["location"].rpartition("/")[2]
    for path in (f"/api/documents/{document}/live", f"/viser/{document}"):
        with pytest.raises(InvalidStatus) as refused:
            connect(f"ws://{at}{path}")
        assert refused.value.response.status_code == 401
        for name, value in (*known.items(), ("Cookie", f"pleat-{at.rpartition(':')[2]}={token}")):
            connect(f"ws://{at}{path}", additional_headers={name: value}, compression=None).close()
    assert token not in (beyond.data / "token.json").read_text()
    httpx.get(f"http://{at}/?token={token}")
    beyond.process.terminate()
    rest, _ = beyond.process.communicate()
    assert token not in rest
    again = Served(beyond.data, 0, "--host", "0.0.0.0")
    try:
        assert "token" not in again.url
    finally:
        again.stop()
