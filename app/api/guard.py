"""Refusal of requests from other pages.

Any page in a browser on this machine can send requests to a loopback port, and under a name that resolves to
127.0.0.1 it is even of "the same origin". So the `Host` must be one of our own names, and an `Origin`, when
there is one, one of our own pages. Images, scripts and frames of other pages come without an `Origin`: browsers
tell them by `Sec-Fetch-Site`. All these are refused, websockets before they open. A link on another page may still
lead to one of our pages.

A proxy has another name. One that passes our own on as `Host` says its own in `X-Forwarded-Host`, which no foreign page
can send: browsers would ask first, and are not allowed. For one that passes its own name on there is a setting.
"""

import ipaddress
import socket
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.problems import ProblemResponse
from app.settings import Settings

MISDIRECTED, FORBIDDEN = 421, 403
_FOREIGN_NAME = (MISDIRECTED, "The header Host names none of this server's own names.")
_FOREIGN_ORIGIN = (FORBIDDEN, "The header Origin names a page of another server.")
_FOREIGN_SITE = (FORBIDDEN, "The header Sec-Fetch-Site says that a page of another server asks.")
_OWN_SITES = frozenset({"same-origin", "none"})
"""Values of `Sec-Fetch-Site` that are accepted; `none` is the user's own doing, such as a typed address."""

_NOT_PAGES = ("/api/", "/viser/")
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
    """Middleware that refuses foreign requests, for HTTP and websockets alike."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        """Accept requests to the host that is served, a loopback name or the proxy, at this port."""
        own = own_names(settings.host, settings.port)
        proxy = [] if settings.origin is None else [settings.origin.lower()]
        self._app = app
        self._names = own | {urlsplit(origin).netloc for origin in proxy}
        self._origins = {f"http://{name}" for name in own} | set(proxy)
        self._is_anywhere = _is_wildcard(settings.host)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(scope, Headers(scope=scope))
        if refusal is None:
            await self._app(scope, receive, _hardened(send))
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": _POLICY_VIOLATION})
        else:
            await ProblemResponse(*refusal)(scope, receive, send)

    def _refusal(self, scope: Scope, headers: Headers) -> tuple[int, str] | None:
        """Return status and sentence of a refusal; None for a request to be answered."""
        hosts = headers.getlist("host")
        if len(hosts) != 1 or not self._is_own_name(hosts[0].lower()):
            return _FOREIGN_NAME
        if not all(self._is_own_page(origin.lower(), headers) for origin in headers.getlist("origin")):
            return _FOREIGN_ORIGIN
        is_own = all(site.lower() in _OWN_SITES for site in headers.getlist("sec-fetch-site"))
        return None if is_own or _is_link(scope, headers) else _FOREIGN_SITE

    def _is_own_name(self, host: str) -> bool:
        return host in self._names or (self._is_anywhere and _is_address(host))

    def _is_own_page(self, origin: str, headers: Headers) -> bool:
        if origin in self._origins:
            return True
        at_proxy = headers.get("x-forwarded-host", "").lower()
        if at_proxy and origin in (f"http://{at_proxy}", f"https://{at_proxy}"):
            return True
        return self._is_anywhere and origin == f"http://{headers['host'].lower()}"


def own_names(host: str, port: int) -> frozenset[str]:
    """Return the values of `Host` that mean this server: names with the port, without it if it is HTTP's own."""
    given = f"[{host}]" if ":" in host and not host.startswith("[") else host
    names = {*_LOOPBACK_NAMES, given.lower()}
    if _is_wildcard(host):
        names |= {socket.gethostname().lower(), socket.getfqdn().lower()}
    own = {f"{name}:{port}" for name in names}
    return frozenset(own | names if port == _HTTP_PORT else own)


def _is_link(scope: Scope, headers: Headers) -> bool:
    """Return whether a whole window goes to one of the pages, which starts no work."""
    path = scope["path"].removeprefix(scope.get("root_path", ""))
    is_page = scope["type"] == "http" and not path.startswith(_NOT_PAGES)
    is_window = headers.get("sec-fetch-mode") == "navigate" and headers.get("sec-fetch-dest") == "document"
    return is_page and is_window and scope["method"] in ("GET", "HEAD")


def _is_wildcard(host: str) -> bool:
    """Return whether a host name stands for all addresses of this machine."""
    try:
        return ipaddress.ip_address(host).is_unspecified
    except ValueError:
        return False


def _is_address(host: str) -> bool:
    """Return whether a `Host` is an address: only names can be made to resolve to this machine by others."""
    try:
        ipaddress.ip_address(urlsplit(f"//{host}").hostname or "")
    except ValueError:
        return False
    return True


def _hardened(send: Send) -> Send:
    async def send_hardened(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in _HARDENING.items():
                headers.setdefault(name, value)
        await send(message)

    return send_hardened
