"""Limits to one client: its requests, by a bucket of tokens that fills at a steady rate, and its open websockets.

Files of the page are not counted: a page loads a hundred at once. This machine's own programs and pages are not limited
either: there is nobody else whom they could keep waiting.
"""

import asyncio
import ipaddress
import math
import time
from collections import Counter, OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.problems import ProblemResponse
from app.jobs.limits import CLIENT

TOO_MANY = 429
BURST_S = 4.0
"""Seconds' worth of requests that a client may send at once."""

CLIENTS_MAX = 10_000
"""Number of clients remembered."""

WEBSOCKET_RETRY_S = 10
"""Time after which a client may try again to open one more websocket (s)."""

_WEBSOCKET_ANSWERS = "websocket.http.response"
_TRY_AGAIN_LATER = 1013
_NOT_COUNTED = ("/static", "/viser/")


class ClientLimits:
    """Middleware that refuses requests of a client that sends too many, and websockets of one that has too many open.

    Messages on a websocket count as requests do; those that are too many wait for their turn.

    What answers the others knows from `CLIENT` whose limits hold.
    """

    def __init__(self, app: ASGIApp, requests_per_s: float, connections: int) -> None:
        """Allow each client this rate in the long run, and as many websockets at once."""
        self._app = app
        self._rate = requests_per_s
        self._connections = connections
        self._open: Counter[str] = Counter()
        self._buckets: OrderedDict[str, tuple[float, float]] = OrderedDict()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or say when to come again."""
        client = _limited(scope)
        if client is None:
            await self._app(scope, receive, send)
        elif scope["type"] == "websocket":
            await self._connect(client, scope, receive, send)
        else:
            await self._answer(client, scope, receive, send)

    async def _answer(self, client: str, scope: Scope, receive: Receive, send: Send) -> None:
        wait_s = self._wait_s(client, scope)
        if wait_s <= 0.0:
            with _known(client):
                await self._app(scope, receive, send)
            return
        retry_after_s = math.ceil(wait_s)
        detail = f"These are more than {self._rate:g} requests a second; try again in {retry_after_s} s."
        await ProblemResponse(TOO_MANY, detail, headers={"retry-after": str(retry_after_s)})(scope, receive, send)

    async def _connect(self, client: str, scope: Scope, receive: Receive, send: Send) -> None:
        if self._open[client] >= self._connections:
            if _WEBSOCKET_ANSWERS not in scope.get("extensions", {}):
                await send({"type": "websocket.close", "code": _TRY_AGAIN_LATER})
                return
            detail = f"There are {self._connections} open websockets of yours already; close some first."
            headers = {"retry-after": str(WEBSOCKET_RETRY_S)}
            await ProblemResponse(TOO_MANY, detail, headers=headers)(scope, receive, send)
            return
        self._open[client] += 1

        async def receive_in_turn() -> Message:
            message = await receive()
            while message["type"] == "websocket.receive" and (wait_s := self._wait_s(client, scope)) > 0.0:
                await asyncio.sleep(wait_s)
            return message

        try:
            with _known(client):
                await self._app(scope, receive_in_turn, send)
        finally:
            self._open[client] -= 1
            if not self._open[client]:
                del self._open[client]

    def _wait_s(self, client: str, scope: Scope) -> float:
        """Count a request; return the time until its client may send another, 0 if this one may pass."""
        path = scope["path"].removeprefix(scope.get("root_path", ""))
        if path.startswith(_NOT_COUNTED):
            return 0.0
        now_s, full = time.monotonic(), self._rate * BURST_S
        left, at_s = self._buckets.pop(client, (full, now_s))
        left = min(full, left + (now_s - at_s) * self._rate)
        passes = left >= 1.0
        self._buckets[client] = (left - 1.0 if passes else left, now_s)
        while len(self._buckets) > CLIENTS_MAX:
            self._buckets.popitem(last=False)
        return 0.0 if passes else (1.0 - left) / self._rate


def _limited(scope: Scope) -> str | None:
    """Return the client's address; None for this machine and for requests that name no client."""
    if scope["type"] not in ("http", "websocket"):
        return None
    client: str = scope["client"][0] if scope.get("client") else ""
    return None if _is_loopback(client) else client


@contextmanager
def _known(client: str) -> Iterator[None]:
    before = CLIENT.set(client)
    try:
        yield
    finally:
        CLIENT.reset(before)


def _is_loopback(client: str) -> bool:
    try:
        return ipaddress.ip_address(client).is_loopback
    except ValueError:
        return False
