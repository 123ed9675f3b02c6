"""Serving below a prefix, behind a proxy that removes it from the path or keeps it."""

from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from pydantic import ValidationError

from app.api.create_app import create_app
from app.settings import Settings
from tests.app.conftest import OWN_URL
from tests.app.samples import towel
from tests.patience import PATIENCE_S

pytestmark = pytest.mark.anyio

PREFIX = {"x-forwarded-prefix": "/tools/pleat"}


@pytest.fixture
async def below(tmp_path: Path) -> AsyncIterator[httpx.AsyncClient]:
    """Return a client of a server below /pleat that a proxy shows at https://example.org."""
    app = create_app(Settings(data=tmp_path, root_path="/pleat", origin="https://example.org"))
    transport = httpx.ASGITransport(app=app, raise_app_exceptions=False)
    async with httpx.AsyncClient(transport=transport, base_url=OWN_URL, timeout=PATIENCE_S) as client:
        yield client
    app.state.workspace.close()


@pytest.mark.parametrize("taken_off", [True, False])
async def test_the_page_leads_to_addresses_below_the_prefix(client: httpx.AsyncClient, taken_off: bool) -> None:
    above = "" if taken_off else "/tools/pleat"
    first = await client.get(f"{above}/", headers=PREFIX)
    assert first.headers["location"].startswith("/tools/pleat/d/")
    page = await client.get(first.headers["location"], headers=PREFIX)
    assert page.status_code == 200
    assert 'src="../static/page.js"' in page.text
    made = await client.post(f"{above}/api/documents", headers=PREFIX, json={"garment": towel()})
    assert made.headers["location"].startswith("/tools/pleat/d/")
    view = await client.get(f"{above}/viser/{made.json()['id']}", headers=PREFIX)
    assert view.headers["location"].startswith("/tools/pleat/viser/")
    assert "/tools/pleat/openapi.json" in (await client.get(f"{above}/docs", headers=PREFIX)).text


async def test_the_page_names_nothing_from_the_root(client: httpx.AsyncClient) -> None:
    static = Path(__file__).parents[2] / "static"
    for file in [static / "index.html", *static.rglob("*.js")]:
        text = file.read_text(encoding="utf-8")
        for name in ("static", "api", "viser", "docs", "d"):
            for quote in "\"'`":
                assert f"{quote}/{name}/" not in text and f"{quote}/{name}{quote}" not in text, file


@pytest.mark.parametrize("prefix", ["//evil.example", "/a//b", "https://evil.example", "/a b", "/a?b", "/\\evil"])
async def test_a_prefix_that_leads_elsewhere_is_none(client: httpx.AsyncClient, prefix: str) -> None:
    first = await client.get("/", headers={"x-forwarded-prefix": prefix})
    assert first.headers["location"].startswith("/d/")


async def test_a_prefix_may_be_set_for_good(below: httpx.AsyncClient) -> None:
    assert (await below.get("/pleat")).headers["location"] == "/pleat/"
    for path in ("/", "/pleat/"):
        assert (await below.get(path)).headers["location"].startswith("/pleat/d/")
    assert (await below.get("/", headers=PREFIX)).headers["location"].startswith("/tools/pleat/d/")


async def test_a_proxy_that_keeps_its_name_is_let_in_by_it(below: httpx.AsyncClient) -> None:
    headers = {"host": "example.org", "origin": "https://example.org"}
    assert (await below.post("/api/dag", json={"garment": "tie"}, headers=headers)).status_code == 200
    headers["origin"] = "http://example.org"
    assert (await below.post("/api/dag", json={"garment": "tie"}, headers=headers)).status_code == 403


async def test_a_proxy_that_tells_its_name_is_let_in_by_it(client: httpx.AsyncClient) -> None:
    headers = {"x-forwarded-host": "example.org", "origin": "https://example.org"}
    assert (await client.post("/api/dag", json={"garment": "tie"}, headers=headers)).status_code == 200
    headers["origin"] = "https://evil.example"
    assert (await client.post("/api/dag", json={"garment": "tie"}, headers=headers)).status_code == 403
    assert (await client.get("/api/health", headers={**headers, "host": "example.org"})).status_code == 421


@pytest.mark.parametrize(
    "wrong", [{"root_path": "pleat"}, {"root_path": "//evil.example"}, {"origin": "example.org/a"}]
)
def test_a_proxy_that_makes_no_sense_is_refused(tmp_path: Path, wrong: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        Settings(data=tmp_path, **wrong)
