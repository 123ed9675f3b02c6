"""Answers to unexpected errors: as a problem, logged once, with the request that failed.

FastAPI's own handler raises the error again after it has answered, so the server would log it a second time.
"""

import logging

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.problems import FAILED, ProblemResponse

_log = logging.getLogger(__name__)


class FailuresAsProblems:
    """Middleware that answers unexpected errors of the routes as problems."""

    def __init__(self, app: ASGIApp) -> None:
        """Wrap the routes."""
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Call the routes; if they fail after the answer has begun, break it off."""
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
            answer = ProblemResponse(500, FAILED)
            await answer(scope, receive, send)
