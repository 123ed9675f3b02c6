"""Answers that come before a request's body was read, as one that is too large: the rest of the body is read first.

A server that answers and closes while the other side still sends makes its system discard the answer: the client sees
a connection that was cut off. So the rest is read and dropped before the answer begins, up to `DROPPED_MAX`. A client
that has asked whether to send its body (`Expect: 100-continue`) is answered at once.
"""

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

DROPPED_MAX = 256 << 20
"""How much of a body is dropped (bytes); beyond it the connection is cut off."""


class WholeRequests:
    """Middleware that begins no answer before the request has come to its end."""

    def __init__(self, app: ASGIApp) -> None:
        """Wrap everything that may refuse a request."""
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, and read what is left of its body before the answer."""
        if scope["type"] != "http" or "expect" in Headers(scope=scope):
            await self._app(scope, receive, send)
            return
        has_ended = False

        async def receive_noted() -> Message:
            nonlocal has_ended
            message = await receive()
            has_ended = has_ended or message["type"] != "http.request" or not message.get("more_body", False)
            return message

        async def send_later(message: Message) -> None:
            left = DROPPED_MAX
            while message["type"] == "http.response.start" and not has_ended and left > 0:
                left -= len((await receive_noted()).get("body", b""))
            await send(message)

        await self._app(scope, receive_noted, send_later)
