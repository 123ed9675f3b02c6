"""Answers our own pages only.

Any page in a browser on this machine can send requests to a loopback port, and under a name that resolves to
127.0.0.1 it is even of "the same origin". So the `Host` must be one of our own names, and an `Origin`, when
there is one, one of our own pages. Everything else is refused, websockets before they open.
"""

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.problems import ProblemResponse

MISDIRECTED, FORBIDDEN = 421, 403
_WHY = {
    MISDIRECTED: "The header Host names none of this server's own names.",
    FORBIDDEN: "The header Origin names a page of another server.",
}
_POLICY_VIOLATION = 1008
_LOOPBACK_NAMES = ("127.0.0.1", "localhost", "[::1]")
_HTTP_PORT = 80
_HARDENING = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "content-security-policy": "frame-ancestors 'self'",
}


class OwnNamesOnly:
    """Middleware round everything, for HTTP and websockets alike."""

    def __init__(self, app: ASGIApp, host: str, port: int) -> None:
        """Let through what is addressed to `host` or a loopback name, at this port."""
        self._app = app
        self._names = own_names(host, port)
        self._origins = frozenset(f"http://{name}" for name in self._names)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on or refuse."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(Headers(scope=scope))
        if refusal is None:
            await self._app(scope, receive, _hardened(send))
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": _POLICY_VIOLATION})
        else:
            await ProblemResponse(refusal, _WHY[refusal])(scope, receive, send)

    def _refusal(self, headers: Headers) -> int | None:
        hosts = headers.getlist("host")
        if len(hosts) != 1 or hosts[0].lower() not in self._names:
            return MISDIRECTED
        if any(origin.lower() not in self._origins for origin in headers.getlist("origin")):
            return FORBIDDEN
        return None


def own_names(host: str, port: int) -> frozenset[str]:
    """The values of `Host` that mean this server: names with the port, without it if it is HTTP's own."""
    given = f"[{host}]" if ":" in host and not host.startswith("[") else host
    names = {*_LOOPBACK_NAMES, given.lower()}
    own = {f"{name}:{port}" for name in names}
    return frozenset(own | names if port == _HTTP_PORT else own)


def _hardened(send: Send) -> Send:
    async def send_hardened(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in _HARDENING.items():
                headers.setdefault(name, value)
        await send(message)

    return send_hardened
