"""A limit to the requests of one client: a bucket of tokens that fills at a steady rate.

Files of the page are not counted: a page loads a hundred at once. This machine's own programs and pages are not limited
either: there is nobody else whom they could keep waiting.
"""

import ipaddress
import math
import time
from collections import OrderedDict

from starlette.types import ASGIApp, Receive, Scope, Send

from app.api.problems import ProblemResponse

TOO_MANY = 429
BURST_S = 4.0
"""Seconds' worth of requests that a client may send at once."""

CLIENTS_MAX = 10_000
"""Number of clients remembered."""

_NOT_COUNTED = ("/static", "/viser/")


class ClientLimits:
    """Middleware that refuses requests of a client that sends too many."""

    def __init__(self, app: ASGIApp, requests_per_s: float) -> None:
        """Allow each client this rate in the long run."""
        self._app = app
        self._rate = requests_per_s
        self._buckets: OrderedDict[str, tuple[float, float]] = OrderedDict()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or say when to come again."""
        wait_s = self._wait_s(scope) if scope["type"] == "http" else 0.0
        if wait_s <= 0.0:
            await self._app(scope, receive, send)
            return
        retry_after_s = math.ceil(wait_s)
        detail = f"These are more than {self._rate:g} requests a second; try again in {retry_after_s} s."
        await ProblemResponse(TOO_MANY, detail, headers={"retry-after": str(retry_after_s)})(scope, receive, send)

    def _wait_s(self, scope: Scope) -> float:
        """Count a request; return the time until its client may send another, 0 if this one may pass."""
        client = scope["client"][0] if scope.get("client") else ""
        path = scope["path"].removeprefix(scope.get("root_path", ""))
        if _is_loopback(client) or path.startswith(_NOT_COUNTED):
            return 0.0
        now_s, full = time.monotonic(), self._rate * BURST_S
        left, at_s = self._buckets.pop(client, (full, now_s))
        left = min(full, left + (now_s - at_s) * self._rate)
        passes = left >= 1.0
        self._buckets[client] = (left - 1.0 if passes else left, now_s)
        while len(self._buckets) > CLIENTS_MAX:
            self._buckets.popitem(last=False)
        return 0.0 if passes else (1.0 - left) / self._rate


def _is_loopback(client: str) -> bool:
    try:
        return ipaddress.ip_address(client).is_loopback
    except ValueError:
        return False
