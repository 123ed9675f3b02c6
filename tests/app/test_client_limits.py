from collections.abc import AsyncIterator
from pathlib import Path

import httpx
import pytest

from app.api.create_app import create_app
from app.settings import Settings
from tests.app.conftest import OWN_URL

pytestmark = pytest.mark.anyio


@pytest.fixture
async def limited(tmp_path: Path) -> AsyncIterator[httpx.ASGITransport]:
    """Return the way to a server that allows a request in ten seconds, and none at once beyond that."""
    app = create_app(Settings(data=tmp_path, requests_per_s=0.3))
    yield httpx.ASGITransport(app=app)
    app.state.workspace.close()


async def statuses(transport: httpx.ASGITransport, client: str, path: str = "/api/scene") -> list[httpx.Response]:
    transport.client = (client, 1)
    asking = httpx.AsyncClient(transport=transport, base_url=OWN_URL)
    return [await asking.get(path) for _ in range(3)]


async def test_a_client_that_asks_too_often_is_told_when_to_come_again(limited: httpx.ASGITransport) -> None:
    first, *others = await statuses(limited, "192.0.2.1")
    assert first.status_code == 200
    for answer in others:
        assert answer.status_code == 429
        assert answer.headers["content-type"] == "application/problem+json"
        assert 1 <= int(answer.headers["retry-after"]) <= 4
    assert (await statuses(limited, "192.0.2.2"))[0].status_code == 200


async def test_the_page_s_files_and_this_machine_are_not_limited(limited: httpx.ASGITransport) -> None:
    for client, path in (("192.0.2.3", "/static/icon.svg"), ("127.0.0.1", "/api/scene"), ("::1", "/api/scene")):
        assert [answer.status_code for answer in await statuses(limited, client, path)] == [200] * 3
