"""HTTP with a time limit for each part of a request, and websockets that are refused with an answer of their own.

uvicorn only limits the idle time between two requests. It keeps a connection that opens and sends nothing, or half a
head, or half a body. Here each part has a time limit, counted from the part's beginning, so that sending a byte now and
then does not extend it.
"""

import asyncio
import json
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

HEAD_S = 10.0
"""Time limit for the head of a request, from the connection or the first byte (s)."""

BODY_S = 60.0
"""Time limit for its body (s): 5 MB at 100 kB/s take 50 s."""

_TIME_IS_UP = {"title": "Request Timeout", "status": 408, "detail": "The request did not come to its end in time."}


class TimedProtocol(H11Protocol):
    """A connection that closes when a request takes too long to arrive."""

    def __init__(self, *arguments: Any, **options: Any) -> None:  # noqa: ANN401
        """Take uvicorn's arguments."""
        super().__init__(*arguments, **options)
        self._timer: asyncio.TimerHandle | None = None
        self._awaited: object = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Start waiting for a head."""
        super().connection_made(transport)
        self._await(h11.IDLE)

    def data_received(self, data: bytes) -> None:
        """Process bytes, then wait for the missing part."""
        super().data_received(data)
        self._look()

    def on_response_complete(self) -> None:
        """Wait for the next head once its first byte has arrived; until then uvicorn's own limit applies."""
        super().on_response_complete()
        self._look()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        self._await(None)
        super().connection_lost(exc)

    def _look(self) -> None:
        """Wait for the missing part of a request, or stop waiting if it is complete or a websocket has taken over."""
        state, is_ours = self.conn.their_state, self.transport.get_protocol() is self
        is_partial = state is h11.SEND_BODY or (state is h11.IDLE and bool(self.conn.trailing_data[0]))
        awaited = state if is_ours and is_partial else None
        if awaited is not self._awaited:
            self._await(awaited)

    def _await(self, awaited: object) -> None:
        if self._timer is not None:
            self._timer.cancel()
        self._awaited = awaited
        limit_s = BODY_S if awaited is h11.SEND_BODY else HEAD_S
        self._timer = None if awaited is None else self.loop.call_later(limit_s, self._give_up)

    def _give_up(self) -> None:
        """Send status 408 if no response has started, and close the connection."""
        if not self.transport.is_closing() and self.conn.our_state in (h11.IDLE, h11.SEND_RESPONSE):
            body = json.dumps(_TIME_IS_UP).encode()
            headers = [("content-type", "application/problem+json"), ("content-length", str(len(body)))]
            for event in (
                h11.Response(status_code=408, headers=[*headers, ("connection", "close")], reason=b"Request Timeout"),
                h11.Data(data=body),
                h11.EndOfMessage(),
            ):
                self.transport.write(self.conn.send(event) or b"")
        self.transport.close()


class WebSocketProtocol(WebSocketsSansIOProtocol):
    """A websocket that is done with its handshake once it was refused."""

    async def send(self, message: Any) -> None:  # noqa: ANN401
        """Send a message; the last part of a refusal ends the handshake."""
        await super().send(message)
        if message["type"] == "websocket.http.response.body" and not message.get("more_body", False):
            self.handshake_complete = True
