"""All changes to viser, with their reasons; `tests/app/test_viser_patches.py` fails where viser changes under them.

**A server that only this process can reach.** viser listens on a port of its own without authentication, so any web
page open in a browser on this machine could connect to it and read the scene. A 3D view is reached through the public
address only: the viser port requires a secret header, which our proxy knows and which no page can send along with a
websocket. viser has no option for that, and makes its websocket server inside a function, so no subclass can change it.
But when it starts it passes a `process_request` hook to `websockets.asyncio.server.serve`, and during the start we put
our check in front of that hook.

**A page that fits into ours.** viser's page is one built file without options for its looks. Its notices, and on a
phone panels of controls have no place in our frame: the style that we add hides everything but the canvas, and puts the
board's background behind it. A frame is narrower than a window, so the width below
which viser assumes a phone is reduced. The frame tells our page when there is a picture and, for those who may choose a
viewpoint, when the server knows them; our page covers it until then. A recording is such a page too, with a title
above, and of viser's player the button, the time and the time line.

**Cloth with threads.** A mesh of viser has one colour, or a texture with which all of it is sent anew in each picture.
A script in the page, and in recordings, has threads drawn along the pattern: see `static/weave.js`.
"""

import contextlib
import functools
import hmac
import html
import http
import re
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

from app.page_files import static_dir
from app.ui.viewpoints.viewpoint_choice import CHANNEL

LOOPBACK = "127.0.0.1"
SECRET_HEADER = "X-Pleat-View"

VISER_PAGE = Path(viser.__file__).parent / "client" / "build" / "index.html"
"""The page that shows a 3D view: a single self-contained file."""

READY = "pleat-ready"
"""The frame's message to the page once it can be looked at."""

PHONE_WIDTH = "(max-width: 36em)"
"""The media query with which viser's page recognises a phone."""

_HIDE = (
    b"<style>#root * { visibility: hidden }"
    b"#root canvas, #root canvas ~ div, #root canvas ~ div * { visibility: visible }</style>"
)
_GROUND = (
    b"<style>body { background: #fafaf8 !important }"
    b' [data-mantine-color-scheme="dark"] body { background: #16181c !important }</style>'
)
_NARROW = f"""<script>{{ const asked = window.matchMedia.bind(window);
 window.matchMedia = (query) => asked(query.replace("{PHONE_WIDTH}", "(max-width: 25em)")); }}</script>""".encode()
_BAR = "#root .mantine-Paper-root:has(> .mantine-Slider-root)"
_PLAYER = f"""<style>
body {{ display: flex; flex-direction: column; height: 100dvh; margin: 0 }}
body > h1 {{ margin: 0; padding: 10px 14px; font: 600 17px/1.3 system-ui, sans-serif; color: #1d1f23 }}
#root {{ flex: 1; min-height: 0; height: auto }}
{_BAR}, {_BAR} > :nth-child(-n + 3), {_BAR} > :nth-child(-n + 3) * {{ visibility: visible }}
{_BAR} {{ background: none; border: 0 !important; color: #1d1f23 }}
{_BAR} > :nth-child(n + 4) {{ display: none }}
{_BAR} button {{ color: inherit }}
{_BAR} input {{ background: none; border: 0; pointer-events: none; color: inherit }}
{_BAR} .mantine-Slider-bar {{ background: #0047a3 }}
[data-mantine-color-scheme="dark"] body > h1, [data-mantine-color-scheme="dark"] {_BAR} {{ color: #ecebe6 }}
[data-mantine-color-scheme="dark"] {_BAR} .mantine-Slider-bar {{ background: #7cc0ff }}
</style>
<script>{{
  const watch = setInterval(() => {{
    const bar = document.querySelector("{_BAR}");
    if (!bar) return;
    clearInterval(watch);
    bar.querySelector("button").setAttribute("aria-label", "Play or pause");
    bar.querySelector("[role=slider]")?.setAttribute("aria-label", "Time line");
    Object.assign(bar.querySelector("input"), {{ readOnly: true, tabIndex: -1, ariaLabel: "Seconds" }});
  }}, 50);
}}</script>"""
"""Of viser's bar the first three parts: button, time, time line; then come its speed and its tree of the scene."""

_TITLE = re.compile(r"<title>.*?</title>", re.DOTALL)

_TELL_READY = """<script>{
  const isReady = () => document.querySelector("#root canvas") && (%s);
  const watch = setInterval(() => {
    if (!isReady()) return;
    clearInterval(watch);
    parent.postMessage("%s", location.origin);
  }, 50);
}</script>"""
_HAS_SESSION = (
    f'Object.keys(window.__viserMutable?.nodeRefFromName ?? {{}}).some((name) => name.startsWith("{CHANNEL}"))'
)


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
        has_session: whether its viewpoint can be chosen; that of those who have a link cannot.
    """
    ready = _TELL_READY % (_HAS_SESSION if has_session else "true", READY)
    styled = VISER_PAGE.read_bytes().replace(b"</head>", _HIDE + _GROUND + weave().encode() + b"</head>", 1)
    return styled.replace(b"<head>", b"<head>" + _NARROW + ready.encode(), 1)


def recording_page(page: str, title: str) -> str:
    """Return a recording by viser with a title, and without what only those who make pages with viser need."""
    text = html.escape(title)
    head = f"<title>{text} - Pleat</title>{(_HIDE + _GROUND).decode()}{_PLAYER}{weave()}"
    before, after = page.rsplit("<body>", 1)
    return f"{_TITLE.sub(lambda _: head, before, count=1)}<body><h1>{text}</h1>{after}"


def weave() -> str:
    """Return what has threads drawn on cloth, for the head of a page of viser's."""
    script = (static_dir() / "weave.js").read_text(encoding="utf-8")
    return f'<script type="module">{script}</script>'
