"""Serving below a prefix, as behind a proxy that shows several servers at one address.

Pages and scripts name everything relative to themselves, so they need not know the prefix. Redirects, `Location` and
the description of the interface do: ASGI calls the prefix `root_path`. It comes from the settings, or from the proxy
with each request, in `X-Forwarded-Prefix`. The proxy may have taken it off the path or not.
"""

import re
from collections.abc import Iterable

from starlette.responses import RedirectResponse
from starlette.types import ASGIApp, Receive, Scope, Send

PREFIX_PATTERN = re.compile(r"(/[A-Za-z0-9._~-]+)*")
_HEADER = b"x-forwarded-prefix"


class BelowPrefix:
    """Middleware that tells the routes the prefix below which they are served."""

    def __init__(self, app: ASGIApp, prefix: str) -> None:
        """Serve below this prefix whatever comes without the proxy's header."""
        self._app = app
        self._prefix = prefix

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Call the routes with `root_path` and the whole path in the scope."""
        prefix = self._prefix if scope["type"] == "lifespan" else _told(scope["headers"], self._prefix)
        if not prefix:
            await self._app(scope, receive, send)
        elif scope.get("path") == prefix and scope["type"] == "http":
            await RedirectResponse(f"{prefix}/")(scope, receive, send)
        else:
            await self._app({**scope, "root_path": prefix, **_whole_path(scope, prefix)}, receive, send)


def _told(headers: Iterable[tuple[bytes, bytes]], otherwise: str) -> str:
    """Return the prefix of the proxy's header, or none if it would lead to another host."""
    for name, value in headers:
        prefix = value.decode("latin-1").strip().rstrip("/")
        if name == _HEADER and PREFIX_PATTERN.fullmatch(prefix):
            return prefix
    return otherwise


def _whole_path(scope: Scope, prefix: str) -> dict[str, str]:
    path = scope.get("path", "")
    return {"path": path if path.startswith(f"{prefix}/") else prefix + path} if path else {}
