"""A viser server that nobody but this process can talk to.

viser listens on a port of its own and asks nobody who they are, so any web page open in a browser on this
machine could connect to it and read the scene. A stage is reached through the one public address only: the
viser port wants a secret header, which our proxy knows and which no page can send along with a websocket.
viser has no option for that. It hands a `process_request` hook to `websockets.asyncio.server.serve` when it
starts, though, and while it starts we put our check in front of that hook.
"""

import contextlib
import hmac
import http
import secrets
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import rich
import viser
import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

LOOPBACK = "127.0.0.1"
SECRET_HEADER = "X-Pleat-Stage"

VISER_PAGE = Path(viser.__file__).parent / "client" / "build" / "index.html"
"""The page that stages are seen in: one file, everything in it."""

_Hook = Callable[[ServerConnection, Request], Response | None]
_starting = threading.Lock()


def start_private_viser() -> tuple[viser.ViserServer, str]:
    """A running viser server on a free loopback port, and the secret it wants in `SECRET_HEADER`."""
    secret = secrets.token_urlsafe(32)
    rich.get_console().quiet = True  # viser announces itself there; its address is of no use to anyone
    with _starting, _asking_for(secret):
        return viser.ViserServer(host=LOOPBACK, port=0, verbose=False), secret


@contextlib.contextmanager
def _asking_for(secret: str) -> Iterator[None]:
    serve: Any = websockets.asyncio.server.serve

    def guarded_serve(*args: Any, process_request: _Hook, **options: Any) -> Any:  # noqa: ANN401
        return serve(*args, process_request=_guarded(process_request, secret), **options)

    module: Any = websockets.asyncio.server
    module.serve = guarded_serve
    try:
        yield
    finally:
        module.serve = serve


def _guarded(hook: _Hook, secret: str) -> _Hook:
    def answer(connection: ServerConnection, request: Request) -> Response | None:
        given = "".join(request.headers.get_all(SECRET_HEADER))
        if hmac.compare_digest(given.encode(), secret.encode()):
            return hook(connection, request)
        return Response(http.HTTPStatus.FORBIDDEN, "Forbidden", Headers({"Content-Length": "0"}))

    return answer
