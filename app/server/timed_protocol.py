"""HTTP that waits for nobody for ever.

uvicorn limits how long a connection may be idle between two requests, and nothing else: one that opens and says
nothing, or half a head, or half a body, is kept. Here each part has its time. It counts from the part's beginning, so
that a byte now and then does not stretch it.
"""

import asyncio
import json
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

HEAD_S = 10.0
"""Time for the head of a request, from the connection or the first byte on (s)."""

BODY_S = 60.0
"""Time for its body (s): 5 MB at 100 kB/s."""

_TIME_IS_UP = {"title": "Request Timeout", "status": 408, "detail": "The request did not come to its end in time."}


class TimedProtocol(H11Protocol):
    """A connection that is closed when a request takes too long to come in."""

    def __init__(self, *arguments: Any, **options: Any) -> None:  # noqa: ANN401
        """Take what uvicorn gives."""
        super().__init__(*arguments, **options)
        self._timer: asyncio.TimerHandle | None = None
        self._awaited: object = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin to wait for a head."""
        super().connection_made(transport)
        self._await(h11.IDLE)

    def data_received(self, data: bytes) -> None:
        """Take bytes; wait for what is missing then."""
        super().data_received(data)
        self._look()

    def on_response_complete(self) -> None:
        """Wait for the next head once its first byte is there; until then uvicorn's own limit holds."""
        super().on_response_complete()
        self._look()

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait no more."""
        self._await(None)
        super().connection_lost(exc)

    def _look(self) -> None:
        """Go on waiting for what the request lacks, or for nothing: a websocket has taken over, or it is complete."""
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
        """Say why, if nothing has been said yet, and hang up."""
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
