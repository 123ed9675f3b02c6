"""Assumptions about viser behind the patches of it: these fail where a new version breaks them.

What its page does only once it runs (what it takes for a phone) is looked at in a browser.
"""

import inspect

import pytest
import viser
import websockets.asyncio.server
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from app.ui.viser_patches import (
    LOOPBACK,
    PHONE_WIDTH,
    SECRET_HEADER,
    VISER_PAGE,
    start_private_viser,
    view_page,
)

PAGE = VISER_PAGE.read_text(encoding="utf-8")


@pytest.mark.parametrize("mark", ["<head>", "</head>", "<body>", 'id="root"'])
def test_visers_page_has_what_ours_is_hung_on(mark: str) -> None:
    assert mark in PAGE


def test_our_additions_are_in_the_page_once() -> None:
    page = view_page().decode()
    assert len(page) > len(PAGE)
    assert page.count("pleat-ready") == 1
    assert page.count(PHONE_WIDTH) == PAGE.count(PHONE_WIDTH) + 1


def test_viser_still_has_no_option_to_ask_who_connects() -> None:
    """Once it has, the hook in its websocket server is to go."""
    assert set(inspect.signature(viser.ViserServer.__init__).parameters) <= {
        "self",
        "host",
        "port",
        "label",
        "verbose",
        "_deprecated_kwargs",
    }


@pytest.mark.anyio
async def test_the_port_wants_the_secret_and_websockets_serves_as_before() -> None:
    serve = websockets.asyncio.server.serve
    server, secret = start_private_viser()
    try:
        assert websockets.asyncio.server.serve is serve
        url = f"ws://{LOOPBACK}:{server.get_port()}"
        with pytest.raises(InvalidStatus):
            async with connect(url, proxy=None):
                pass
        async with connect(url, additional_headers={SECRET_HEADER: secret}, max_size=None, proxy=None) as inside:
            assert inside.response is not None and inside.response.status_code == 101
    finally:
        server.stop()
