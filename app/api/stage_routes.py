"""The way to a stage: its page and websocket under `/viser/{document}`, passed on to its own viser server.

The page is one file, the same for all stages. It works out where its websocket is from its own address less
the trailing slash, so page and websocket differ by that slash alone. Its notices, and on a phone its panel of
controls, have no place in our frame: the style that we add hides all but the canvas and the panels that float, and lays
the board's ground behind them. A
frame is narrower than a window, so what viser takes for a phone is made narrower too.

viser's labels are black on white whatever the ground: their shaders are given the page's own colours, light on dark,
which can be read on either.

Until the visitor's panel is there, viser shows one with the address of the websocket. So the frame tells the page when
its own panel has come, and the page covers it until then.

A page that has its stage drawn by the processor asks for it under `/viser/{document}/by-software`.
"""

import asyncio
import contextlib
import functools

from fastapi import APIRouter, Request, WebSocket
from fastapi.concurrency import run_in_threadpool
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.websockets import WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, WebSocketException
from websockets.typing import Subprotocol

from app.api.asked import workspace_of
from app.ui.editor.seat import PANEL_LABEL
from app.ui.private_viser import LOOPBACK, SECRET_HEADER, VISER_PAGE
from app.ui.stage import Stage
from app.workspace import Workspace
from planner.errors import FoldingError

router = APIRouter(prefix="/viser", include_in_schema=False)

SEATED = "pleat-seated"
"""What the frame tells the page once the visitor's own panel is there."""

_GOING_AWAY = 1001
_NOT_FOUND = 4404
_HIDE = (
    b"<style>#root * { visibility: hidden }"
    b"#root canvas, #root canvas ~ div, #root canvas ~ div *, "
    b"#root [data-dock-root], #root [data-dock-root] * { visibility: visible }</style>"
)
_GROUND = (
    b"<style>body { background: #fafaf8 !important }"
    b' [data-mantine-color-scheme="dark"] body { background: #16181c !important }</style>'
)
_NARROW = (
    b"<script>{ const asked = window.matchMedia.bind(window);"
    b' window.matchMedia = (query) => asked(query.replace("(max-width: 36em)", "(max-width: 25em)")); }</script>'
)
_LABELS = b"""<script>{
  const colours = {
    "vec4(1.0, 1.0, 1.0, 0.85 * vAlpha)": "vec4(0.114, 0.125, 0.145, 0.85 * vAlpha)",
    "vec4(0.0, 0.0, 0.0, a)": "vec4(0.925, 0.922, 0.902, a)",
  };
  const recoloured = new Set();
  for (const kind of [WebGLRenderingContext, WebGL2RenderingContext]) {
    const give = kind.prototype.shaderSource;
    kind.prototype.shaderSource = function (shader, text) {
      for (const [theirs, ours] of Object.entries(colours)) {
        if (!text.includes(theirs)) continue;
        text = text.replace(theirs, ours);
        recoloured.add(theirs);
      }
      document.documentElement.dataset.recoloured = recoloured.size;
      return give.call(this, shader, text);
    };
  }
}</script>"""
_SEATED = f"""<script>{{
  const isSeated = () => [...document.querySelectorAll("#root *")].some(
    (part) => !part.childElementCount && part.textContent === "{PANEL_LABEL}");
  const watch = new MutationObserver(() => {{
    if (!isSeated()) return;
    watch.disconnect();
    parent.postMessage("{SEATED}", location.origin);
  }});
  watch.observe(document.documentElement, {{ childList: true, subtree: true, characterData: true }});
}}</script>""".encode()


@router.get("/{name}/")
@router.get("/{name}/by-software/")
async def read_stage_page(request: Request, name: str) -> Response:
    """The page that shows a stage."""
    await run_in_threadpool(workspace_of(request).opened, name)
    return HTMLResponse(_bare_page(), headers={"cache-control": "no-cache"})


@router.get("/{name}")
@router.get("/{name}/by-software")
async def redirect_to_stage_page(request: Request, name: str) -> Response:
    """The page's address has a slash at the end."""
    await run_in_threadpool(workspace_of(request).opened, name)
    return RedirectResponse(request.url.path + "/")


@router.websocket("/{name}")
@router.websocket("/{name}/")
async def connect_stage(websocket: WebSocket, name: str) -> None:
    """Pass messages on, both ways, until either side is done."""
    await _connect(websocket, name, is_by_software=False)


@router.websocket("/{name}/by-software")
@router.websocket("/{name}/by-software/")
async def connect_stage_by_software(websocket: WebSocket, name: str) -> None:
    """The same for a page whose processor draws the stage."""
    await _connect(websocket, name, is_by_software=True)


async def _connect(websocket: WebSocket, name: str, *, is_by_software: bool) -> None:
    workspace: Workspace = websocket.app.state.workspace
    try:
        opened = await run_in_threadpool(workspace.opened, name)
    except FoldingError:
        await websocket.close(_NOT_FOUND)
        return
    with opened.in_use(), contextlib.suppress(OSError, WebSocketException, WebSocketDisconnect):
        stage = await run_in_threadpool(opened.show)
        async with _dial(stage, websocket.scope["subprotocols"]) as inner:
            await websocket.accept(subprotocol=inner.subprotocol)
            with stage.drawn_by_software() if is_by_software else contextlib.nullcontext():
                await _pass_on(websocket, inner)


@functools.lru_cache(maxsize=1)
def _bare_page() -> bytes:
    styled = VISER_PAGE.read_bytes().replace(b"</head>", _HIDE + _GROUND + b"</head>", 1)
    return styled.replace(b"<head>", b"<head>" + _NARROW + _LABELS + _SEATED, 1)


def _dial(stage: Stage, subprotocols: list[str]) -> connect:
    return connect(
        f"ws://{LOOPBACK}:{stage.port}",
        additional_headers={SECRET_HEADER: stage.secret},
        subprotocols=[Subprotocol(protocol) for protocol in subprotocols] or None,
        max_size=None,
        compression=None,
        ping_interval=None,
        proxy=None,
    )


async def _pass_on(outer: WebSocket, inner: ClientConnection) -> None:
    """Both directions at once; each sends one message before it takes the next, so neither side floods."""
    ways = [asyncio.create_task(_inwards(outer, inner)), asyncio.create_task(_outwards(outer, inner))]
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


async def _outwards(outer: WebSocket, inner: ClientConnection) -> None:
    with contextlib.suppress(WebSocketDisconnect, ConnectionClosed):
        async for message in inner:
            await (outer.send_bytes(message) if isinstance(message, bytes) else outer.send_text(message))
