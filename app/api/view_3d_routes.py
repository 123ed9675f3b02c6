"""The proxy to 3D views: page and websocket under `/viser/{document}`, passed on to the document's viser server.

The page is one file, the same for all 3D views. It works out where its websocket is from its own address less the
trailing slash, so page and websocket differ by that slash alone. A page whose 3D view the processor draws asks for it
under `/viser/{document}/by-software`.
"""

import asyncio
import contextlib

from fastapi import APIRouter, Request, WebSocket
from fastapi.concurrency import run_in_threadpool
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.websockets import WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, WebSocketException
from websockets.typing import Subprotocol

from app.api.asker import workspace_of
from app.api.shared import is_shared, until_revoked
from app.ui.view_3d import View3D
from app.ui.viser_patches import LOOPBACK, SECRET_HEADER, view_page
from app.workspace import Workspace
from planner.errors import FoldingError

router = APIRouter(prefix="/viser", include_in_schema=False)

_GOING_AWAY = 1001
_NOT_FOUND = 4404


@router.get("/{name}/")
@router.get("/{name}/by-software/")
async def read_view_page(request: Request, name: str) -> Response:
    """Return the page that shows a 3D view."""
    await run_in_threadpool(workspace_of(request).opened, name)
    return HTMLResponse(view_page(has_session=not is_shared(request.scope)), headers={"cache-control": "no-cache"})


@router.get("/{name}")
@router.get("/{name}/by-software")
async def redirect_to_view_page(request: Request, name: str) -> Response:
    """Redirect to the page's address, which has a slash at the end."""
    await run_in_threadpool(workspace_of(request).opened, name)
    return RedirectResponse(request.url.path + "/")


@router.websocket("/{name}")
@router.websocket("/{name}/")
async def connect_view(websocket: WebSocket, name: str) -> None:
    """Pass messages on, both ways, until either side closes."""
    await _connect(websocket, name, is_by_software=False)


@router.websocket("/{name}/by-software")
@router.websocket("/{name}/by-software/")
async def connect_view_by_software(websocket: WebSocket, name: str) -> None:
    """Pass messages on as `connect_view` does, for a page whose processor draws the 3D view."""
    await _connect(websocket, name, is_by_software=True)


async def _connect(websocket: WebSocket, name: str, *, is_by_software: bool) -> None:
    workspace: Workspace = websocket.app.state.workspace
    try:
        opened = await run_in_threadpool(workspace.opened, name)
    except FoldingError:
        await websocket.close(_NOT_FOUND)
        return
    with opened.in_use(), contextlib.suppress(OSError, WebSocketException, WebSocketDisconnect):
        show = opened.show_to_visitors if is_shared(websocket.scope) else opened.show
        view = await run_in_threadpool(show)
        async with _dial(view, websocket.scope["subprotocols"]) as inner:
            await websocket.accept(subprotocol=inner.subprotocol)
            with view.drawn_by_software() if is_by_software else contextlib.nullcontext():
                await _pass_on(websocket, inner, workspace)


def _dial(view: View3D, subprotocols: list[str]) -> connect:
    return connect(
        f"ws://{LOOPBACK}:{view.port}",
        additional_headers={SECRET_HEADER: view.secret},
        subprotocols=[Subprotocol(protocol) for protocol in subprotocols] or None,
        max_size=None,
        compression=None,
        ping_interval=None,
        proxy=None,
    )


async def _pass_on(outer: WebSocket, inner: ClientConnection, workspace: Workspace) -> None:
    """Pass messages on in both directions, each sent before the next is taken, so that neither side is flooded.

    Those of a visitor by a link are dropped: a 3D view makes no session of one who may only look.
    """
    ways = [
        asyncio.create_task(_dropped(outer) if is_shared(outer.scope) else _inwards(outer, inner)),
        asyncio.create_task(_outwards(outer, inner)),
        asyncio.create_task(until_revoked(outer, workspace.shares)),
    ]
    try:
        await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for way in ways:
            way.cancel()
        await asyncio.gather(*ways, return_exceptions=True)
        with contextlib.suppress(RuntimeError, WebSocketDisconnect):
            await outer.close(_GOING_AWAY)


async def _inwards(outer: WebSocket, inner: ClientConnection) -> None:
    with contextlib.suppress(WebSocketDisconnect, ConnectionClosed):
        async for message in outer.iter_bytes():
            await inner.send(message)


async def _dropped(outer: WebSocket) -> None:
    with contextlib.suppress(WebSocketDisconnect):
        async for _ in outer.iter_bytes():
            pass


async def _outwards(outer: WebSocket, inner: ClientConnection) -> None:
    with contextlib.suppress(WebSocketDisconnect, ConnectionClosed):
        async for message in inner:
            await (outer.send_bytes(message) if isinstance(message, bytes) else outer.send_text(message))
