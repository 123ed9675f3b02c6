"""All changes to viser, with their reasons; `tests/app/test_viser_patches.py` fails where viser changes under them.

**A server that only this process can reach.** viser listens on a port of its own without authentication, so any web
page open in a browser on this machine could connect to it and read the scene. A 3D view is reached through the public
address only: the viser port requires a secret header, which our proxy knows and which no page can send along with a
websocket. viser has no option for that, and makes its websocket server inside a function, so no subclass can change it.
But when it starts it passes a `process_request` hook to `websockets.asyncio.server.serve`, and during the start we put
our check in front of that hook.

**A page that fits into ours.** viser's page is one built file without options for its looks. Its notices, and on a
phone its panel of controls, have no place in our frame: the style that we add hides everything but the canvas and the
floating panels, and puts the board's background behind them. A frame is narrower than a window, so the width below
which viser assumes a phone is reduced. Its labels are black on white on every background: their shaders get the page's
own colours, light on dark, which are legible on both. Until the visitor's panel is there, viser shows one with the
address of the websocket; so the frame tells our page when its own panel has come, and our page covers it until then.
"""

import contextlib
import functools
import hmac
import http
import json
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

from app.language import LANGUAGES, say

LOOPBACK = "127.0.0.1"
SECRET_HEADER = "X-Pleat-View"

VISER_PAGE = Path(viser.__file__).parent / "client" / "build" / "index.html"
"""The page that shows a 3D view: a single self-contained file."""

PANEL = "panel.label"
"""The key of the label by which the visitor's panel is found, in any language."""

SESSION_STARTED = "pleat-session-started"
"""The frame's message to the page once the visitor's own panel is there."""

PHONE_WIDTH = "(max-width: 36em)"
"""The media query with which viser's page recognises a phone."""

_HIDE = (
    b"<style>#root * { visibility: hidden }"
    b"#root canvas, #root canvas ~ div, #root canvas ~ div * { visibility: visible }</style>"
)
_PANELS = b"<style>#root [data-dock-root], #root [data-dock-root] * { visibility: visible }</style>"
_GROUND = (
    b"<style>body { background: #fafaf8 !important }"
    b' [data-mantine-color-scheme="dark"] body { background: #16181c !important }</style>'
)
_NARROW = f"""<script>{{ const asked = window.matchMedia.bind(window);
 window.matchMedia = (query) => asked(query.replace("{PHONE_WIDTH}", "(max-width: 25em)")); }}</script>""".encode()
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
_WITHOUT_SESSION = f"""<script>{{
  const watch = new MutationObserver(() => {{
    if (!document.querySelector("#root canvas")) return;
    watch.disconnect();
    parent.postMessage("{SESSION_STARTED}", location.origin);
  }});
  watch.observe(document.documentElement, {{ childList: true, subtree: true }});
}}</script>""".encode()
_WITH_SESSION = f"""<script>{{
  const labels = {json.dumps([say(language, PANEL) for language in LANGUAGES])};
  const hasSession = () => [...document.querySelectorAll("#root *")].some(
    (part) => !part.childElementCount && labels.includes(part.textContent));
  const watch = new MutationObserver(() => {{
    if (!hasSession()) return;
    watch.disconnect();
    parent.postMessage("{SESSION_STARTED}", location.origin);
  }});
  watch.observe(document.documentElement, {{ childList: true, subtree: true, characterData: true }});
}}</script>""".encode()


_Hook = Callable[[ServerConnection, Request], Response | None]
_starting = threading.Lock()


def start_private_viser() -> tuple[viser.ViserServer, str]:
    """Start a viser server on a free loopback port; return it and the secret it requires in `SECRET_HEADER`."""
    secret = secrets.token_urlsafe(32)
    rich.get_console().quiet = True  # viser prints its address there, which nobody can use
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


@functools.lru_cache(maxsize=2)
def view_page(*, has_session: bool = True) -> bytes:
    """Return the page that shows a 3D view: viser's page with our additions.

    Args:
        has_session: whether its visitor has a panel; one by a link has none, and viser's own has no place there.
    """
    styles = _HIDE + _GROUND + (_PANELS if has_session else b"")
    scripts = _NARROW + _LABELS + (_WITH_SESSION if has_session else _WITHOUT_SESSION)
    styled = VISER_PAGE.read_bytes().replace(b"</head>", styles + b"</head>", 1)
    return styled.replace(b"<head>", b"<head>" + scripts, 1)
