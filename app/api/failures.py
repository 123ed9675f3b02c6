"""Turns what nobody expected into a problem, and logs it: once, and with the request that it befell.

FastAPI's own handler for this answers, and then raises the error again for the server, which logs it a second time.
"""

import logging

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.problems import ProblemResponse

_log = logging.getLogger(__name__)


class FailuresAsProblems:
    """Middleware round the routes."""

    def __init__(self, app: ASGIApp) -> None:
        """Wrap the routes."""
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on; an answer that has begun when it fails is broken off."""
        has_begun = False

        async def send_noted(message: Message) -> None:
            nonlocal has_begun
            has_begun = has_begun or message["type"] == "http.response.start"
            await send(message)

        try:
            await self._app(scope, receive, send_noted)
        except Exception:
            if scope["type"] != "http" or has_begun:
                raise
            _log.exception("%s %s failed", scope["method"], scope["path"])
            answer = ProblemResponse(500, "The server failed on this request; its log says why.")
            await answer(scope, receive, send)
