"""A window with a hand on what goes over its websocket."""

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from playwright.sync_api import Page, WebSocketRoute

Message = dict[str, Any]

_PATIENCE_S = 30
_BREATH_MS = 20


class Channel:
    """The websocket of a page.

    Attributes:
        sent: what the page has sent.
        take: called with what the page sends, and with a function that answers it in the server's place; what it
            returns true for goes to the server.
        hear: called with what the server sends; what it returns true for goes to the page.
    """

    def __init__(self, page: Page) -> None:
        self.sent: list[Message] = []
        self.take: Callable[[Message, Callable[[Message], None]], bool] = lambda _sent, _answer: True
        self.hear: Callable[[Message], bool] = lambda _heard: True
        self._page = page
        self._page_end: WebSocketRoute | None = None
        self._server_end: WebSocketRoute | None = None
        page.route_web_socket("**/live", self._connect)

    def asked(self, do: str) -> list[Message]:
        """Return what the page has sent of one kind."""
        return [sent for sent in self.sent if sent["do"] == do]

    def first_asked(self, do: str) -> Message:
        """Return the first that the page has sent of one kind; wait for it, as what the page shows is there before."""
        deadline = time.monotonic() + _PATIENCE_S
        while not (asked := self.asked(do)):
            assert time.monotonic() < deadline, f"the page has not asked for {do!r}"
            self._page.wait_for_timeout(_BREATH_MS)
        return asked[0]

    def pass_on(self, sent: Message) -> None:
        """Send to the server what was held back."""
        assert self._server_end is not None
        self._server_end.send(json.dumps(sent))

    def cut(self) -> None:
        """Close the connection; the page comes back by itself."""
        assert self._page_end is not None
        assert self._server_end is not None
        self._server_end.close()
        self._page_end.close()

    def _connect(self, page_end: WebSocketRoute) -> None:
        server_end = page_end.connect_to_server()
        self._page_end, self._server_end = page_end, server_end

        def to_server(text: str | bytes) -> None:
            sent = json.loads(text)
            self.sent.append(sent)
            if self.take(sent, lambda told: page_end.send(json.dumps({"ask": sent["ask"], **told}))):
                server_end.send(text)

        def to_page(text: str | bytes) -> None:
            if self.hear(json.loads(text)):
                page_end.send(text)

        page_end.on_message(to_server)
        server_end.on_message(to_page)


@contextmanager
def listened_to(page: Page, url: str) -> Iterator[tuple[Page, Channel]]:
    """Open a document in another window of the same browser; return the window and its channel."""
    window = page.context.new_page()
    channel = Channel(window)
    window.goto(url)
    yield window, channel
    window.close()
