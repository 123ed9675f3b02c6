"""Middleware for all requests, whatever the route: served below a prefix, read to their end, `HEAD` as `GET`."""

import re
from collections.abc import Iterable

from starlette.datastructures import Headers
from starlette.responses import RedirectResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

PREFIX_PATTERN = re.compile(r"(/[A-Za-z0-9._~-]+)*")
_HEADER = b"x-forwarded-prefix"

DROPPED_MAX = 256 << 20
"""How much of a body is dropped (bytes); beyond it the connection is cut off."""


class BelowPrefix:
    """Middleware that tells the routes the prefix below which they are served, as behind a proxy with several servers.

    Pages and scripts name everything relative to themselves, so they need not know the prefix. Redirects, `Location`
    and the description of the interface do: ASGI calls the prefix `root_path`. It comes from the settings, or from the
    proxy with each request, in `X-Forwarded-Prefix`. The proxy may have taken it off the path or not.
    """

    def __init__(self, app: ASGIApp, prefix: str) -> None:
        """Serve below this prefix whatever comes without the proxy's header."""
        self._app = app
        self._prefix = prefix

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Call the routes with `root_path` and the whole path in the scope."""
        prefix = self._prefix if scope["type"] == "lifespan" else _prefix_in(scope["headers"], self._prefix)
        if not prefix:
            await self._app(scope, receive, send)
        elif scope.get("path") == prefix and scope["type"] == "http":
            await RedirectResponse(f"{prefix}/")(scope, receive, send)
        else:
            await self._app({**scope, "root_path": prefix, **_whole_path(scope, prefix)}, receive, send)


class WholeRequests:
    """Middleware that begins no answer before the request has come to its end, as that to a body that is too large.

    A server that answers and closes while the other side still sends makes its system discard the answer: the client
    sees a connection that was cut off. So the rest is read and dropped before the answer begins, up to `DROPPED_MAX`.
    A client that has asked whether to send its body (`Expect: 100-continue`) is answered at once.
    """

    def __init__(self, app: ASGIApp) -> None:
        """Wrap everything that may refuse a request."""
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, and read what is left of its body before the answer."""
        if scope["type"] != "http" or "expect" in Headers(scope=scope):
            await self._app(scope, receive, send)
            return
        has_ended = False

        async def receive_noted() -> Message:
            nonlocal has_ended
            message = await receive()
            has_ended = has_ended or message["type"] != "http.request" or not message.get("more_body", False)
            return message

        async def send_later(message: Message) -> None:
            left = DROPPED_MAX
            while message["type"] == "http.response.start" and not has_ended and left > 0:
                left -= len((await receive_noted()).get("body", b""))
            await send(message)

        await self._app(scope, receive_noted, send_later)


class HeadAsGet:
    """Middleware that answers `HEAD` as `GET`, without the body."""

    def __init__(self, app: ASGIApp) -> None:
        """Wrap the routes."""
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Call the routes, and drop the body of an answer to `HEAD`."""
        if scope["type"] != "http" or scope["method"] != "HEAD":
            await self._app(scope, receive, send)
            return

        async def send_head(message: Message) -> None:
            await send({**message, "body": b""} if message["type"] == "http.response.body" else message)

        await self._app({**scope, "method": "GET"}, receive, send_head)


def _prefix_in(headers: Iterable[tuple[bytes, bytes]], otherwise: str) -> str:
    """Return the prefix in the proxy's header; empty if it would lead to another host."""
    for name, value in headers:
        prefix = value.decode("latin-1").strip().rstrip("/")
        if name == _HEADER and PREFIX_PATTERN.fullmatch(prefix):
            return prefix
    return otherwise


def _whole_path(scope: Scope, prefix: str) -> dict[str, str]:
    path = scope.get("path", "")
    return {"path": path if path.startswith(f"{prefix}/") else prefix + path} if path else {}
