"""Links to look at one document: `/s/TOKEN/` is the page below a prefix at which nothing can be changed.

The page and its scripts name everything relative to themselves, so they work below the link's prefix as they do below a
proxy's. Whoever has the link needs no token of the server, and is shown nothing but the document.
"""

import asyncio
import re

from fastapi import WebSocket
from fastapi.concurrency import run_in_threadpool
from starlette.types import ASGIApp, Receive, Scope, Send

from app.api.problems import LookOnlyError, ProblemResponse, folding_problem
from app.store.share_repository import ShareRepository
from planner.errors import FoldingError
from planner.robots.known_robots import shipped_robots

_TOKEN = "pleat.shared"
"""The key of the scope under which a request by a link has the link's token."""

_LINK = re.compile(r"(/s/([A-Za-z0-9_-]{8,80}))(/.*)")
_FOR_ALL = re.compile(r"/static/.*|/api/(health|scene|plans/[0-9a-f]{32}(/(pictures|timeline))?)")
"""Paths that every link may read besides its document's; nobody can guess the ids of plans."""

_ROBOT, _EARLIER = "/api/robots/", "versions"
"""Where robots' cards are, of which visitors are shown those that are shipped, and a document's earlier drawings."""

_NOT_FOUND, _FORBIDDEN, _POLICY_VIOLATION = 404, 403, 1008
_LOOK_EVERY_S = 5.0
"""Period at which an open connection looks whether its link still holds (s)."""


class Shared:
    """Middleware that lets those who have a link look at its document; all other requests pass."""

    def __init__(self, app: ASGIApp, shares: ShareRepository) -> None:
        """Look links up there."""
        self._app = app
        self._shares = shares

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, with the link as a prefix if it comes by one, or refuse it."""
        root = scope.get("root_path", "")
        link = None if scope["type"] == "lifespan" else _LINK.fullmatch(scope["path"].removeprefix(root))
        if link is None:
            await self._app(scope, receive, send)
            return
        prefix, token, path = link.groups()
        try:
            document_id = await run_in_threadpool(self._shares.document_of, token)
        except FoldingError as error:
            await folding_problem(error)(scope, receive, send)
            return
        method = scope.get("method", "GET")
        if document_id is not None and _allows(document_id, method, path):
            await self._app({**scope, "root_path": root + prefix, _TOKEN: token}, receive, send)
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": _POLICY_VIOLATION})
        elif document_id is None:
            await ProblemResponse(_NOT_FOUND, "This link leads nowhere, or not any more.")(scope, receive, send)
        else:
            await ProblemResponse(_FORBIDDEN, f"This is not possible: {LookOnlyError()}.")(scope, receive, send)


def is_shared(scope: Scope) -> bool:
    """Return whether a request comes by a link that holds."""
    return _TOKEN in scope


async def until_revoked(websocket: WebSocket, shares: ShareRepository) -> None:
    """Wait until the page's link is revoked; forever for a page that was not opened by a link."""
    token = websocket.scope.get(_TOKEN)
    while token is None or await run_in_threadpool(shares.document_of, token) is not None:
        await asyncio.sleep(_LOOK_EVERY_S)


def _allows(document_id: str, method: str, path: str) -> bool:
    """Return whether a link to a document lets its visitors ask for this."""
    document = f"/api/documents/{document_id}"
    if method == "POST":
        return path == f"{document}/playback"
    view = f"/viser/{document_id}"
    is_of_document = path in (f"/d/{document_id}", document, view) or path.startswith((f"{document}/", f"{view}/"))
    if path.startswith(f"{document}/{_EARLIER}"):
        return False
    is_shipped = path.startswith(_ROBOT) and path.removeprefix(_ROBOT) in shipped_robots()
    return method in ("GET", "HEAD") and (is_of_document or is_shipped or _FOR_ALL.fullmatch(path) is not None)
